#pragma once
/// A sphere and a capsule.
#include "fase/geometry/shapes/capsule.hpp"
#include "fase/geometry/shapes/sphere.hpp"
#include "fase/narrow/pairs/round.hpp"

namespace fase::narrow {

/// One point. A centre on the capsule's segment is pushed out perpendicular to it.
[[nodiscard]] inline Manifold collide(const Sphere& a, const Capsule& b, const LocalPose& b_in_a, float margin) {
    const Vec3 axis = rotate(b_in_a.rotation, Vec3{0, 1, 0});
    const float along = clamp_to(-dot(axis, b_in_a.position), b.half_length);
    return touch_round({}, a.radius, b_in_a.position + axis * along, b.radius, margin, any_perpendicular(axis), 0);
}

}  // namespace fase::narrow
