/// Searches one sorted set in chunks.
#include "fase/pairs/frame_pairs.hpp"

#include "fase/broad/row_grid/chunks.hpp"
#include "fase/broad/row_grid/walk.hpp"

namespace fase::pairs {

using namespace broad;

void FramePairs::find(TaskRunner& tasks, std::vector<Pair>& out) const {
    using namespace row_grid;
    const RowView set = sorted_.view();
    const RowCuts cuts(set.levels);
    find_in_chunks(&tasks, cuts.chunks(), buffers_, out, [&](std::size_t chunk, PairBlock& block) {
        const RecordSpan records = cuts[chunk];
        find_own_pairs(set, records.begin, records.end, block);
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

}  // namespace fase::pairs
