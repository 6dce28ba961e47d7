#pragma once
/// All pairs of a list of boxes that is another one in each frame.
#include <span>
#include <vector>

#include "fase/broad/row_grid/set.hpp"
#include "fase/broad/stats.hpp"
#include "fase/core/tasks.hpp"

namespace fase::pairs {

/// For boxes that all move: no box is stored, none is inserted or moved, the list of the frame is sorted into rows (see
/// RowGrid) as it stands. Memory, and the choice of the cells, are kept from frame to frame.
class FramePairs {
public:
    explicit FramePairs(const broad::RowGridSettings& settings = {}) : settings_(settings) {}

    /// Sorts the boxes, which are known by their place in the list; it is not needed any more afterwards. False, and
    /// there is nothing to find, when one of them is no ordinary box (see is_regular()). O(n).
    [[nodiscard]] bool sort(TaskRunner& tasks, std::span<const Aabb> boxes) {
        return sorted_.build(boxes, settings_, &tasks);
    }
    /// Appends each pair once, smaller place first, in the same order for any number of threads. O(n + pairs) for boxes
    /// that are spread. Safe from many threads.
    void find(TaskRunner& tasks, std::vector<broad::Pair>& out) const;

    [[nodiscard]] std::size_t size() const { return sorted_.size(); }
    [[nodiscard]] std::size_t bytes() const { return sizeof *this + sorted_.bytes(); }
    [[nodiscard]] broad::StructureStats stats() const;

private:
    broad::RowGridSettings settings_;
    broad::RowSet sorted_;
};

}  // namespace fase::pairs
