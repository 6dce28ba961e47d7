#pragma once
/// How deep two overlapping cores are in each other, and which way out is shortest: SAT or EPA, as the cores allow.
#include "fase/narrow/detail/gjk.hpp"

namespace fase::narrow {

/// A way out: moving b by `depth` along `normal` makes two cores touch. Frame of a.
struct Penetration {
    enum class Source { FaceOfA, FaceOfB, Edges, Curve };
    enum class State {
        Exact,  ///< least depth, to rounding
        Close,  ///< least depth, to the tolerance that was asked for
        Limit,  ///< the work limit was reached: a valid way out, perhaps not quite the shortest
    };
    Vec3d normal{0, 1, 0};  ///< unit, from a to b
    double depth = 0;       ///< metres; below 0: the cores are apart by at least that much
    Source source = Source::Curve;
    State state = State::Exact;
};

/// The width of the overlap of two cores along the unit `normal` (from a to b, a's frame): moving b by it separates
/// them.
[[nodiscard]] inline double depth_along(const CoreView& a, const CoreView& b, const TransformD& b_in_a, Vec3d normal) {
    const Vec3d on_b = transform(b_in_a, b.support(transpose_times(b_in_a.rotation, -normal)));
    return dot(normal, a.support(normal) - on_b);
}

struct PenetrationOptions {
    double tolerance = 1e-10;  ///< metres; for curved cores, which can only be approached
    double face_bias = 0;      ///< metres by which another way out must beat the best one along a face normal
};

/// The shortest way out of two cores that overlap or touch (radii are left out): exact when both are polyhedral, else
/// to the tolerance. `start`: the simplex that gjk() ended with. Always ends; thread-safe; allocates nothing.
[[nodiscard]] Penetration penetration(const CoreView& a, const CoreView& b, const TransformD& b_in_a,
                                      const Simplex& start, const PenetrationOptions& options = {});

/// GJK on the cores after the move by `way` and a little farther (a fiftieth of `scale`, GjkResult::scale): the points
/// that touch after the move stay closest on the way on, and there GJK sees them best. Frame of a; `on_b` is of the
/// moved b.
[[nodiscard]] GjkResult moved_apart(const CoreView& a, const CoreView& b, const TransformD& b_in_a,
                                    const Penetration& way, double scale, double tolerance = 1e-15);

}  // namespace fase::narrow
