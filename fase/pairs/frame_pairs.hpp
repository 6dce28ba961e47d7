#pragma once
/// All pairs of a list of boxes that is new in each frame.
#include <span>
#include <vector>

#include "fase/broad/row_grid/set.hpp"
#include "fase/broad/row_grid_settings.hpp"
#include "fase/broad/search/partitioned_search.hpp"
#include "fase/broad/stats.hpp"
#include "fase/core/tasks.hpp"

namespace fase::pairs {

/// Finds pairs where all boxes move. It keeps no structure between frames: no box is inserted or moved; the list of the
/// frame is sorted into rows directly (see RowGrid). Memory and the choice of cell sizes are reused from frame to
/// frame.
class FramePairs {
public:
    explicit FramePairs(const broad::RowGridSettings& settings = {}) : settings_(settings) {}

    /// Sorts the boxes. The proxy of a box is its index; the list need not outlive the call. Returns false, and find()
    /// finds nothing, if any box is not regular (see is_regular()). O(n).
    [[nodiscard]] bool sort(TaskRunner& tasks, std::span<const Aabb> boxes) {
        return sorted_.build(boxes, settings_, &tasks);
    }
    /// Appends each pair once, smaller index first, in the same order for any number of threads. O(n + pairs) if the
    /// boxes are not crowded. Safe to call from several threads.
    void find(TaskRunner& tasks, std::vector<broad::Pair>& out) const;

    [[nodiscard]] std::size_t size() const { return sorted_.size(); }
    [[nodiscard]] std::size_t bytes() const { return sizeof *this + sorted_.bytes(); }
    [[nodiscard]] broad::StructureStats stats() const;

private:
    broad::RowGridSettings settings_;
    broad::RowSet sorted_;
    mutable broad::ThreadLocalPairBuffers buffers_;  // scratch of find()
};

}  // namespace fase::pairs
