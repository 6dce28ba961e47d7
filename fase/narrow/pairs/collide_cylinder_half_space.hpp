#pragma once
/// A cylinder and a half-space.
#include <cmath>

#include "fase/geometry/shapes/cylinder.hpp"
#include "fase/narrow/pairs/ground.hpp"

namespace fase::narrow {

/// Upright: 4 points of the lower rim, the deepest first, its opposite and the two between (features 0–3); within 1e-3
/// rad of vertical the four are at ±x and ±z of the cylinder, because the deepest direction is noise then. Lying: the
/// deepest points of both rims (features 4, 5). Only points within the margin.
[[nodiscard]] inline Manifold collide(const Cylinder& a, const HalfSpace&, const LocalPose& b_in_a, float margin) {
    const Ground ground(b_in_a);
    Manifold manifold;
    manifold.normal = -ground.up;
    const Vec3 down = manifold.normal;
    const float sideways = std::sqrt(down.x * down.x + down.z * down.z);
    constexpr float max_sideways = 1e-3f;
    const bool vertical = !(sideways > max_sideways);
    const float scale = vertical ? a.radius : a.radius / sideways;
    const Vec3 deepest = vertical ? Vec3{a.radius, 0, 0} : Vec3{down.x * scale, 0, down.z * scale};
    const Vec3 across = {-deepest.z, 0, deepest.x};
    const Vec3 cap = {0, down.y < 0 ? -a.half_height : a.half_height, 0};
    if (sideways * sideways <= 0.5f) {
        ground.add(manifold, cap + deepest, 0, margin);
        ground.add(manifold, cap + across, 1, margin);
        ground.add(manifold, cap - deepest, 2, margin);
        ground.add(manifold, cap - across, 3, margin);
    } else {
        ground.add(manifold, deepest - Vec3{0, a.half_height, 0}, 4, margin);
        ground.add(manifold, deepest + Vec3{0, a.half_height, 0}, 5, margin);
    }
    return manifold;
}

}  // namespace fase::narrow
