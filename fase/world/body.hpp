#pragma once
/// What a body and its colliders are made from, and what can be read of them.
#include <cstdint>
#include <optional>

#include "fase/core/ids.hpp"
#include "fase/dynamics/body_kind.hpp"
#include "fase/dynamics/material.hpp"
#include "fase/geometry/aabb.hpp"
#include "fase/geometry/mass.hpp"
#include "fase/pairs/filter.hpp"

namespace fase {

struct BodyTag;
struct ColliderTag;
using BodyId = Id<BodyTag>;
using ColliderId = Id<ColliderTag>;

/// How to make a body. Aggregate: `world.add_body({.position = {0, 5, 0}})`.
struct BodyDef {
    BodyKind kind = BodyKind::Dynamic;
    Vec3d position{};         ///< of the body's frame (not of its centre of mass), world, at most 1e7 m from the origin
    Quat rotation{};          ///< of the body's frame; length within 1e-2 of 1, normalised on the way in
    Vec3 linear_velocity{};   ///< m/s, of the centre of mass
    Vec3 angular_velocity{};  ///< rad/s, world frame
    float linear_damping = 0;   ///< 1/s, 0 or more: v' = -damping v
    float angular_damping = 0;  ///< 1/s, 0 or more
    float gravity_scale = 1;
    AxisLocks locks{};
    bool can_sleep = true;
    bool awake = true;  ///< false: begins asleep; it and all that touch it then must be at rest
    /// Mass, centre and inertia in the body's frame, instead of the sum over colliders of shape times density.
    std::optional<MassProperties> mass{};
    std::uint64_t user = 0;  ///< a number of the user's own; kept in snapshots and recordings, reported in the state
};

/// One shape on a body.
struct ColliderDef {
    LocalPose pose{};  ///< of the shape's frame in the body's
    Material material{};
    float density = 1000;  ///< kg/m³; counts for bodies whose mass is not given; 0: weighs nothing
    pairs::CollisionFilter filter{};
    bool sensor = false;     ///< tells who is inside, pushes nobody, weighs nothing
    std::uint64_t user = 0;  ///< a number of the user's own
};

/// What can be read of a body.
struct BodyState {
    BodyId id;
    BodyKind kind = BodyKind::Dynamic;
    bool awake = true;  ///< always false for static bodies
    bool quarantined =
        false;     ///< a number became infinite or NaN in a step: put back to its last good pose and taken out of play
    Pose pose;     ///< of the body's frame
    Vec3d centre;  ///< of mass, world
    Vec3 linear_velocity;  ///< of the centre of mass
    Vec3 angular_velocity;
    float mass = 0;                     ///< kg; 0 unless dynamic
    std::uint32_t island = 0xffffffff;  ///< number of its island of touching bodies: the least body index in it
    std::uint64_t user = 0;
};

/// What can be read of a collider.
struct ColliderState {
    ColliderId id;
    BodyId body;
    const Shape* shape = nullptr;  ///< valid until the next change of the world
    ColliderDef def;
    Aabb box;  ///< world box as of the last step or edit, grown by the speculative distance
};

}  // namespace fase
