/// Newton's method on the distance of two shapes.
#include "fase/narrow/detail/advance.hpp"

#include <algorithm>
#include <limits>

#include "fase/geometry/bounds.hpp"
#include "fase/narrow/detail/core_distance.hpp"
#include "fase/narrow/detail/gjk.hpp"
#include "fase/narrow/detail/infinity.hpp"
#include "fase/narrow/detail/mesh_queries.hpp"

namespace fase::narrow {
namespace {

/// Returns the gap between two cores that are expected to be apart; 0 or less and no normal when they overlap.
Distance gap_between(const CoreView& a, const CoreView& b, const TransformD& b_in_a) {
    const GjkResult cores = gjk(a, b, b_in_a);
    const double gap = cores.distance - a.radius - b.radius;
    const Vec3d on_a = cores.on_a + cores.normal * a.radius;
    return {gap, on_a, on_a + cores.normal * gap, cores.normal};
}

/// The search of advance(). `first(pose)` returns the signed distance at the start, `next(pose)` that of shapes that
/// are expected to be apart. `size`: the sum of the outer radii.
template <class First, class Next>
std::optional<Advance> search(const First& first, const Next& next, const TransformD& start, Vec3d direction,
                              double length, double tolerance, double size) {
    constexpr int max_rounds = 128;
    // Beyond this the shapes have passed each other: limits the size of all numbers.
    const double past = fase::length(start.position) + size;
    const double max_distance = std::min({length, past * (1 + 1e-3), 1e30});
    Distance gap = first(start);
    if (!(gap.distance > 0)) return Advance{0, gap.normal, gap.on_a, true};
    TransformD pose = start;
    double distance = 0;
    for (int round = 0; round < max_rounds; ++round) {
        const double approach = -dot(direction, gap.normal);
        if (!(approach > 0)) return std::nullopt;
        const double step = gap.distance / approach;
        if (gap.distance <= tolerance) {
            // Also moves through the rest if it is as small as the tolerance: a plane still separates the shapes there.
            distance = std::min(distance + std::min(step, 10 * tolerance), max_distance);
            return Advance{distance, gap.normal, gap.on_a};
        }
        double here = distance + step;
        if (!(here <= max_distance)) {
            if (distance >= max_distance || !((here - max_distance) * approach <= tolerance)) return std::nullopt;
            here = max_distance;
        }
        const bool stuck = here <= distance;  // the step is below the rounding error of the distance
        distance = here;
        pose.position = start.position + direction * distance;
        const Vec3d normal = gap.normal;
        gap = next(pose);
        // At the touch the normal of the last separating plane is better than that of a gap of a few roundings.
        const bool has_normal = gap.distance > 1e-3 * tolerance;
        if (!has_normal) gap.normal = normal;
        if (stuck || !has_normal) return Advance{distance, gap.normal, gap.on_a};
    }
    return Advance{distance, gap.normal, gap.on_a};
}

/// A cast of two shapes of which neither is a mesh.
std::optional<Advance> advance_convex(const Shape& target, const Shape& mover, const TransformD& start, Vec3d direction,
                                      double length) {
    const double tolerance = advance_tolerance(target, mover);
    const double size = double(outer_radius(target)) + double(outer_radius(mover));
    const auto first = [&](const TransformD& pose) { return signed_distance(target, mover, pose); };
    const auto next = [&](const TransformD& pose) {
        return std::visit(
            [&]<class A, class B>(const A& a, const B& b) -> Distance {
                if constexpr (ConvexShape<A> && ConvexShape<B>) {
                    return gap_between(core_view(a), core_view(b), pose);
                } else {
                    return signed_distance(target, mover, pose);
                }
            },
            target, mover);
    };
    return search(first, next, start, direction, length, tolerance, size);
}

}  // namespace

double advance_tolerance(const Shape& target, const Shape& mover) {
    double smaller = infinity, larger = 0;
    for (const double size : {double(outer_radius(target)), double(outer_radius(mover))}) {
        if (!(size > 0 && size < infinity)) continue;
        smaller = std::min(smaller, size);
        larger = std::max(larger, size);
    }
    return std::max(std::min(1e-7 * smaller, 1e-6), 1e-11 * larger);
}

std::optional<Advance> advance_cores(const CoreView& target, const CoreView& mover, const TransformD& start,
                                     Vec3d direction, double length, double tolerance, double size) {
    return search([&](const TransformD& pose) { return distance_of_cores(target, mover, pose); },
                  [&](const TransformD& pose) { return gap_between(target, mover, pose); }, start, direction, length,
                  tolerance, size);
}

std::optional<Advance> advance(const Shape& target, const Shape& mover, const TransformD& start, Vec3d direction,
                               double length) {
    if (const auto* mesh = std::get_if<Mesh>(&target)) return advance_to_mesh(*mesh, mover, start, direction, length);
    const auto* mesh = std::get_if<Mesh>(&mover);
    if (mesh == nullptr) return advance_convex(target, mover, start, direction, length);
    // In the frame of the mesh the other shape moves, the other way.
    const Vec3d back = transpose_times(start.rotation, -direction);
    std::optional<Advance> stop = advance_to_mesh(*mesh, target, inverse(start), back, length);
    if (!stop) return stop;
    stop->triangle = no_index;  // of the mover
    stop->normal = -(start.rotation * stop->normal);
    stop->on_target = transform(start, stop->on_target) + direction * stop->distance;
    return stop;
}

}  // namespace fase::narrow
