#pragma once
/// What the functions that change a world share.
#include <string>

#include "fase/world/detail/state.hpp"
#include "fase/world/world.hpp"

namespace fase {

/// The Error for an id that names nothing here.
[[nodiscard]] Error stale_id(const char* where);
/// BadArgument: "where: found …, need …".
[[nodiscard]] Error refused(std::string where, std::string found, std::string need, std::string remedy = "");

/// An error unless friction and restitution are finite and 0 or more.
Result<void> check(const Material& material);
/// A unit quaternion near `q`, or an Error for one that cannot be meant: not finite, or its length not within 1e-2
/// of 1.
Result<Quat> usable(Quat q, const std::string& where);
/// An error unless finite and within `farthest` on every axis.
Result<void> check_position(Vec3d position, const std::string& where);
/// An error unless finite and at least `least`.
Result<void> check_number(float value, float least, const std::string& where);
/// Bits 0..2: linear x, y, z; bits 3..5: angular.
[[nodiscard]] std::uint8_t bits_of(AxisLocks locks);
/// Gives a body its population by kind and motion, with boxes and pairs; asks for pairs in the next step.
void update_motion_state(WorldState& state, std::uint32_t body);

/// How far from the origin bodies may be put, metres.
inline constexpr double farthest = 1e7;

/// The box of a collider made anew and put into its set; asks for pairs in the next step.
void renew_box(WorldState& state, std::uint32_t collider);
/// The same for all colliders of a body.
void renew_boxes(WorldState& state, std::uint32_t body);
/// Mass, centre and principal axes from what was given or from the colliders; the body's frame stays where it is.
void renew_mass(WorldState& state, std::uint32_t body);
/// The index of a shape equal to `shape`, made when there is none yet; counts one user more.
[[nodiscard]] std::uint32_t share_shape(WorldState& state, const Shape& shape);
void release_shape(WorldState& state, std::uint32_t index);

}  // namespace fase
