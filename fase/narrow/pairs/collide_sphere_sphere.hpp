#pragma once
/// Two spheres.
#include "fase/geometry/shapes/sphere.hpp"
#include "fase/narrow/pairs/round.hpp"

namespace fase::narrow {

/// One point. The normal of coincident centres is +y.
[[nodiscard]] inline Manifold collide(const Sphere& a, const Sphere& b, const LocalPose& b_in_a, float margin) {
    return touch_round({}, a.radius, b_in_a.position, b.radius, margin, {0, 1, 0}, 0);
}

}  // namespace fase::narrow
