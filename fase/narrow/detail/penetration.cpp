/// Chooses between SAT and EPA.
#include "fase/narrow/detail/penetration.hpp"

#include "fase/narrow/detail/epa.hpp"
#include "fase/narrow/detail/sat.hpp"

namespace fase::narrow {

Penetration penetration(const CoreView& a, const CoreView& b, const TransformD& b_in_a, const Simplex& start,
                        const PenetrationOptions& options) {
    const Penetration straight = sat(a, b, b_in_a, options.face_bias);
    if (a.table->polyhedral && b.table->polyhedral) return straight;
    EpaOptions limits;
    limits.tolerance = options.tolerance;
    limits.bias = options.face_bias;
    return epa(a, b, b_in_a, start, straight, limits);
}

GjkResult moved_apart(const CoreView& a, const CoreView& b, const TransformD& b_in_a, const Penetration& way,
                      double scale, double tolerance) {
    constexpr double share = 0.02;
    TransformD parted = b_in_a;
    parted.position += way.normal * (way.depth + share * scale);
    GjkOptions options;
    options.tolerance = tolerance;
    return gjk(a, b, parted, options);
}

}  // namespace fase::narrow
