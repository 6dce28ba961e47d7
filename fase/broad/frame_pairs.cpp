/// One sorted set, searched in chunks.
#include "fase/broad/frame_pairs.hpp"

#include "fase/broad/row_grid_chunks.hpp"

namespace fase::broad {

void FramePairs::find(TaskRunner& tasks, std::vector<Pair>& out) const {
    using namespace row_grid;
    const RowView set = sorted_.view();
    find_in_chunks(&tasks, chunks_of(set.count), out, [&](std::size_t chunk, PairBlock& block) {
        find_own_pairs(set, chunk * chunk_records, std::min(set.count, (chunk + 1) * chunk_records), block);
    });
}

}  // namespace fase::broad
