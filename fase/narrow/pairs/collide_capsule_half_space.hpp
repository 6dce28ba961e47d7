#pragma once
/// A capsule on the ground.
#include "fase/geometry/shapes/capsule.hpp"
#include "fase/narrow/pairs/ground.hpp"

namespace fase::narrow {

/// A point for each end: 2 when it lies. The feature names the end: 0 lower, 1 upper in the capsule's frame.
[[nodiscard]] inline Manifold collide(const Capsule& a, const HalfSpace&, const LocalPose& b_in_a, float margin) {
    const Ground ground(b_in_a);
    Manifold manifold;
    manifold.normal = -ground.up;
    const Vec3 below = manifold.normal * a.radius;
    ground.add(manifold, below - Vec3{0, a.half_length, 0}, 0, margin);
    // A capsule without length is a ball: one point is enough.
    if (a.half_length > 1e-4f * a.radius) ground.add(manifold, below + Vec3{0, a.half_length, 0}, 1, margin);
    return manifold;
}

}  // namespace fase::narrow
