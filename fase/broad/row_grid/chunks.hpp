#pragma once
/// Divides searches for pairs into chunks, which tasks process one at a time.
#include <algorithm>
#include <span>
#include <vector>

#include "fase/broad/row_grid/kernels.hpp"
#include "fase/broad/search/partitioned_search.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad::row_grid {

/// Divides the records of a set into chunks: large ones in the finest level, smaller ones in coarser levels, whose
/// boxes have more pairs. The division depends only on the counts, so that the order of the pairs does not depend on
/// the number of threads.
class RowCuts {
public:
    explicit RowCuts(std::span<const RowLevel> levels) : levels_(levels) {}

    [[nodiscard]] std::size_t chunks() const {
        std::size_t sum = 0;
        for (std::size_t k = 0; k < levels_.size(); ++k) sum += chunks_of(k);
        return sum;
    }
    /// Returns the records of a chunk.
    [[nodiscard]] RecordSpan operator[](std::size_t chunk) const {
        std::size_t k = 0;
        for (; chunk >= chunks_of(k); ++k) chunk -= chunks_of(k);
        const RowLevel& level = levels_[k];
        const std::size_t begin = chunk * length(k), end = std::min<std::size_t>(level.count, begin + length(k));
        return {static_cast<std::uint32_t>(level.first + begin), static_cast<std::uint32_t>(level.first + end)};
    }

private:
    std::span<const RowLevel> levels_;

    static std::size_t length(std::size_t level) { return level == 0 ? 4096 : level == 1 ? 256 : 16; }
    [[nodiscard]] std::size_t chunks_of(std::size_t level) const {
        return (levels_[level].count + length(level) - 1) / length(level);
    }
};

/// find_in_parts() for searches that write to a PairBlock.
template <class Find>
void find_in_chunks(TaskRunner* tasks, std::size_t count, ThreadLocalPairBuffers& buffers, std::vector<Pair>& out,
                    const Find& find) {
    find_in_parts(tasks, count, buffers, out, [&](std::size_t chunk, std::vector<Pair>& pairs) {
        PairBlock block(pairs);
        find(chunk, block);
    });
}

}  // namespace fase::broad::row_grid
