#pragma once
/// Statistics of a structure, for tables and reports.
#include "fase/broad/structure.hpp"

namespace fase::broad {

/// Size and shape of a structure.
struct StructureStats {
    std::size_t boxes = 0;
    std::size_t nodes = 0;         ///< inner nodes, leaves and empty children
    std::size_t leaves = 0;        ///< leaves that hold a box
    std::size_t entries = 0;       ///< boxes in leaves; a box counts once per leaf
    std::size_t largest_leaf = 0;  ///< entries of the fullest leaf
    int depth = 0;                 ///< of the deepest leaf; 0 for the root
    std::size_t bytes = 0;         ///< memory in use, spare capacity included
    /// Mean number of boxes in a leaf; 0 without leaves.
    [[nodiscard]] double occupancy() const {
        return leaves == 0 ? 0 : static_cast<double>(entries) / static_cast<double>(leaves);
    }
};

/// Combined statistics of two separate structures.
[[nodiscard]] inline StructureStats operator+(const StructureStats& a, const StructureStats& b) {
    return {.boxes = a.boxes + b.boxes,
            .nodes = a.nodes + b.nodes,
            .leaves = a.leaves + b.leaves,
            .entries = a.entries + b.entries,
            .largest_leaf = a.largest_leaf > b.largest_leaf ? a.largest_leaf : b.largest_leaf,
            .depth = a.depth > b.depth ? a.depth : b.depth,
            .bytes = a.bytes + b.bytes};
}

/// Collects the statistics by a traversal of all leaves. O(n).
template <Structure S> [[nodiscard]] StructureStats stats_of(const S& structure) {
    StructureStats stats{.boxes = structure.size(), .nodes = structure.nodes(), .bytes = structure.bytes()};
    structure.for_each_leaf([&](const Leaf& leaf) {
        ++stats.leaves;
        stats.entries += leaf.proxies.size();
        stats.largest_leaf = leaf.proxies.size() > stats.largest_leaf ? leaf.proxies.size() : stats.largest_leaf;
        stats.depth = leaf.depth > stats.depth ? leaf.depth : stats.depth;
    });
    return stats;
}

}  // namespace fase::broad
