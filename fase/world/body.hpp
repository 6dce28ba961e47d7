#pragma once
/// Definitions and readable states of bodies and colliders.
#include <cstdint>
#include <optional>

#include "fase/core/ids.hpp"
#include "fase/core/no_index.hpp"
#include "fase/dynamics/body_kind.hpp"
#include "fase/dynamics/material.hpp"
#include "fase/geometry/aabb.hpp"
#include "fase/geometry/mass.hpp"
#include "fase/geometry/shapes.hpp"
#include "fase/pairs/filter.hpp"

namespace fase {

struct BodyTag;
struct ColliderTag;
using BodyId = Id<BodyTag>;
using ColliderId = Id<ColliderTag>;

/// Definition of a body. Aggregate: `world.add_body({.position = {0, 5, 0}})`.
struct BodyDef {
    BodyKind kind = BodyKind::Dynamic;
    Vec3d position{};         ///< of the body's frame (not of its centre of mass), world, at most 1e7 m from the origin
    Quat rotation{};          ///< of the body's frame; length within 1e-2 of 1; normalised by add_body()
    Vec3 linear_velocity{};   ///< m/s, of the centre of mass
    Vec3 angular_velocity{};  ///< rad/s, world frame
    float linear_damping = 0;   ///< 1/s, 0 or more: v' = -damping v
    float angular_damping = 0;  ///< 1/s, 0 or more
    float gravity_scale = 1;
    AxisLocks locks{};
    bool can_sleep = true;
    /// False: starts asleep and stays where it is, even in the air, until something wakes it. The body and those that
    /// touch it must then be at rest: a velocity that is not 0 is refused.
    bool awake = true;
    /// Mass, centre and inertia in the body's frame, instead of the sum over colliders of shape times density.
    std::optional<MassProperties> mass{};
    std::uint64_t user = 0;  ///< user data; saved in snapshots and recordings, returned in BodyState
};

/// Definition of a collider: one shape on a body.
struct ColliderDef {
    LocalPose pose{};  ///< of the shape's frame in the body's
    Material material{};
    float density = 1000;  ///< kg/m³; used for bodies whose mass is not given; 0: no mass
    pairs::CollisionFilter filter{};
    bool sensor = false;     ///< reports overlaps as events; applies no forces and has no mass
    std::uint64_t user = 0;  ///< user data; 0: that of its body
};

/// The ids of a new body and of its first collider, which is the default id when it has none. Serves as the body's id.
struct NewBody {
    BodyId body;
    ColliderId collider;
    operator BodyId() const { return body; }
};

/// One part of a compound: World::add_body().
struct ColliderShape {
    Shape shape;
    ColliderDef def{};
};

/// The state of a body.
struct BodyState {
    BodyId id;
    BodyKind kind = BodyKind::Dynamic;
    bool awake = true;  ///< always false for static bodies
    /// A step made a number infinite or NaN, or moved the body out of the world (1e7 m): it is at its last valid pose,
    /// asleep whatever its kind, and has no contacts. This is final. Calls that change it succeed and store what they
    /// set, but no step moves it: queries find it where set_pose() put it, its state shows velocities and impulses,
    /// wake() has no effect. To use the object again, remove the body and add a new one.
    bool quarantined = false;
    Pose pose;             ///< of the body's frame
    Vec3d centre;          ///< of mass, world
    Vec3 linear_velocity;  ///< of the centre of mass
    Vec3 angular_velocity;
    float mass = 0;  ///< kg; 0 unless dynamic
    std::uint32_t island =
        no_index;  ///< the smallest body index in its island of touching bodies; no_index unless dynamic
    std::uint64_t user = 0;
};

/// The state of a collider.
struct ColliderState {
    ColliderId id;
    BodyId body;
    const Shape* shape = nullptr;  ///< valid until the next change of the world
    ColliderDef def;
    Aabb box;  ///< world box at the current pose, enlarged by the speculative distance
};

}  // namespace fase
