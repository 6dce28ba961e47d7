#pragma once
/// Helpers of the functions that change a world: checks, boxes, masses, shared shapes.
#include <string>

#include "fase/world/detail/state.hpp"
#include "fase/world/world.hpp"

namespace fase {

/// Returns the Error for an id that is stale or of another world.
[[nodiscard]] Error stale_id(const char* where);
/// Returns a BadArgument error: "where: found …; expected …".
[[nodiscard]] Error refused(std::string where, std::string found, std::string expected, std::string remedy = "");

/// Checks that friction and restitution are finite and 0 or more.
Result<void> check(const Material& material);
/// Returns `q` normalised; an Error when it is not finite or its length is not within 1e-2 of 1.
Result<Quat> check_rotation(Quat q, const std::string& where);
/// Checks that a position is finite and within `max_coordinate` on every axis.
Result<void> check_position(Vec3d position, const std::string& where);
/// Checks that a number is finite and at least `min`.
Result<void> check_number(float value, float min, const std::string& where);
/// Packs locks into bits. Bits 0..2: linear x, y, z; bits 3..5: angular.
[[nodiscard]] std::uint8_t bits_of(AxisLocks locks);
/// Sets the motion state of a body from its kind and velocity, and moves its boxes and pairs. The next step queries its
/// pairs.
void update_motion_state(WorldState& state, std::uint32_t body);

/// The largest coordinate of a body position, in metres.
inline constexpr double max_coordinate = 1e7;

/// Recomputes the box of a collider and updates it in its broad-phase structure. The next step queries its pairs.
void update_box(WorldState& state, std::uint32_t collider);
/// The same for all colliders of a body.
void update_boxes(WorldState& state, std::uint32_t body);
/// Recomputes mass, centre and principal axes, from the given mass or from the colliders. The body's frame does not
/// move.
void update_mass(WorldState& state, std::uint32_t body);
/// Returns the index of a shared shape equal to `shape`, added when there is none, and increments its user count.
[[nodiscard]] std::uint32_t share_shape(WorldState& state, const Shape& shape);
/// Decrements the user count of a shared shape, and frees the shape at 0.
void release_shape(WorldState& state, std::uint32_t index);

}  // namespace fase
