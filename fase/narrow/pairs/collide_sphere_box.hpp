#pragma once
/// A sphere and a box.
#include "fase/geometry/shapes/box.hpp"
#include "fase/geometry/shapes/sphere.hpp"
#include "fase/narrow/pairs/round.hpp"

namespace fase::narrow {

/// One point. A centre inside the box is pushed out of the nearest face. The feature is the corner, edge or face.
/// Source: Arvo 1990, A simple method for box-sphere intersection testing.
[[nodiscard]] inline Manifold collide(const Sphere& a, const Box& b, const LocalPose& b_in_a, float margin) {
    const Vec3 centre = rotate_back(b_in_a.rotation, -b_in_a.position);
    const Vec3 nearest = {clamp_to(centre.x, b.half.x), clamp_to(centre.y, b.half.y), clamp_to(centre.z, b.half.z)};
    const Vec3 outside = centre - nearest;
    const float squared = length_squared(outside);
    const float reach = a.radius + margin;
    Manifold manifold;
    if (!(squared <= reach * reach)) return manifold;
    const auto region = [](float x) { return x > 0 ? 2u : x < 0 ? 1u : 0u; };
    const float largest =
        b.half.x > b.half.y ? (b.half.x > b.half.z ? b.half.x : b.half.z) : (b.half.y > b.half.z ? b.half.y : b.half.z);
    // Within rounding of the surface: the face gives the normal.
    const float noise = 1e-6f * largest;
    Vec3 from_box;
    float distance;
    std::uint32_t feature;
    if (squared > noise * noise) {
        distance = std::sqrt(squared);
        from_box = outside * (1 / distance);
        feature = region(outside.x) | region(outside.y) << 2 | region(outside.z) << 4;
    } else {
        const Vec3 inside = b.half - abs(centre);
        const int axis = inside.y < inside.x ? (inside.z < inside.y ? 2 : 1) : (inside.z < inside.x ? 2 : 0);
        const float sign = centre[axis] < 0 ? -1.f : 1.f;
        from_box[axis] = sign;
        distance = -inside[axis];
        feature = region(sign) << (2 * axis);
    }
    manifold.normal = rotate(b_in_a.rotation, -from_box);
    manifold.count = 1;
    manifold.points[0] = {manifold.normal * ((a.radius + distance) * 0.5f), distance - a.radius, feature};
    return manifold;
}

}  // namespace fase::narrow
