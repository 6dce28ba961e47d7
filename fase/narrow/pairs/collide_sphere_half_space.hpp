#pragma once
/// A sphere and a half-space.
#include "fase/geometry/shapes/sphere.hpp"
#include "fase/narrow/pairs/ground.hpp"

namespace fase::narrow {

/// One point, below the centre.
[[nodiscard]] inline Manifold collide(const Sphere& a, const HalfSpace&, const LocalPose& b_in_a, float margin) {
    const Ground ground(b_in_a);
    Manifold manifold;
    manifold.normal = -ground.up;
    ground.add(manifold, manifold.normal * a.radius, 0, margin);
    return manifold;
}

}  // namespace fase::narrow
