#pragma once
/// The searches of the wide tree, compiled once for each instruction set: eight boxes per test.
#include "fase/broad/search/pair_sink.hpp"
#include "fase/broad/wide_bvh/node.hpp"
#include "fase/core/detail/function_ref.hpp"

namespace fase::broad::wide {

using VisitNear = FunctionRef<float(Proxy, const Aabb&, float)>;
using VisitOverlap = FunctionRef<bool(Proxy, const Aabb&)>;
using TakeRange = FunctionRef<void(std::span<const Proxy>, bool)>;

/// Returns whether the float searches below support a measure: all numbers finite, the position within 1e18 m.
/// Otherwise every node needs the exact test.
[[nodiscard]] bool fits_float(const RayMeasure& measure);
[[nodiscard]] bool fits_float(const PointMeasure& measure);

/// As broad::nearest_first(), in all trees of the forest. Nodes are tested in float, rounded conservatively;
/// measure.distance() of the exact box decides which boxes are visited. The measure must pass fits_float().
void nearest_first(const Forest& forest, const RayMeasure& measure, float limit, VisitNear visit);
void nearest_first(const Forest& forest, const PointMeasure& measure, float limit, VisitNear visit);

/// Visits all boxes that overlap `box` (not NaN); false when `visit` returned false.
bool traverse(const Forest& forest, const Aabb& box, VisitOverlap visit);

/// As broad::cull(), in all trees of the forest.
void cull(const Forest& forest, const FrustumRegion& region, TakeRange take);

/// Two overlapping nodes or boxes (leaf_bit | Place) that are not expanded yet.
struct NodePair {
    std::uint32_t a = 0, b = 0;
};
/// Adds all pairs of boxes below `start.a` in `one` and `start.b` in `two`, except of a proxy with itself; all pairs
/// below a node when both are the same. With `awake_only` (for a single forest), only pairs with an awake box.
void find_pairs(const Forest& one, const Forest& two, NodePair start, bool awake_only, PairSink& sink);
/// Expands one node pair: adds its pairs of boxes and appends the remaining node pairs to `left`.
void expand_pair(const Forest& one, const Forest& two, NodePair start, PairSink& sink, std::vector<NodePair>& left);

/// Recomputes the box of every inner child from node `begin` on; returns the sum of their costs.
double refit(Forest& forest, std::uint32_t begin);

}  // namespace fase::broad::wide
