#pragma once
/// Cubes of twice the size of their place: each box is in one of them.
#include "fase/broad/builders/cell_structure.hpp"

namespace fase::broad {

/// Loose octree: cells overlap, each reaching half its side beyond itself on all sides. So a box fits into the cell
/// that its centre lies in, if that cell is no smaller than the box: its size says how deep it may be, its centre
/// where; no box lies across a cut. It stays at the first cell on the way there that is not full. Boxes that have to
/// stay where others go deeper make a leaf of their own there. Pairs: each leaf looks for those after it. The tree is
/// made anew by each commit() after which a box lies elsewhere. Boxes outside the declared bounds are held by the
/// border cells; infinite, NaN and inverted boxes are kept in a list and tested one by one. Holds up to 2^29 boxes.
/// Source: Ulrich 2000, Loose octrees, in: Game Programming Gems.
class LooseOctree : public CellStructure<3, LooseOctree> {
public:
    static constexpr StructureInfo info{"loose_octree",
                                        "each box in one cube of twice its place's size, chosen by its size and centre",
                                        "Ulrich 2000, Loose octrees, Game Programming Gems"};

    /// What may be tuned. The pairs and hits that are reported never depend on it, only their order and the time.
    struct Settings {
        std::uint32_t capacity = 48;  ///< a leaf with more boxes is split, unless all have to stay; at least 1
        int max_depth = 15;           ///< of a leaf; 0 to 15, the root's is 0
        std::optional<Aabb> bounds;   ///< of the root cell; none: as the boxes need it, anew at each commit
    };

    LooseOctree();
    explicit LooseOctree(const Settings& settings);

    /// Appends the pairs leaf by leaf.
    void find_pairs(std::vector<Pair>& out) const;
    /// The same pairs in the same order, found by several threads.
    void find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const;
    /// The pairs of which one box is awake: branches in which all rest are not looked at from where all rest.
    void find_awake_pairs(std::vector<Pair>& out) const;

    [[nodiscard]] std::size_t bytes() const;

private:
    friend CellStructure<3, LooseOctree>;
    using Path = CellPath<3>;
    static constexpr float cell_margin = 0.5f;
    static constexpr std::uint32_t staying = 8;  // the child that is a leaf for boxes that go no deeper

    /// A box in a cell that is yet to be split.
    struct Record {
        CellFrame<3>::Steps centre;
        std::uint16_t depth;  // the deepest that it may go
        std::uint32_t row;    // in store_.ordinary()
        [[nodiscard]] std::uint32_t child(const Path& cell) const;
    };
    /// A node that is yet to be split or to become a leaf, and its records.
    struct Task {
        Path path;
        std::uint32_t node = 0;
        std::uint32_t begin = 0, end = 0;
        bool is_leaf = false;
    };

    Settings settings_;
    std::vector<Record> records_;  // those of a task's children stand above its own
    std::vector<Task> tasks_;      // last in, first out

    void rebuild();
    [[nodiscard]] Record record_of(const Aabb& box, std::uint32_t row) const;
    bool try_split(const Task& task);
    [[nodiscard]] std::string broken_cells() const;
};

}  // namespace fase::broad
