/// The queries of `fase query`: random rays, boxes and cameras in a set of boxes.
#include "cli/query_set.hpp"

#include <algorithm>
#include <cmath>

#include "fase/core/random.hpp"

namespace fase::cli {
namespace {

Vec3 point_in(Random& random, const Aabb& box) {
    const float x = random.between(box.lo.x, box.hi.x), y = random.between(box.lo.y, box.hi.y);
    return {x, y, random.between(box.lo.z, box.hi.z)};
}
/// A uniformly distributed unit vector: rejects points of a cube outside the unit ball.
Vec3 direction(Random& random) {
    for (;;) {
        const Vec3 p = point_in(random, {{-1, -1, -1}, {1, 1, 1}});
        const float size = length_squared(p);
        if (size > 1e-3f && size <= 1) return p * (1 / std::sqrt(size));
    }
}

Frustum view_frustum(Vec3 eye, Vec3 forward, Vec3 any, float far) {
    constexpr double half_width = 0.5773502691896258, half_height = half_width * 9 / 16;  // tan 30°
    constexpr double near = 0.1;
    const Vec3d f = to_double(forward);
    Vec3d right = cross(f, to_double(any));
    right = right * (1 / length(right));
    const Vec3d up = cross(right, f), origin = to_double(eye);
    const auto side = [&](Vec3d normal) {
        normal = normal * (1 / length(normal));
        return Frustum::Side{normal, dot(normal, origin)};
    };
    Frustum frustum;
    frustum.sides = {side(-right - f * half_width),
                     side(right - f * half_width),
                     side(-up - f * half_height),
                     side(up - f * half_height),
                     Frustum::Side{-f, -dot(f, origin) - near},
                     Frustum::Side{f, dot(f, origin) + double(far)}};
    return frustum;
}

/// The bounds of the boxes and their mean size.
struct BoxesSummary {
    Aabb bounds;
    Vec3 mean_extent;
};
BoxesSummary summary_of(std::span<const Aabb> boxes) {
    constexpr float far = 1e7f;
    constexpr Aabb limits{{-far, -far, -far}, {far, far, far}};
    Aabb bounds;
    Vec3d sum{};
    double count = 0;
    for (const Aabb& box : boxes) {
        if (is_empty(box) || !contains(limits, box)) continue;
        bounds = merge(bounds, box);
        sum += to_double(extent(box));
        ++count;
    }
    if (count == 0) return {{{-1, -1, -1}, {1, 1, 1}}, {1, 1, 1}};
    return {bounds, to_float(sum * (1 / count))};
}

}  // namespace

QuerySet random_queries(std::span<const Aabb> boxes, const QueryCounts& counts, std::uint64_t seed) {
    const BoxesSummary summary = summary_of(boxes);
    const float diagonal = std::max(length(extent(summary.bounds)), 1e-3f);
    QuerySet set;
    // One random stream per kind: the number of rays does not change the boxes.
    Random random(seed, 0);
    for (std::size_t i = 0; i < counts.rays; ++i) {
        const Vec3 from = point_in(random, summary.bounds);
        set.rays.push_back({to_double(from), direction(random), diagonal});
    }
    random = Random(seed, 1);
    for (std::size_t i = 0; i < counts.boxes; ++i) {
        const Vec3 centre = point_in(random, summary.bounds);
        set.boxes.push_back({centre - summary.mean_extent, centre + summary.mean_extent});
    }
    random = Random(seed, 2);
    for (std::size_t i = 0; i < counts.frusta; ++i) {
        const Vec3 eye = point_in(random, summary.bounds), forward = direction(random);
        Vec3 any = direction(random);
        while (length_squared(cross(forward, any)) < 0.01f) any = direction(random);
        set.frusta.push_back(view_frustum(eye, forward, any, diagonal / 4));
    }
    return set;
}

}  // namespace fase::cli
