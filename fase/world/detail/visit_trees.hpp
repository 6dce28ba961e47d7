#pragma once
/// Traversal of the query trees, with corrections for boxes that are out of date.
///
/// Queries use separate trees, one for each motion state. Two things make a tree differ from the world. First, edits
/// between steps: they are recorded, and the first query after them applies them. Second, a step moves bodies after it
/// has stored their boxes, so shapes may stick out of their boxes at its end, most of them by less than the margin of
/// the fat boxes. The end of the step, or the first query after an edit, measures by how much they stick out. The few
/// colliders that stick out farthest (outliers) are tested one by one. The largest distance of the others (the
/// overhang) enlarges the query volume. None of this changes the state that is hashed, saved or stepped.
#include <algorithm>
#include <cmath>

#include "fase/geometry/frustum.hpp"
#include "fase/geometry/ray.hpp"
#include "fase/world/detail/query_trees.hpp"

namespace fase::world_queries {

[[nodiscard]] inline bool is_outlier(const QueryTrees& query, std::uint32_t collider) {
    const auto& outliers = query.outliers;
    if (outliers.empty()) return false;
    const auto at = std::lower_bound(outliers.begin(), outliers.end(), collider,
                                     [](const broad::Move& m, std::uint32_t c) { return m.proxy < c; });
    return at != outliers.end() && at->proxy == collider;
}

/// Calls f(tree, overhang) for each tree that is not empty.
template <class F> void for_each_tree(const QueryTrees& query, const F& f) {
    const std::array<float, 3> overhang{0, query.asleep_overhang, query.awake_overhang};  // by MotionState
    for (std::size_t i = 0; i < query.trees.size(); ++i)
        if (query.trees[i].size() != 0) f(query.trees[i], overhang[i]);
}

/// Returns the smallest float that is at least `value`.
[[nodiscard]] inline float float_above(double value) {
    const float f = static_cast<float>(value);
    return double(f) < value ? std::nextafter(f, Aabb::infinity) : f;
}
/// Returns the largest float that is at most `value`.
[[nodiscard]] inline float float_below(double value) { return -float_above(-value); }

/// Calls visit(collider, entry) once for each collider whose box is hit by the ray, or by a box swept along the ray
/// that extends from `before` to `after` around its origin. `entry` is the distance to the box in metres, never more
/// than the distance to the shape. `visit` returns the new search distance; below 0 stops.
template <class Visit>
void visit_along(const QueryTrees& query, const Ray& ray, Vec3 before, Vec3 after, const Visit& visit) {
    float limit = ray.length;
    for_each_tree(query, [&](const broad::WideBvh& tree, float overhang) {
        if (limit < 0) return;
        const Vec3d out{overhang, overhang, overhang};
        const Aabb swept =
            overhang > 0 ? rounded_outward(to_double(before) - out, to_double(after) + out) : Aabb{before, after};
        tree.nearest_first(broad::RayMeasure(ray, swept.lo, swept.hi), limit,
                           [&](broad::Proxy p, const Aabb&, float entry) {
                               if (!is_outlier(query, p)) limit = visit(p, entry);
                               return limit;
                           });
    });
    const broad::RayMeasure measure(ray, before, after);
    for (const broad::Move& outlier : query.outliers) {
        if (limit < 0) return;
        const float entry = measure.distance(outlier.box, limit);
        if (entry < broad::infinite_distance) limit = visit(outlier.proxy, entry);
    }
}

/// Calls visit(collider) once for each collider whose box touches `box`, until `visit` returns false.
template <class Visit> void visit_overlapping(const QueryTrees& query, const Aabb& box, const Visit& visit) {
    bool more = true;
    for_each_tree(query, [&](const broad::WideBvh& tree, float overhang) {
        if (!more) return;
        tree.traverse(broad::BoxRegion{enlarged(box, overhang)}, [&](broad::Proxy p, const Aabb&) {
            if (!is_outlier(query, p)) more = visit(p);
            return more;
        });
    });
    for (const broad::Move& outlier : query.outliers)
        if (more && overlaps(outlier.box, box)) more = visit(outlier.proxy);
}

/// Calls visit(collider) once for each collider whose box is within `radius` metres of a point. `visit` returns the new
/// search distance.
template <class Visit> void visit_near(const QueryTrees& query, Vec3d point, float radius, const Visit& visit) {
    float limit = radius;
    for_each_tree(query, [&](const broad::WideBvh& tree, float overhang) {
        const double extra = 1.7320509 * double(overhang);  // along the diagonal
        const auto wider = [&] { return float_above(double(limit) + extra); };
        tree.nearest_first(broad::PointMeasure(point, wider()), wider(), [&](broad::Proxy p, const Aabb&, float) {
            if (!is_outlier(query, p)) limit = visit(p);
            return wider();
        });
    });
    for (const broad::Move& outlier : query.outliers)
        if (broad::PointMeasure(point, limit).distance(outlier.box, limit) < broad::infinite_distance)
            limit = visit(outlier.proxy);
}

/// Calls visit(collider, inside) once for each collider whose box may be in the frustum. `inside` is true when the
/// shape is certainly inside all planes.
template <class Visit> void visit_in_frustum(const QueryTrees& query, const Frustum& frustum, const Visit& visit) {
    for_each_tree(query, [&](const broad::WideBvh& tree, float overhang) {
        Frustum wider = frustum;
        for (Frustum::Side& side : wider.sides) {
            const Vec3d size = abs(side.normal);
            const double sum = size.x + size.y + size.z;
            if (sum > 0) side.offset += sum * double(overhang);
        }
        tree.cull(broad::FrustumRegion(wider), [&](std::span<const broad::Proxy> proxies, bool inside) {
            for (const broad::Proxy p : proxies)
                if (!is_outlier(query, p)) visit(p, inside && overhang == 0);
        });
    });
    for (const broad::Move& outlier : query.outliers)
        if (overlaps(frustum, outlier.box)) visit(outlier.proxy, false);
}

}  // namespace fase::world_queries
