#pragma once
/// Exact penetration of two polyhedra, by the separating-axis test.
#include "fase/narrow/detail/penetration.hpp"

namespace fase::narrow {

/// The shortest way out of two polyhedral cores (points, segments, boxes, hulls; CoreTable::polyhedral): least depth
/// over the faces of both and all pairs of edges that make a face of the Minkowski difference. An edge pair must beat
/// the faces by `edge_bias` metres: 0 for the exact depth, a little for contacts that should not flicker. Cost: faces ×
/// vertices + edges × edges. Cores that share no volume (points, segments) get depth 0 and a normal at right angles.
/// Curved cores may be asked too: the answer is then a way out, but not always the shortest.
/// Source: Gregorius 2013, The separating axis test between convex polyhedra (Gauss-map pruning of edge pairs).
[[nodiscard]] Penetration sat(const CoreView& a, const CoreView& b, const TransformD& b_in_a, double edge_bias = 0);

}  // namespace fase::narrow
