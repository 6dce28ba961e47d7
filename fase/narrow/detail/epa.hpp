#pragma once
/// Penetration of two cores, at least one curved, by the expanding polytope algorithm (EPA).
#include "fase/narrow/detail/gjk.hpp"
#include "fase/narrow/detail/penetration.hpp"

namespace fase::narrow {

/// Limits of epa().
struct EpaOptions {
    double tolerance = 1e-10;  ///< metres between the best depth and the lower bound at which to stop
    double bias = 0;           ///< metres by which a new penetration must be smaller than `known`
    int max_corners = 96;      ///< work limit: corners of the polytope, up to 96
};

/// Returns the minimum penetration of two overlapping cores. `known` is an upper bound (from sat(); infinite depth for
/// none): it is returned when no smaller one is found, and a small one ends the search early. Starts from any simplex
/// of GJK, also a flat or empty one; touching and slightly separated cores give a depth of about 0. State::Limit when
/// the work limit is reached, or when the Minkowski difference of the cores is flat. Always terminates; thread-safe;
/// allocates nothing. Source: van den Bergen 2001, Proximity queries and penetration depth computation on 3D game
/// objects.
[[nodiscard]] Penetration epa(const CoreView& a, const CoreView& b, const TransformD& b_in_a, const Simplex& start,
                              const Penetration& known, const EpaOptions& options = {});

}  // namespace fase::narrow
