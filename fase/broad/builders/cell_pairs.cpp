/// Compiles the pair searches for every SIMD target and selects one at run time.
#include "fase/core/detail/simd_targets.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fase/broad/builders/cell_pairs.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/highway.h>

#include "fase/broad/builders/cell_pairs.hpp"

HWY_BEFORE_NAMESPACE();
namespace fase::broad::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
#include "fase/broad/builders/cell_pairs-inl.hpp"

void in_leaves(const CellTree& tree, LeafRange range, std::uint32_t dimensions, bool awake_only, PairSink& sink) {
    PairsInLeaves search(tree, dimensions, sink);
    for (const CellTree::Leaf& leaf : tree.leaves().subspan(range.begin, range.end - range.begin))
        if (!awake_only || tree.nodes()[leaf.node].awake) search.run(leaf, awake_only);
}
void near_leaves(const CellTree& tree, LeafRange range, bool awake_only, PairSink& sink) {
    PairsNearLeaves search(tree, sink);
    for (std::size_t leaf = range.begin; leaf < range.end; ++leaf)
        search.run(static_cast<std::uint32_t>(leaf), awake_only);
}
}  // namespace fase::broad::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fase::broad {

HWY_EXPORT(in_leaves);
HWY_EXPORT(near_leaves);
void find_pairs_in_leaves(const CellTree& tree, LeafRange range, int dimensions, bool awake_only, PairSink& sink) {
    HWY_DYNAMIC_DISPATCH(in_leaves)(tree, range, static_cast<std::uint32_t>(dimensions), awake_only, sink);
}
void find_pairs_near_leaves(const CellTree& tree, LeafRange range, bool awake_only, PairSink& sink) {
    HWY_DYNAMIC_DISPATCH(near_leaves)(tree, range, awake_only, sink);
}

}  // namespace fase::broad
#endif
