#pragma once
/// Penetration depth and direction of two overlapping cores: by SAT for polyhedra, else by EPA.
#include "fase/narrow/detail/gjk.hpp"

namespace fase::narrow {

/// A separating translation: moving b by `depth` along `normal` makes the two cores touch. Frame of a.
struct Penetration {
    enum class Source { FaceOfA, FaceOfB, Edges, Curve };
    enum class State {
        Exact,  ///< minimum depth, to rounding
        Close,  ///< minimum depth, to the requested tolerance
        Limit,  ///< the work limit was reached: a valid translation, perhaps not the shortest
    };
    Vec3d normal{0, 1, 0};  ///< unit, from a to b
    double depth = 0;       ///< metres; below 0: the cores are apart by at least that much
    Source source = Source::Curve;
    State state = State::Exact;
};

/// Returns the overlap of two cores along the unit `normal` (from a to b, a's frame): moving b by it separates them.
[[nodiscard]] inline double depth_along(const CoreView& a, const CoreView& b, const TransformD& b_in_a, Vec3d normal) {
    const Vec3d on_b = transform(b_in_a, b.support(transpose_times(b_in_a.rotation, -normal)));
    return dot(normal, a.support(normal) - on_b);
}

/// Tolerances of penetration().
struct PenetrationOptions {
    double tolerance = 1e-10;  ///< metres; for curved cores, which are solved iteratively
    double face_bias = 0;      ///< metres by which another direction must be better than the best face normal
};

/// Returns the minimum penetration of two cores that overlap or touch (without radii): exact when both are polyhedral,
/// else to the tolerance. `start`: the last simplex of gjk(). Always terminates; thread-safe; allocates nothing.
[[nodiscard]] Penetration penetration(const CoreView& a, const CoreView& b, const TransformD& b_in_a,
                                      const Simplex& start, const PenetrationOptions& options = {});

/// Runs GJK after moving b by `penetration` and farther by a fiftieth of `scale` (GjkResult::scale): the points that
/// touch after the first move stay closest, and GJK finds them more accurately there. Frame of a; `on_b` is of the
/// moved b.
[[nodiscard]] GjkResult gjk_after_separation(const CoreView& a, const CoreView& b, const TransformD& b_in_a,
                                             const Penetration& penetration, double scale, double tolerance = 1e-15);

}  // namespace fase::narrow
