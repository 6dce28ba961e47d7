#pragma once
/// Builds wide trees: repeats binary splits until a node has eight children.
#include "fase/broad/builders/morton_order.hpp"
#include "fase/broad/wide_bvh/node.hpp"

namespace fase::broad::wide {

/// Scratch memory of a build, reused between builds.
struct BuildScratch {
    std::vector<BuildItem> sorted;
    std::vector<MortonKey> keys, scratch_keys;
};

/// Appends a tree of `items` (1 or more, all regular; reorders them) to the forest: nodes in depth-first order, the
/// proxies below a node contiguous. In each node, the most expensive child with more than eight boxes is split again
/// until there are eight children; a node holds at most eight boxes. The boxes of inner children are not set; call
/// refit() afterwards. The awake bits are 0. Splits by the surface area heuristic, O(n log n).
void append_by_area(std::span<BuildItem> items, Forest& forest);
/// The same with splits along the Morton curve, largest child first: O(n). Several times faster to build, slower to
/// query.
void append_by_morton(std::span<BuildItem> items, Forest& forest, BuildScratch& scratch);

}  // namespace fase::broad::wide
