#pragma once
/// Builds wide trees: a binary cut is repeated until eight children stand side by side.
#include "fase/broad/builders/morton_order.hpp"
#include "fase/broad/wide_bvh/node.hpp"

namespace fase::broad::wide {

/// Memory that building needs; reused from one time to the next.
struct BuildScratch {
    std::vector<BuildItem> sorted;
    std::vector<MortonKey> keys, spare_keys;
};

/// Appends a tree of `items` (1 or more, all ordinary; they are reordered) to the forest: nodes in depth-first order,
/// and the proxies below a node in a row. Where a node's children could hold more than eight boxes each, the child that
/// costs most is cut again, until there are eight; at most eight boxes stand in one node. Inner children have no boxes
/// yet: refit() gives them. Nothing is awake yet. By area: binned cuts, O(n log n).
void append_by_area(std::span<BuildItem> items, Forest& forest);
/// The same along the Morton curve, the largest child cut first: O(n), several times faster to build, slower to ask.
void append_by_morton(std::span<BuildItem> items, Forest& forest, BuildScratch& scratch);

}  // namespace fase::broad::wide
