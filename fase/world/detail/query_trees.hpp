#pragma once
/// How queries go through the boxes of a world as it stands, whatever was edited or moved since they were stored.
///
/// Queries have trees of their own, one for each population. Two things stand between a query and them. Edits between
/// steps are noted: the first query after them takes them over. And a step moves bodies after it stored their boxes, so
/// that at its end shapes may stick out of them: for nearly all by less than the boxes are grown. The rest is measured
/// once, at the end of the step or by the first query: the few that stick out farthest (strays) are asked one by one,
/// and the farthest of the others (the overhang) is how much wider all others are looked for. Nothing of this touches
/// the state that is hashed, saved or stepped.
#include <algorithm>
#include <cmath>

#include "fase/geometry/bounds.hpp"
#include "fase/world/detail/state.hpp"

namespace fase::world_queries {

/// Brings `state.query` up to date. Safe from any number of threads between steps. O(1) when nothing was edited since
/// the last step and the world was asked before lately; the first query builds the trees, some 0.3 µs a collider.
void make_ready(const WorldState& state);

/// The world box of a collider's shape as it stands now.
[[nodiscard]] inline Aabb tight_box(const WorldState& state, std::uint32_t collider) {
    const Collider& c = state.colliders[collider];
    return bounds(state.shapes[c.shape].shape, world_pose(state, c));
}

[[nodiscard]] inline bool is_outlier(const WorldState& state, std::uint32_t collider) {
    const auto& outliers = state.query.outliers;
    if (outliers.empty()) return false;
    const auto at = std::lower_bound(outliers.begin(), outliers.end(), collider,
                                     [](const broad::Move& m, std::uint32_t c) { return m.proxy < c; });
    return at != outliers.end() && at->proxy == collider;
}

/// Calls f(tree, overhang) for each tree that holds any.
template <class F> void for_each_set(const WorldState& state, const F& f) {
    const QueryTrees& query = state.query;
    const std::array<float, 3> overhang{0, query.asleep_overhang, query.awake_overhang};  // as MotionState counts
    for (std::size_t i = 0; i < query.trees.size(); ++i)
        if (query.trees[i].size() != 0) f(query.trees[i], overhang[i]);
}

/// The float at or above a double.
[[nodiscard]] inline float float_above(double value) {
    const float f = static_cast<float>(value);
    return double(f) < value ? std::nextafter(f, Aabb::infinity) : f;
}
/// The float at or below a double.
[[nodiscard]] inline float float_below(double value) { return -float_above(-value); }

/// Calls visit(collider, entry) once for each collider whose box is met by the ray, or by a box carried along it that
/// reaches from `before` to `after` around its origin; `entry`: metres to there, never more than to the shape. `visit`
/// returns how far colliders are still of interest; below 0: no farther at all.
template <class Visit>
void along(const WorldState& state, const Ray& ray, Vec3 before, Vec3 after, const Visit& visit) {
    float limit = ray.length;
    for_each_set(state, [&](const broad::WideBvh& set, float overhang) {
        if (limit < 0) return;
        const Vec3d out{overhang, overhang, overhang};
        const Aabb carried =
            overhang > 0 ? rounded_outward(to_double(before) - out, to_double(after) + out) : Aabb{before, after};
        set.nearest_first(broad::RayMeasure(ray, carried.lo, carried.hi), limit,
                          [&](broad::Proxy p, const Aabb&, float entry) {
                              if (!is_outlier(state, p)) limit = visit(p, entry);
                              return limit;
                          });
    });
    const broad::RayMeasure measure(ray, before, after);
    for (const broad::Move& outlier : state.query.outliers) {
        if (limit < 0) return;
        const float entry = measure.at(outlier.box, limit);
        if (entry < broad::beyond) limit = visit(outlier.proxy, entry);
    }
}

/// Calls visit(collider) once for each collider whose box touches `box`; a `visit` that returns false stops.
template <class Visit> void around(const WorldState& state, const Aabb& box, const Visit& visit) {
    bool goes_on = true;
    for_each_set(state, [&](const broad::WideBvh& set, float overhang) {
        if (!goes_on) return;
        set.traverse(broad::BoxRegion{grown(box, overhang)}, [&](broad::Proxy p, const Aabb&) {
            if (!is_outlier(state, p)) goes_on = visit(p);
            return goes_on;
        });
    });
    for (const broad::Move& outlier : state.query.outliers)
        if (goes_on && overlaps(outlier.box, box)) goes_on = visit(outlier.proxy);
}

/// Calls visit(collider) once for each collider whose box is within `radius` metres of a point. `visit` returns how far
/// colliders are still of interest.
template <class Visit> void near_point(const WorldState& state, Vec3d point, float radius, const Visit& visit) {
    float limit = radius;
    for_each_set(state, [&](const broad::WideBvh& set, float overhang) {
        const double more = 1.7320509 * double(overhang);  // along the diagonal
        const auto wider = [&] { return float_above(double(limit) + more); };
        set.nearest_first(broad::PointMeasure(point, wider()), wider(), [&](broad::Proxy p, const Aabb&, float) {
            if (!is_outlier(state, p)) limit = visit(p);
            return wider();
        });
    });
    for (const broad::Move& outlier : state.query.outliers)
        if (broad::PointMeasure(point, limit).at(outlier.box, limit) < broad::beyond) limit = visit(outlier.proxy);
}

/// Calls visit(collider, whole) once for each collider whose box may be seen; `whole`: its shape is wholly inside for
/// sure.
template <class Visit> void within(const WorldState& state, const Frustum& frustum, const Visit& visit) {
    for_each_set(state, [&](const broad::WideBvh& set, float overhang) {
        Frustum wider = frustum;
        for (Frustum::Side& side : wider.sides) {
            const Vec3d size = abs(side.normal);
            const double sum = size.x + size.y + size.z;
            if (sum > 0) side.offset += sum * double(overhang);
        }
        set.cull(broad::FrustumRegion(wider), [&](std::span<const broad::Proxy> proxies, bool whole) {
            for (const broad::Proxy p : proxies)
                if (!is_outlier(state, p)) visit(p, whole && overhang == 0);
        });
    });
    for (const broad::Move& outlier : state.query.outliers)
        if (overlaps(frustum, outlier.box)) visit(outlier.proxy, false);
}

}  // namespace fase::world_queries
