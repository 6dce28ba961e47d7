#pragma once
/// Searches for pairs that are cut into chunks, which tasks take one at a time.
#include <algorithm>
#include <span>
#include <vector>

#include "fase/broad/row_grid_kernels.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad::row_grid {

/// Records that are searched in one go. Cuts go by count, so that the order of the pairs does not depend on the
/// threads.
inline constexpr std::size_t chunk_records = 4096;

[[nodiscard]] inline std::size_t chunks_of(std::size_t records) {
    return (records + chunk_records - 1) / chunk_records;
}

/// Appends what find(chunk, block) puts into its block, in the order of the chunks.
template <class Find>
void find_in_chunks(TaskRunner* tasks, std::size_t count, std::vector<Pair>& out, const Find& find) {
    if (tasks == nullptr || tasks->threads() == 1 || count < 2) {
        PairBlock block(out);
        for (std::size_t k = 0; k < count; ++k) find(k, block);
        return;
    }
    std::vector<std::vector<Pair>> found(count);
    parallel_ranges(*tasks, count, 1, [&](std::size_t k, std::size_t) {
        PairBlock block(found[k]);
        find(k, block);
    });
    std::vector<std::size_t> places;
    std::size_t total = out.size();
    for (const std::vector<Pair>& part : found) {
        places.push_back(total);
        total += part.size();
    }
    out.resize(total);
    parallel_ranges(*tasks, count, 1, [&](std::size_t k, std::size_t) {
        std::copy(found[k].begin(), found[k].end(), out.begin() + static_cast<std::ptrdiff_t>(places[k]));
    });
}

}  // namespace fase::broad::row_grid
