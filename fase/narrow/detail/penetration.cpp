/// Chooses between SAT and EPA.
#include "fase/narrow/detail/penetration.hpp"

#include "fase/narrow/detail/epa.hpp"
#include "fase/narrow/detail/sat.hpp"

namespace fase::narrow {

Penetration penetration(const CoreView& a, const CoreView& b, const TransformD& b_in_a, const Simplex& start,
                        const PenetrationOptions& options) {
    const Penetration by_axes = sat(a, b, b_in_a, options.face_bias);
    if (a.table->polyhedral && b.table->polyhedral) return by_axes;
    EpaOptions limits;
    limits.tolerance = options.tolerance;
    limits.bias = options.face_bias;
    return epa(a, b, b_in_a, start, by_axes, limits);
}

GjkResult gjk_after_separation(const CoreView& a, const CoreView& b, const TransformD& b_in_a,
                               const Penetration& penetration, double scale, double tolerance) {
    constexpr double extra = 0.02;
    TransformD separated = b_in_a;
    separated.position += penetration.normal * (penetration.depth + extra * scale);
    GjkOptions options;
    options.tolerance = tolerance;
    return gjk(a, b, separated, options);
}

}  // namespace fase::narrow
