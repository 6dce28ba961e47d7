#pragma once
/// The pairs of boxes in the leaves of a tree of cells, many tests at a time.
#include "fase/broad/builders/cell_tree.hpp"
#include "fase/broad/search/pair_sink.hpp"

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

/// How many parts a search through that many leaves is cut into, and which leaves part i has.
inline constexpr std::size_t leaves_a_part = 64;
constexpr std::size_t parts_of(std::size_t leaves) { return (leaves + leaves_a_part - 1) / leaves_a_part; }
constexpr LeafRange leaves_of_part(std::size_t leaves, std::size_t i) {
    return {i * leaves_a_part, leaves < (i + 1) * leaves_a_part ? leaves : (i + 1) * leaves_a_part};
}

}  // namespace fase::broad
