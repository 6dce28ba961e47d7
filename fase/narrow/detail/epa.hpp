#pragma once
/// Penetration of two cores of which one is curved, by growing a polytope inside their Minkowski difference (EPA).
#include "fase/narrow/detail/gjk.hpp"
#include "fase/narrow/detail/penetration.hpp"

namespace fase::narrow {

struct EpaOptions {
    double tolerance = 1e-10;  ///< metres between the best way out found and the lower bound, at which to stop
    double bias = 0;           ///< metres by which a new way out must beat `known`
    int max_corners = 96;      ///< work limit: corners of the polytope, up to 96
};

/// The shortest way out of two overlapping cores. `known` is a way out that is known already (from sat(); infinite
/// depth for none): it is returned when nothing beats it, and a short one ends the search early. Starts from any
/// simplex of GJK, also a flat or empty one; touching and slightly parted cores give a depth about 0. State::Limit when
/// the work limit came first, or when the cores' Minkowski difference is flat. Always ends; thread-safe; allocates
/// nothing. Source: van den Bergen 2001, Proximity queries and penetration depth computation on 3D game objects.
[[nodiscard]] Penetration epa(const CoreView& a, const CoreView& b, const TransformD& b_in_a, const Simplex& start,
                              const Penetration& known, const EpaOptions& options = {});

}  // namespace fase::narrow
