#pragma once
/// Boxes dealt out to parts of a table of cells, each of which is sorted on its own.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/broad/row_grid_kernels.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// Counters of a table that follow each other, and the boxes of their cells.
struct RowSlab {
    std::uint32_t counters = 0, counters_end = 0;
    std::uint32_t first = 0;  ///< record of the set
    /// Places of its boxes in a list.
    std::span<const RecordSpan> runs;
};

/// A copy of a list in which the boxes of a slab stand in a few runs, in the order of the list. To sort the slabs one
/// by one touches little memory at a time, where to sort the list would reach for boxes anywhere; and several threads
/// can do it. Kept from frame to frame for its memory: 28 bytes a box.
class RowDeal {
public:
    /// Whether it pays for so many boxes.
    [[nodiscard]] static bool pays(std::size_t boxes, const TaskRunner* tasks) {
        return boxes >= (tasks == nullptr || tasks->threads() == 1 ? row_grid::past_caches : least_shared);
    }
    /// Deals out by the cells of a fit. When a box is not ordinary, what is dealt has no meaning.
    row_grid::Counted deal(std::span<const Move> boxes, const RowFit& fit, TaskRunner* tasks) {
        return deal_from(boxes, fit, tasks);
    }
    /// The same for a list: the proxies are the places in it.
    row_grid::Counted deal(std::span<const Aabb> boxes, const RowFit& fit, TaskRunner* tasks) {
        return deal_from(boxes, fit, tasks);
    }
    /// The slabs, in the order of the table; together they have all counters. They point into this deal: a copy of it
    /// has to deal anew.
    [[nodiscard]] std::span<const RowSlab> slabs() const { return slabs_; }
    /// What runs are places in; with room behind them.
    [[nodiscard]] std::span<const Move> boxes() const { return pool_; }
    [[nodiscard]] std::size_t bytes() const;

private:
    static constexpr std::size_t least_shared = 32768;  // boxes that are worth several threads
    static constexpr std::size_t part_least = 16384;    // boxes that a thread deals
    static constexpr std::size_t slab_boxes = 8192;     // in the mean; with their columns they fit a core's own cache

    std::vector<Move> pool_;
    std::vector<row_grid::Hand> hands_;
    std::vector<RowSlab> slabs_;
    std::vector<RecordSpan> runs_;

    template <class Row> row_grid::Counted deal_from(std::span<const Row> boxes, const RowFit& fit, TaskRunner* tasks);
    void gather_runs(std::size_t slabs, unsigned shift, std::uint32_t counters);
};

}  // namespace fase::broad
