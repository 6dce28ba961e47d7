#pragma once
/// The pairs of boxes in the leaves of a tree of cells, many tests at a time.
#include "fase/broad/build/cell_tree.hpp"
#include "fase/broad/pair_sink.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// Consecutive leaves of a tree.
struct LeafRange {
    std::size_t begin = 0, end = 0;
};

/// The pairs of boxes that are in one leaf together, for a tree whose leaves hold every box that overlaps their cell:
/// visitors are sorted by their marks, of which bit a says that the box begins in the cell along the a-th of
/// `dimensions` axes. A pair is reported by the leaf in which it begins along all axes. With `awake_only`, pairs of two
/// boxes that rest are left out.
void find_pairs_in_leaves(const CellTree& tree, LeafRange range, int dimensions, bool awake_only, PairSink& sink);

/// The pairs of a box of a leaf in the range and one of the same or of a later leaf, for a tree without visitors.
void find_pairs_near_leaves(const CellTree& tree, LeafRange range, bool awake_only, PairSink& sink);

/// Calls `find(range, sink)` for parts of all the leaves, on several threads, and appends what they find in the order
/// of the leaves.
template <class Find>
void find_in_parts(TaskRunner& tasks, std::size_t leaves, std::vector<Pair>& out, const Find& find) {
    constexpr std::size_t grain = 64;
    std::vector<std::vector<Pair>> found((leaves + grain - 1) / grain);
    parallel_ranges(tasks, leaves, grain, [&](std::size_t begin, std::size_t end) {
        PairSink sink(found[begin / grain]);
        find({begin, end}, sink);
    });
    for (const std::vector<Pair>& part : found) out.insert(out.end(), part.begin(), part.end());
}

}  // namespace fase::broad
