#pragma once
/// A sphere and a cylinder.
#include "fase/geometry/shapes/cylinder.hpp"
#include "fase/geometry/shapes/sphere.hpp"
#include "fase/narrow/pairs/round.hpp"

namespace fase::narrow {

/// One point. A centre inside is pushed out of the nearer of side and cap; a centre on the axis leaves the side along
/// x. The feature is the side (0), upper or lower cap (1, 2), upper or lower rim (3, 4).
[[nodiscard]] inline Manifold collide(const Sphere& a, const Cylinder& b, const LocalPose& b_in_a, float margin) {
    const Vec3 centre = rotate_back(b_in_a.rotation, -b_in_a.position);
    const float squared_sideways = centre.x * centre.x + centre.z * centre.z;
    // Below 1e-30 the square has lost its digits.
    const float sideways = squared_sideways > 1e-30f ? std::sqrt(squared_sideways) : 0.f;
    const float up = centre.y < 0 ? -1.f : 1.f;
    const float beyond_side = sideways - b.radius, beyond_cap = up * centre.y - b.half_height;
    const float reach = a.radius + margin;
    Manifold manifold;
    if (!(beyond_side <= reach && beyond_cap <= reach)) return manifold;
    const Vec3 out = sideways > 0 ? Vec3{centre.x * (1 / sideways), 0, centre.z * (1 / sideways)} : Vec3{1, 0, 0};
    const std::uint32_t lower = up < 0 ? 1 : 0;
    // Both beyond by more than rounding: the rim is nearest.
    const float noise = 1e-6f * (b.radius > b.half_height ? b.radius : b.half_height);
    Vec3 from_cylinder;
    float distance;
    std::uint32_t feature;
    if (beyond_side > noise && beyond_cap > noise) {
        const float squared = beyond_side * beyond_side + beyond_cap * beyond_cap;
        if (!(squared <= reach * reach)) return manifold;
        distance = std::sqrt(squared);
        from_cylinder = out * (beyond_side / distance) + Vec3{0, up * beyond_cap / distance, 0};
        feature = 3 + lower;
    } else if (beyond_cap > beyond_side) {
        distance = beyond_cap;
        from_cylinder = {0, up, 0};
        feature = 1 + lower;
    } else {
        distance = beyond_side;
        from_cylinder = out;
        feature = 0;
    }
    manifold.normal = rotate(b_in_a.rotation, -from_cylinder);
    manifold.count = 1;
    manifold.points[0] = {manifold.normal * ((a.radius + distance) * 0.5f), distance - a.radius, feature};
    return manifold;
}

}  // namespace fase::narrow
