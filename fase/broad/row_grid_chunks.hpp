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

/// What chunks have found, kept from search to search: memory that is given back and asked for in each frame costs more
/// than the search. A thread that waits for tasks may begin another search meanwhile; that one has lists of its own.
class ChunkLists {
public:
    explicit ChunkLists(std::size_t count) : is_first_(!kept().in_use) {
        kept().in_use = true;
        if (lists().size() < count) lists().resize(count);
        for (std::vector<Pair>& list : lists()) list.clear();
    }
    ChunkLists(const ChunkLists&) = delete;
    ChunkLists& operator=(const ChunkLists&) = delete;
    ~ChunkLists() {
        if (is_first_) kept().in_use = false;
    }
    [[nodiscard]] std::vector<std::vector<Pair>>& lists() { return is_first_ ? kept().lists : own_; }

private:
    struct Kept {
        std::vector<std::vector<Pair>> lists;
        bool in_use = false;
    };
    bool is_first_;
    std::vector<std::vector<Pair>> own_;

    static Kept& kept() {
        thread_local Kept mine;
        return mine;
    }
};

/// Appends what find(chunk, block) puts into its block, in the order of the chunks.
template <class Find>
void find_in_chunks(TaskRunner* tasks, std::size_t count, std::vector<Pair>& out, const Find& find) {
    if (tasks == nullptr || tasks->threads() == 1 || count < 2) {
        PairBlock block(out);
        for (std::size_t k = 0; k < count; ++k) find(k, block);
        return;
    }
    ChunkLists kept(count);
    std::vector<std::vector<Pair>>& found = kept.lists();
    parallel_ranges(*tasks, count, 1, [&](std::size_t k, std::size_t) {
        PairBlock block(found[k]);
        find(k, block);
    });
    std::vector<std::size_t> places;
    std::size_t total = out.size();
    for (std::size_t k = 0; k < count; ++k) {
        places.push_back(total);
        total += found[k].size();
    }
    out.resize(total);
    parallel_ranges(*tasks, count, 1, [&](std::size_t k, std::size_t) {
        std::copy(found[k].begin(), found[k].end(), out.begin() + static_cast<std::ptrdiff_t>(places[k]));
    });
}

}  // namespace fase::broad::row_grid
