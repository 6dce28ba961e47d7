/// One sorted set, searched in chunks.
#include "fase/broad/frame_pairs.hpp"

#include "fase/broad/row_grid_chunks.hpp"
#include "fase/broad/row_grid_walk.hpp"

namespace fase::broad {

void FramePairs::find(TaskRunner& tasks, std::vector<Pair>& out) const {
    using namespace row_grid;
    const RowView set = sorted_.view();
    find_in_chunks(&tasks, chunks_of(set.count), out, [&](std::size_t chunk, PairBlock& block) {
        find_own_pairs(set, chunk * chunk_records, std::min(set.count, (chunk + 1) * chunk_records), block);
    });
}

StructureStats FramePairs::stats() const {
    StructureStats stats{.boxes = size(), .nodes = 1 + sorted_.cells(), .bytes = bytes()};
    const RowView set = sorted_.view();
    row_grid::for_each_cell(set, [&](const RowLevel& level, const Aabb&, std::uint32_t begin, std::uint32_t end) {
        ++stats.leaves;
        stats.entries += end - begin;
        stats.largest_leaf = std::max<std::size_t>(stats.largest_leaf, end - begin);
        stats.depth = std::max(stats.depth, static_cast<int>(&set.levels.back() - &level));
    });
    return stats;
}

}  // namespace fase::broad
