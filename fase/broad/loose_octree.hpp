#pragma once
/// Loose octree: cells enlarged to twice their size, so that each box is in one of them.
#include "fase/broad/builders/cell_structure.hpp"
#include "fase/broad/search/partitioned_search.hpp"

namespace fase::broad {

/// Loose octree: each cell is enlarged by half its side on all sides, so cells overlap. A box fits into the cell that
/// contains its centre if the cell is no smaller than the box: its size limits the depth, its centre selects the cell;
/// no box straddles a split. A box is stored in the first cell on this path that is not full. Boxes too large for the
/// children of a split cell are stored in a separate leaf at that cell. Pairs: each leaf is tested against the leaves
/// after it. commit() rebuilds the tree after any change of a box. Boxes outside the declared bounds are in the border
/// cells; unbounded boxes (infinite, NaN, inverted) are kept in a list and tested one by one. Holds up to 2^29 boxes.
/// Source: Ulrich 2000, Loose octrees, in: Game Programming Gems.
class LooseOctree : public CellStructure<3, LooseOctree> {
public:
    static constexpr StructureInfo info{
        "loose_octree", "each box in one cube enlarged to twice its size, chosen by its size and centre",
        "Ulrich 2000, Loose octrees, Game Programming Gems"};

    /// Tuning parameters. They affect the order of the results and the time, never which pairs and hits are reported.
    struct Settings {
        std::uint32_t capacity = 48;  ///< a leaf with more boxes is split, unless none fits a child; at least 1
        int max_depth = 15;           ///< of a leaf; 0 to 15, 0 is the root
        std::optional<Aabb> bounds;   ///< of the root cell; none: fitted to the boxes at each commit
    };

    LooseOctree();
    explicit LooseOctree(const Settings& settings);

    /// Appends all pairs, leaf by leaf.
    void find_pairs(std::vector<Pair>& out) const;
    /// Finds the same pairs in the same order on several threads.
    void find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const;
    /// Appends the pairs with an awake box. Does not test two branches in which all boxes sleep against each other.
    void find_awake_pairs(std::vector<Pair>& out) const;

    [[nodiscard]] std::size_t bytes() const;

private:
    friend CellStructure<3, LooseOctree>;
    using Path = CellPath<3>;
    static constexpr float cell_margin = 0.5f;
    static constexpr std::uint32_t own_leaf = 8;  // child number of the leaf for boxes too large for a child

    /// A box while the tree is built.
    struct Record {
        CellFrame<3>::Steps centre;
        std::uint16_t depth;  // largest depth whose cells hold the box
        std::uint32_t row;    // in store_.regular()
        [[nodiscard]] std::uint32_t child(const Path& cell) const;
    };
    /// A pending node of the build, with its range of records.
    struct Task {
        Path path;
        std::uint32_t node = 0;
        std::uint32_t begin = 0, end = 0;
        bool is_leaf = false;
    };

    Settings settings_;
    std::vector<Record> records_;             // a stack: the records of a task's children follow its own
    std::vector<Task> tasks_;                 // a stack
    mutable ThreadLocalPairBuffers buffers_;  // scratch of find_pairs() with tasks

    void rebuild();
    [[nodiscard]] Record record_of(const Aabb& box, std::uint32_t row) const;
    bool try_split(const Task& task);
    [[nodiscard]] std::string broken_cells() const;
};

}  // namespace fase::broad
