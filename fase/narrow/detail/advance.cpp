/// Newton's method on the distance of two shapes.
#include "fase/narrow/detail/advance.hpp"

#include <algorithm>
#include <limits>

#include "fase/geometry/bounds.hpp"
#include "fase/narrow/detail/gjk.hpp"
#include "fase/narrow/detail/infinity.hpp"

namespace fase::narrow {
namespace {

/// Returns the gap between two shapes that are expected to be apart; 0 or less and no normal when they overlap.
Distance gap_between(const Shape& target, const Shape& mover, const TransformD& mover_in_target) {
    return std::visit(
        [&]<class A, class B>(const A& a, const B& b) -> Distance {
            if constexpr (ConvexShape<A> && ConvexShape<B>) {
                const CoreView view_a = core_view(a), view_b = core_view(b);
                const GjkResult cores = gjk(view_a, view_b, mover_in_target);
                const double gap = cores.distance - view_a.radius - view_b.radius;
                const Vec3d on_a = cores.on_a + cores.normal * view_a.radius;
                return {gap, on_a, on_a + cores.normal * gap, cores.normal};
            } else {
                return signed_distance(target, mover, mover_in_target);
            }
        },
        target, mover);
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

std::optional<Advance> advance(const Shape& target, const Shape& mover, const TransformD& start, Vec3d direction,
                               double length) {
    constexpr int max_rounds = 128;
    const double tolerance = advance_tolerance(target, mover);
    // Beyond this the shapes have passed each other: limits the size of all numbers.
    const double past = fase::length(start.position) + double(outer_radius(target)) + double(outer_radius(mover));
    const double max_distance = std::min({length, past * (1 + 1e-3), 1e30});
    Distance gap = signed_distance(target, mover, start);
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
        double next = distance + step;
        if (!(next <= max_distance)) {
            if (distance >= max_distance || !((next - max_distance) * approach <= tolerance)) return std::nullopt;
            next = max_distance;
        }
        const bool stuck = next <= distance;  // the step is below the rounding error of the distance
        distance = next;
        pose.position = start.position + direction * distance;
        const Vec3d normal = gap.normal;
        gap = gap_between(target, mover, pose);
        // At the touch the normal of the last separating plane is better than that of a gap of a few roundings.
        const bool has_normal = gap.distance > 1e-3 * tolerance;
        if (!has_normal) gap.normal = normal;
        if (stuck || !has_normal) return Advance{distance, gap.normal, gap.on_a};
    }
    return Advance{distance, gap.normal, gap.on_a};
}

}  // namespace fase::narrow
