#pragma once
/// The ranges of all numbers that a world accepts: the same for every function, scene and snapshot.
#include <string>

#include "fase/core/result.hpp"
#include "fase/dynamics/material.hpp"
#include "fase/geometry/mass.hpp"
#include "fase/world/body.hpp"

namespace fase {

/// Largest absolute values, unless stated otherwise. Within them, no product or sum that a step computes from two of
/// them is infinite.
namespace limits {
inline constexpr double coordinate = 1e7;  ///< m, of places in the world, on each axis
inline constexpr float offset = 1e6f;      ///< m, of colliders and centres of mass in the body's frame, on each axis
inline constexpr float speed = 1e7f;       ///< m/s; a step clamps it to Settings::max_linear_speed
inline constexpr float spin = 1e6f;        ///< rad/s; a step clamps it to Settings::max_angular_speed
inline constexpr float damping = 1e6f;     ///< 1/s
inline constexpr float gravity_scale = 1e6f;
inline constexpr float acceleration = 1e6f;  ///< m/s², of Settings::gravity, on each axis
inline constexpr float density = 1e9f;       ///< kg/m³
inline constexpr float min_mass = 1e-18f;    ///< kg, of a body that has a mass
inline constexpr float max_mass = 1e20f;
inline constexpr float min_moment = 1e-30f;  ///< kg m², principal, of a body that has a mass
inline constexpr float max_moment = 1e34f;
inline constexpr float friction = 1e6f;
inline constexpr float restitution = 1e3f;
inline constexpr float force = 1e20f;   ///< N; also N s of an impulse, on each axis
inline constexpr float torque = 1e28f;  ///< N m; also N m s of an angular impulse, on each axis
}  // namespace limits

// Each check returns an Error that begins with `where`: what was found, and what was expected.
Result<void> check_number(float value, float min, float max, const std::string& where);
/// Checks every axis against -max to max.
Result<void> check_vector(Vec3 value, float max, const std::string& where);
/// Checks that a place in the world is finite and within `limits::coordinate`.
Result<void> check_position(Vec3d position, const std::string& where);
/// Returns `q` normalised; an Error when it is not finite or its length is not within 1e-2 of 1.
Result<Quat> check_rotation(Quat q, const std::string& where);
/// Checks the lengths of both velocities.
Result<void> check_velocity(Vec3 linear, Vec3 angular, const std::string& where);
/// Checks mass properties that the user gives: those of a solid, and in range.
Result<void> check_mass(const MassProperties& mass, const std::string& where);
/// Checks mass properties that were computed: in range, or all 0.
Result<void> check_combined_mass(const MassProperties& mass, Vec3 moments, const std::string& where);
Result<void> check(const Material& material);
Result<void> check(const BodyDef& def);
Result<void> check(const ColliderDef& def);

/// Whether a place is finite and within `limits::coordinate` on each axis.
[[nodiscard]] bool is_in_world(Vec3d position);

}  // namespace fase
