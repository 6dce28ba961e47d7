#pragma once
/// Where the shapes of colliders are.
#include "fase/geometry/bounds.hpp"
#include "fase/world/detail/tables.hpp"

namespace fase {

/// Returns the pose of a collider's shape in world axes, with its position relative to the body's centre of mass.
[[nodiscard]] inline LocalPose collider_pose(const BodyTable& bodies, const Collider& collider) {
    const Quat body = bodies.motion[collider.body].rotation;
    return {rotate(body, collider.in_principal.position), body * collider.in_principal.rotation};
}

/// Returns the world pose of a collider's shape.
[[nodiscard]] inline Pose world_pose(const BodyTable& bodies, const Collider& collider) {
    const LocalPose local = collider_pose(bodies, collider);
    return {bodies.motion[collider.body].position + to_double(local.position), local.rotation};
}

/// Returns the world box of a collider's shape at its current pose, without margin.
[[nodiscard]] inline Aabb tight_box(const BodyTable& bodies, const ColliderTable& colliders, std::uint32_t collider) {
    const Collider& c = colliders[collider];
    return bounds(colliders.shapes[c.shape].shape, world_pose(bodies, c));
}

/// Returns this box enlarged by `distance` and, when `seconds` is above 0, by the path of so many seconds at the body's
/// velocity.
[[nodiscard]] inline Aabb speculative_box(const BodyTable& bodies, const ColliderTable& colliders,
                                          std::uint32_t collider, float distance, float seconds = 0) {
    Aabb box = enlarged(tight_box(bodies, colliders, collider), distance);
    if (seconds > 0) {
        const Vec3 path = bodies.motion[colliders[collider].body].linear_velocity * seconds, zero;
        box.lo += min(path, zero);
        box.hi += max(path, zero);
    }
    return box;
}

}  // namespace fase
