/// The signed distance of any two shapes with its witness points, in double.
#include "fase/narrow/distance.hpp"

#include <limits>

#include "fase/narrow/detail/core_distance.hpp"
#include "fase/narrow/detail/infinity.hpp"
#include "fase/narrow/detail/mesh_queries.hpp"
#include "fase/narrow/detail/penetration.hpp"

namespace fase::narrow {
namespace {

/// Converts the distance of the cores and a closest point on a's core to those of the surfaces.
Distance with_radii(double core_distance, Vec3d on_a, Vec3d normal, double radius_a, double radius_b) {
    Distance result;
    result.distance = core_distance - radius_a - radius_b;
    result.normal = normal;
    result.on_a = on_a + normal * radius_a;
    result.on_b = result.on_a + normal * result.distance;
    return result;
}

/// The distance of a half-space (a) and a convex shape (b).
Distance distance_from_half_space(const CoreView& b, const TransformD& b_in_a) {
    const Vec3d lowest = transform(b_in_a, b.support(transpose_times(b_in_a.rotation, {0, -1, 0})));
    return with_radii(lowest.y, {lowest.x, 0, lowest.z}, {0, 1, 0}, 0, b.radius);
}

Distance distance_of_half_spaces(const TransformD& b_in_a) {
    const Vec3d up{0, 1, 0}, up_b = b_in_a.rotation.y;
    Distance result;
    result.normal = up;
    const bool facing = up_b.y < 0 && std::abs(up_b.x) < 1e-12 && std::abs(up_b.z) < 1e-12;
    const Vec3d position = b_in_a.position;
    result.on_a = {position.x, 0, position.z};
    if (facing) {
        result.distance = position.y;
        result.on_b = position;
    } else {
        result.distance = -infinity;
        result.on_b = result.on_a;
    }
    return result;
}

}  // namespace

Distance distance_of_cores(const CoreView& a, const CoreView& b, const TransformD& b_in_a) {
    const GjkResult apart = gjk(a, b, b_in_a);
    const bool overlap = apart.state == GjkResult::State::Overlap;
    if (!overlap && apart.distance > 1e-7 * apart.scale) {
        return with_radii(apart.distance, apart.on_a, apart.normal, a.radius, b.radius);
    }
    PenetrationOptions options;
    options.tolerance = 1e-10 * apart.scale;
    Penetration deepest = penetration(a, b, b_in_a, apart.simplex, options);
    // Too close for the distance and normal of GJK to be exact: takes the larger proven gap.
    if (!overlap) {
        const double gap = -depth_along(a, b, b_in_a, apart.normal);
        if (gap > -deepest.depth) return with_radii(gap, apart.on_a, apart.normal, a.radius, b.radius);
    }
    GjkResult touch = gjk_after_separation(a, b, b_in_a, deepest, apart.scale);
    // On curved cores the normal at the touch is better than that of the penetration, while its depth is smaller.
    for (int i = 0; i < 12 && deepest.state != Penetration::State::Exact; ++i) {
        const double depth = depth_along(a, b, b_in_a, touch.normal);
        if (!(depth < deepest.depth)) break;
        deepest.normal = touch.normal;
        deepest.depth = depth;
        touch = gjk_after_separation(a, b, b_in_a, deepest, apart.scale);
    }
    return with_radii(-deepest.depth, touch.on_a, deepest.normal, a.radius, b.radius);
}

bool cores_overlap(const CoreView& a, const CoreView& b, const TransformD& b_in_a) {
    GjkOptions options;
    options.farther_than = a.radius + b.radius;
    const GjkResult result = gjk(a, b, b_in_a, options);
    if (result.state == GjkResult::State::Overlap) return true;
    return result.state == GjkResult::State::Apart && result.distance <= options.farther_than + 1e-15 * result.scale;
}

Distance signed_distance(const Shape& a, const Shape& b, const TransformD& b_in_a) {
    return std::visit(
        [&]<class A, class B>(const A& s, const B& t) -> Distance {
            if constexpr (std::is_same_v<A, Mesh>) {
                return mesh_distance(s, b, b_in_a);
            } else if constexpr (std::is_same_v<B, Mesh>) {
                return flipped(mesh_distance(t, a, inverse(b_in_a)), b_in_a);
            } else if constexpr (ConvexShape<A> && ConvexShape<B>) {
                return distance_of_cores(core_view(s), core_view(t), b_in_a);
            } else if constexpr (ConvexShape<B>) {
                return distance_from_half_space(core_view(t), b_in_a);
            } else if constexpr (ConvexShape<A>) {
                return flipped(distance_from_half_space(core_view(s), inverse(b_in_a)), b_in_a);
            } else {
                return distance_of_half_spaces(b_in_a);
            }
        },
        a, b);
}

bool overlaps(const Shape& a, const Shape& b, const TransformD& b_in_a) {
    return std::visit(
        [&]<class A, class B>(const A& s, const B& t) {
            if constexpr (ConvexShape<A> && ConvexShape<B>) {
                return cores_overlap(core_view(s), core_view(t), b_in_a);
            } else if constexpr (std::is_same_v<A, Mesh>) {
                return mesh_overlaps(s, b, b_in_a);
            } else if constexpr (std::is_same_v<B, Mesh>) {
                return mesh_overlaps(t, a, inverse(b_in_a));
            } else {
                return signed_distance(a, b, b_in_a).distance <= 0;
            }
        },
        a, b);
}

}  // namespace fase::narrow
