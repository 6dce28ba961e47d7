#pragma once
/// The searches of the wide tree that are compiled once for each instruction set: eight boxes a test.
#include "fase/broad/search/pair_sink.hpp"
#include "fase/broad/wide_bvh/node.hpp"
#include "fase/core/detail/function_ref.hpp"

namespace fase::broad::wide {

using Near = FunctionRef<float(Proxy, const Aabb&, float)>;
using Found = FunctionRef<bool(Proxy, const Aabb&)>;
using Take = FunctionRef<void(std::span<const Proxy>, bool)>;

/// Whether the searches in float may be asked: all numbers finite, the place within 1e18 m. Else the exact test must
/// stand for every node.
[[nodiscard]] bool is_plain(const RayMeasure& measure);
[[nodiscard]] bool is_plain(const PointMeasure& measure);

/// As broad::nearest_first(), in all trees of the forest. Nodes are tested in float, rounded so that none is missed;
/// what is visited is decided by measure.at() of the exact box. The measure must be plain.
void nearest_first(const Forest& forest, const RayMeasure& measure, float limit, Near visit);
void nearest_first(const Forest& forest, const PointMeasure& measure, float limit, Near visit);

/// All that overlaps `box` (not NaN); false when `visit` said stop.
bool traverse(const Forest& forest, const Aabb& box, Found visit);

/// As broad::cull(), in all trees of the forest.
void cull(const Forest& forest, const FrustumRegion& region, Take take);

/// Two nodes, or boxes (leaf_bit | Place), whose boxes overlap and which have yet to be opened against each other.
struct Meeting {
    std::uint32_t a = 0, b = 0;
};
/// Adds all pairs of boxes below `start.a` in `one` and `start.b` in `two`, but those of a proxy with itself; all pairs
/// below a node when both are one. With `awake_only` (and one forest) those of which one is awake.
void find_pairs(const Forest& one, const Forest& two, Meeting start, bool awake_only, PairSink& sink);
/// Opens one meeting: adds the pairs that it holds and appends the meetings that are left.
void open_meeting(const Forest& one, const Forest& two, Meeting start, PairSink& sink, std::vector<Meeting>& left);

/// Gives every inner child from node `begin` on its union anew; the sum of their costs.
double refit(Forest& forest, std::uint32_t begin);

}  // namespace fase::broad::wide
