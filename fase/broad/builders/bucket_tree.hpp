#pragma once
/// Cells that are halved along each of their axes when they hold too many boxes; a box is in every leaf that it
/// overlaps.
#include "fase/broad/builders/cell_structure.hpp"

namespace fase::broad {

/// What quadtree and octree share. All boxes are given whole numbers first: the steps (CellFrame) of their lower and
/// their upper corner. These alone say which leaves a box overlaps, and so do they say which leaf holds the lower
/// corner of what two boxes have in common: that leaf reports the pair, the others that both are in do not.
///
/// A leaf with more boxes than the capacity is split, but not when that does not pay: when the pairs that need not be
/// tested any more are fewer than the capacity times the entries that arise because boxes lie across the cut. So boxes
/// in one place, and boxes larger than the cell, end the splitting. And there is never more than `max_entries` entries
/// a box in the mean, whatever the boxes. Holds up to 2^29 boxes.
template <int Dim> class BucketTree : public CellStructure<Dim, BucketTree<Dim>> {
public:
    /// Entries a box that the tree may have at most, in the mean.
    static constexpr std::uint32_t max_entries = 16;

    /// Appends the pairs leaf by leaf.
    void find_pairs(std::vector<Pair>& out) const;
    /// The same pairs in the same order, found by several threads.
    void find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const;
    /// The pairs of which one box is awake: branches in which all rest are not looked at.
    void find_awake_pairs(std::vector<Pair>& out) const;

    [[nodiscard]] std::size_t bytes() const {
        return sizeof(*this) + this->store_.bytes() + this->tree_.bytes() + records_.capacity() * sizeof(Record) +
               tasks_.capacity() * sizeof(Task) + place_.capacity() * sizeof(std::uint32_t) + masks_.capacity();
    }

protected:
    struct Limits {
        std::uint32_t capacity = 0;
        int max_depth = 0;
    };
    using Axes = typename CellFrame<Dim>::Axes;
    BucketTree(const Axes& axes, const Limits& limits, const std::optional<Aabb>& bounds)
        : axes_(axes), limits_(limits), declared_(bounds) {}

private:
    friend CellStructure<Dim, BucketTree<Dim>>;
    using Path = CellPath<Dim>;
    using Steps = typename CellFrame<Dim>::Steps;
    static constexpr float cell_margin = 0;
    static constexpr std::uint32_t child_count = 1u << Dim;
    static constexpr std::uint32_t owned = child_count - 1;  // mark: begins in the leaf along all axes

    /// A box in a cell that is yet to be split.
    struct Record {
        std::uint64_t lo, hi;  // steps, 16 bits each; on top of them half of row()
        /// In store_.ordinary().
        [[nodiscard]] std::uint32_t row() const { return static_cast<std::uint32_t>(lo >> 48 | (hi >> 48) << 16); }
    };
    /// A node that is yet to be split or to become a leaf, and its records.
    struct Task {
        Path path;
        std::uint32_t node = 0;
        std::uint32_t begin = 0, end = 0;
        std::uint32_t spare = 0;  // how many entries more there may be below
    };
    using Counts = std::array<std::uint32_t, child_count>;

    Axes axes_;
    Limits limits_;
    std::optional<Aabb> declared_;
    std::vector<Record> records_;       // those of a task's children stand above its own
    std::vector<Task> tasks_;           // last in, first out
    std::vector<std::uint8_t> masks_;   // by record of a task: the children that it goes to
    std::vector<std::uint32_t> place_;  // by row: its place in the tree

    void rebuild();
    [[nodiscard]] Counts count_children(const Task& task);
    [[nodiscard]] bool pays(const Task& task, const Counts& counts, std::uint64_t entries) const;
    bool try_split(const Task& task);
    void make_leaf(const Task& task);
    /// Bit a: the box begins in the cell (or before it, outside the root) along the a-th axis.
    [[nodiscard]] static std::uint32_t mark_of(const Steps& lo, const Path& cell) {
        std::uint32_t mark = 0;
        for (std::size_t a = 0; a < Dim; ++a) mark |= lo[a] >= cell.begin(a) ? 1u << a : 0;
        return mark;
    }
    [[nodiscard]] std::string broken_cells() const;
};

extern template class BucketTree<2>;
extern template class BucketTree<3>;

}  // namespace fase::broad
