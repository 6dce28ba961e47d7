#pragma once
/// Exact penetration of two polyhedra, by the separating-axis test.
#include "fase/narrow/detail/penetration.hpp"

namespace fase::narrow {

/// Returns the minimum penetration of two polyhedral cores (points, segments, boxes, hulls; CoreTable::polyhedral): the
/// minimum depth over the faces of both and all pairs of edges that make a face of the Minkowski difference. An edge
/// pair must be better than the faces by `edge_bias` metres: 0 for the exact depth, a little for stable contacts. Cost:
/// faces × vertices + edges × edges. Cores without a common volume (points, segments) get depth 0 and a perpendicular
/// normal. Also accepts curved cores: the result then separates them, but is not always the shortest.
/// Source: Gregorius 2013, The separating axis test between convex polyhedra (Gauss-map pruning of edge pairs).
[[nodiscard]] Penetration sat(const CoreView& a, const CoreView& b, const TransformD& b_in_a, double edge_bias = 0);

}  // namespace fase::narrow
