#pragma once
/// Trees whose cells are split in half on each axis when they hold too many boxes; a box is in every leaf that it
/// overlaps.
#include "fase/broad/builders/cell_structure.hpp"
#include "fase/broad/search/partitioned_search.hpp"

namespace fase::broad {

/// The common part of quadtree and octree. First the corners of all boxes are quantized to integer steps (CellFrame).
/// These steps alone decide which leaves a box overlaps, and which leaf contains the lower corner of the intersection
/// of two boxes: only that leaf reports the pair.
///
/// A leaf with more boxes than the capacity is split if that reduces the cost: the number of saved pair tests must
/// exceed the capacity times the number of new entries of straddling boxes. So coincident boxes, and boxes larger than
/// the cell, end the splitting. The mean number of entries per box is at most `max_entries` for any set of boxes. Holds
/// up to 2^29 boxes.
template <int Dim> class BucketTree : public CellStructure<Dim, BucketTree<Dim>> {
public:
    /// Largest mean number of entries per box.
    static constexpr std::uint32_t max_entries = 16;

    /// Appends all pairs, leaf by leaf.
    void find_pairs(std::vector<Pair>& out) const;
    /// Finds the same pairs in the same order on several threads.
    void find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const;
    /// Appends the pairs with an awake box. Skips branches in which all boxes sleep.
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
    static constexpr std::uint32_t owned = child_count - 1;  // mark of a box that begins in the leaf on all axes

    /// A box while the tree is built.
    struct Record {
        std::uint64_t lo, hi;  // steps, 16 bits each; the highest 16 bits hold half of row()
        /// Index in store_.regular().
        [[nodiscard]] std::uint32_t row() const { return static_cast<std::uint32_t>(lo >> 48 | (hi >> 48) << 16); }
    };
    /// A pending node of the build, with its range of records.
    struct Task {
        Path path;
        std::uint32_t node = 0;
        std::uint32_t begin = 0, end = 0;
        std::uint32_t spare = 0;  // number of additional entries allowed below
    };
    using Counts = std::array<std::uint32_t, child_count>;

    Axes axes_;
    Limits limits_;
    std::optional<Aabb> declared_;
    std::vector<Record> records_;             // a stack: the records of a task's children follow its own
    std::vector<Task> tasks_;                 // a stack
    std::vector<std::uint8_t> masks_;         // by record of a task: the children that it enters
    std::vector<std::uint32_t> place_;        // by row: its index in the tree
    mutable ThreadLocalPairBuffers buffers_;  // scratch of find_pairs() with tasks

    void rebuild();
    [[nodiscard]] Counts count_children(const Task& task);
    [[nodiscard]] bool is_worthwhile(const Task& task, const Counts& counts, std::uint64_t entries) const;
    bool try_split(const Task& task);
    void make_leaf(const Task& task);
    /// Bit a: the box begins in the cell (or before it, outside the root) on the a-th axis.
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
