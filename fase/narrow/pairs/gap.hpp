#pragma once
/// One contact from the closest points of two shapes, for corners near corners.
#include "fase/narrow/detail/gjk.hpp"
#include "fase/narrow/manifold.hpp"

namespace fase::narrow {

/// One point between the closest points of two shapes that are separated by at most `margin`, radii included; none when
/// they are farther apart or overlap. Slow (GJK in double) and rare: for corners near corners.
template <ConvexShape A, ConvexShape B>
Manifold touch_across_gap(const A& a, const B& b, const LocalPose& b_in_a, float margin, std::uint32_t feature) {
    const double radius_a = a.core_radius(), radius_b = b.core_radius();
    const double reach = radius_a + radius_b + double(margin);
    const GjkResult nearest = gjk(core_view(a), core_view(b), to_double(b_in_a), {.farther_than = reach});
    Manifold manifold;
    if (nearest.state != GjkResult::State::Apart || !(nearest.distance <= reach)) return manifold;
    manifold.normal = to_float(nearest.normal);
    manifold.count = 1;
    const Vec3d middle = nearest.on_a + nearest.normal * ((radius_a + nearest.distance - radius_b) * 0.5);
    manifold.points[0] = {to_float(middle), static_cast<float>(nearest.distance - radius_a - radius_b), feature};
    return manifold;
}

}  // namespace fase::narrow
