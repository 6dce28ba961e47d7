#pragma once
/// A capsule and a half-space.
#include "fase/geometry/shapes/capsule.hpp"
#include "fase/narrow/pairs/ground.hpp"

namespace fase::narrow {

/// One point for each end within the margin: 2 when the capsule lies. The feature is the end: 0 lower, 1 upper in the
/// capsule's frame.
[[nodiscard]] inline Manifold collide(const Capsule& a, const HalfSpace&, const LocalPose& b_in_a, float margin) {
    const Ground ground(b_in_a);
    Manifold manifold;
    manifold.normal = -ground.up;
    const Vec3 below = manifold.normal * a.radius;
    ground.add(manifold, below - Vec3{0, a.half_length, 0}, 0, margin);
    // A capsule of length 0 is a sphere: one point is enough.
    if (a.half_length > 1e-4f * a.radius) ground.add(manifold, below + Vec3{0, a.half_length, 0}, 1, margin);
    return manifold;
}

}  // namespace fase::narrow
