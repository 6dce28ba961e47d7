#pragma once
/// Pairs of boxes in the leaves of a tree of cells, by SIMD tests.
#include "fase/broad/builders/cell_tree.hpp"
#include "fase/broad/search/pair_sink.hpp"

namespace fase::broad {

/// Consecutive leaves of a tree.
struct LeafRange {
    std::size_t begin = 0, end = 0;
};

/// Adds the pairs of boxes that share a leaf, for a tree whose leaves hold every box that overlaps their cell.
/// References are sorted by their marks; bit a of a mark tells that the box begins in the cell on the a-th of
/// `dimensions` axes. A pair is added by the leaf in which its intersection begins on all axes. `awake_only` leaves out
/// pairs of two sleeping boxes.
void find_pairs_in_leaves(const CellTree& tree, LeafRange range, int dimensions, bool awake_only, PairSink& sink);

/// Adds the pairs of boxes in leaves of the range with boxes of the same or a later leaf, for a tree without
/// references.
void find_pairs_near_leaves(const CellTree& tree, LeafRange range, bool awake_only, PairSink& sink);

/// Parts of a parallel search: their number for a number of leaves, and the leaves of part i.
inline constexpr std::size_t leaves_per_part = 64;
constexpr std::size_t parts_of(std::size_t leaves) { return (leaves + leaves_per_part - 1) / leaves_per_part; }
constexpr LeafRange leaves_of_part(std::size_t leaves, std::size_t i) {
    return {i * leaves_per_part, leaves < (i + 1) * leaves_per_part ? leaves : (i + 1) * leaves_per_part};
}

}  // namespace fase::broad
