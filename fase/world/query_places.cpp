/// Queries for places: overlaps, points, frusta, nearest colliders.
#include <limits>

#include "fase/narrow/cast_ray.hpp"
#include "fase/narrow/distance.hpp"
#include "fase/world/detail/query_checks.hpp"

namespace fase {

using namespace world_queries;

namespace {

bool contains_point(const WorldState& state, std::uint32_t collider, Vec3d point) {
    const Ray ray{point, {0, -1, 0}, 0};
    return narrow::cast_ray(shape_of(state, collider), world_pose(state.bodies, state.colliders[collider]), ray)
        .has_value();
}

/// Returns the smallest dot(direction, point) of a box. Axes with direction 0 give 0, so that an unbounded box gives no
/// NaN.
double min_along(Vec3d direction, const Aabb& box) {
    double sum = 0;
    for (int i = 0; i < 3; ++i)
        if (direction[i] != 0) sum += direction[i] * double(direction[i] > 0 ? box.lo[i] : box.hi[i]);
    return sum;
}

bool overlaps_box(const WorldState& state, std::uint32_t collider, const Aabb& box) {
    const Shape& shape = shape_of(state, collider);
    const Pose pose = world_pose(state.bodies, state.colliders[collider]);
    if (std::holds_alternative<HalfSpace>(shape)) {
        const Vec3d up = rotate(normalized(to_double(pose.rotation)), Vec3d{0, 1, 0});
        return min_along(up, box) <= dot(up, pose.position);
    }
    // Clips the box to the bounds of the shape: the result is finite, and small enough for the precision of float.
    const Aabb around = bounds(shape, pose);
    if (!overlaps(around, box)) return false;
    if (contains(box, around)) return true;
    const Vec3d lo = to_double(max(box.lo, around.lo)), hi = to_double(min(box.hi, around.hi));
    const Vec3d half = (hi - lo) * 0.5;
    const Box clipped{{float_above(half.x), float_above(half.y), float_above(half.z)}};
    return narrow::overlaps(shape, clipped, exactly_relative(pose, {(lo + hi) * 0.5, {}}));
}

/// Returns the largest dot(direction, point) of a shape, with the direction in world axes.
double max_along(const Shape& shape, const Pose& pose, Vec3d direction) {
    const Vec3d local = rotate_back(normalized(to_double(pose.rotation)), direction);
    const double reach = std::visit(
        [&]<class S>(const S& s) -> double {
            if constexpr (ConvexShape<S>) {
                return dot(local, s.core_support(local)) + double(s.core_radius()) * length(local);
            } else if constexpr (std::is_same_v<S, HalfSpace>) {
                const bool is_normal = local.x == 0 && local.z == 0 && local.y > 0;
                return is_normal ? 0 : std::numeric_limits<double>::infinity();
            } else {
                return -min_along(-direction, bounds(shape, pose)) - dot(direction, pose.position);
            }
        },
        shape);
    return dot(direction, pose.position) + reach;
}

enum class View { Outside, Partly, Inside };

/// `frustum_bounds`: bounds(frustum).
View view_of(const WorldState& state, std::uint32_t collider, const Frustum& frustum, const Aabb& frustum_bounds) {
    const Shape& shape = shape_of(state, collider);
    const Pose pose = world_pose(state.bodies, state.colliders[collider]);
    if (!overlaps(frustum_bounds, bounds(shape, pose))) return View::Outside;
    View view = View::Inside;
    for (const Frustum::Side& side : frustum.sides) {
        if (length_squared(side.normal) == 0) continue;
        if (max_along(shape, pose, side.normal) <= side.offset) continue;
        if (-max_along(shape, pose, -side.normal) > side.offset) return View::Outside;
        view = View::Partly;
    }
    return view;
}

struct Near {
    double distance = 0;
    std::uint32_t collider = 0;
    Vec3d point;
    friend bool operator<(const Near& a, const Near& b) {
        return a.distance != b.distance ? a.distance < b.distance : a.collider < b.collider;
    }
};

Near distance_to(const WorldState& state, std::uint32_t collider, Vec3d point) {
    if (contains_point(state, collider, point)) return {0, collider, point};
    const Pose pose = world_pose(state.bodies, state.colliders[collider]);
    const narrow::Distance gap =
        narrow::signed_distance(shape_of(state, collider), Sphere{0}, exactly_relative(pose, {point, {}}));
    const Vec3d nearest = pose.position + rotate(normalized(to_double(pose.rotation)), gap.on_a);
    return {std::max(gap.distance, 0.0), collider, nearest};
}

/// Appends the colliders for which `matches(state, collider)` holds, of those whose boxes touch `box`.
template <class F>
Result<void> collect(const World& world, const char* where, const Aabb& box, const QueryFilter& filter,
                     std::vector<Found>& out, const F& matches) {
    return run_query<Result<void>>(world, where, [&](const WorldState& state) -> Result<void> {
        std::vector<std::uint32_t> colliders;
        visit_overlapping(state.query, box, [&](std::uint32_t collider) {
            if (passes_filter(state, filter, collider) && matches(state, collider)) colliders.push_back(collider);
            return true;
        });
        append(state, colliders, out);
        return {};
    });
}

}  // namespace

Result<void> overlapping(const World& world, const Shape& shape, const Pose& pose, const QueryFilter& filter,
                         std::vector<Found>& out) {
    if (auto checked = check_placed(shape, pose, "overlapping"); !checked) return checked;
    return collect(world, "overlapping", bounds(shape, pose), filter, out,
                   [&](const WorldState& state, std::uint32_t collider) {
                       const Pose other = world_pose(state.bodies, state.colliders[collider]);
                       return narrow::overlaps(shape_of(state, collider), shape, exactly_relative(other, pose));
                   });
}

Result<void> overlapping(const World& world, const Aabb& box, const QueryFilter& filter, std::vector<Found>& out) {
    if (is_empty(box)) return refused("overlapping: box", "a NaN, or lo above hi", "lo at most hi on every axis");
    return collect(world, "overlapping", box, filter, out,
                   [&](const WorldState& state, std::uint32_t collider) { return overlaps_box(state, collider, box); });
}

Result<void> colliders_at(const World& world, Vec3d point, const QueryFilter& filter, std::vector<Found>& out) {
    if (auto checked = check_position(point, "colliders_at: point"); !checked) return checked;
    return collect(
        world, "colliders_at", rounded_outward(point, point), filter, out,
        [&](const WorldState& state, std::uint32_t collider) { return contains_point(state, collider, point); });
}

Result<void> seen_by(const World& world, const Frustum& frustum, const QueryFilter& filter, std::vector<Found>& seen,
                     std::vector<Found>* partly) {
    if (auto checked = check_frustum(frustum, "seen_by: frustum"); !checked) return checked;
    return run_query<Result<void>>(world, "seen_by", [&](const WorldState& state) -> Result<void> {
        const Aabb box = bounds(frustum);
        std::vector<std::uint32_t> all, cut;
        visit_in_frustum(state.query, frustum, [&](std::uint32_t collider, bool inside) {
            if (!passes_filter(state, filter, collider)) return;
            const View view = inside ? View::Inside : view_of(state, collider, frustum, box);
            if (view == View::Outside) return;
            all.push_back(collider);
            if (view == View::Partly && partly != nullptr) cut.push_back(collider);
        });
        const std::size_t before = seen.size();
        append(state, all, seen);
        if (partly == nullptr) return {};
        try {
            append(state, cut, *partly);
        } catch (const std::bad_alloc&) {
            seen.resize(before);
            throw;
        }
        return {};
    });
}

Result<void> nearest(const World& world, Vec3d point, std::size_t k, float radius, const QueryFilter& filter,
                     std::vector<NearHit>& out) {
    if (auto checked = check_position(point, "nearest: point"); !checked) return checked;
    if (k == 0) return refused("nearest: k", "0", "1 or more");
    if (auto checked = check_length(radius, "nearest: radius"); !checked) return checked;
    return run_query<Result<void>>(world, "nearest", [&](const WorldState& state) -> Result<void> {
        std::vector<Near> best;  // a heap with the farthest on top
        visit_near(state.query, point, radius, [&](std::uint32_t collider) {
            if (passes_filter(state, filter, collider)) {
                const Near here = distance_to(state, collider, point);
                if (best.size() == k && here < best.front()) {
                    std::pop_heap(best.begin(), best.end());
                    best.pop_back();
                }
                if (best.size() < k && here.distance <= double(radius)) {
                    best.push_back(here);
                    std::push_heap(best.begin(), best.end());
                }
            }
            return best.size() < k ? radius : float_above(best.front().distance);
        });
        std::sort_heap(best.begin(), best.end());
        if (out.capacity() - out.size() < best.size()) out.reserve(std::max(out.size() + best.size(), 2 * out.size()));
        for (const Near& n : best) {
            out.push_back({found(state, n.collider), static_cast<float>(n.distance), n.point});
        }
        return {};
    });
}

}  // namespace fase
