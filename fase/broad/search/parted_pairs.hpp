#pragma once
/// A search for pairs that is cut into parts for several threads.
#include <atomic>
#include <vector>

#include "fase/broad/structure.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// What parts have found, kept from search to search: memory that is given back and asked for in each frame costs more
/// than the search. A thread that waits for tasks may begin another search meanwhile; that one has lists of its own.
class ThreadLocalPairBuffers {
public:
    explicit ThreadLocalPairBuffers(std::size_t count) : is_first_(!kept().in_use) {
        kept().in_use = true;
        if (lists().size() < count) lists().resize(count);
        for (std::vector<Pair>& list : lists()) list.clear();
    }
    ThreadLocalPairBuffers(const ThreadLocalPairBuffers&) = delete;
    ThreadLocalPairBuffers& operator=(const ThreadLocalPairBuffers&) = delete;
    ~ThreadLocalPairBuffers() {
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

/// Lists that tasks complete in any order, appended in one order while others are being filled.
class InOrder {
public:
    /// @param count of the lists; there may be more
    InOrder(const std::vector<std::vector<Pair>>& lists, std::size_t count, std::vector<Pair>& out)
        : lists_(lists), complete_(count), out_(out) {}

    /// The list is complete. Appends it, and those behind it that have waited for it, unless another thread is at it.
    void append(std::size_t list) {
        complete_[list] = true;
        while (is_complete(next_) && !busy_.exchange(true)) {
            for (; is_complete(next_); ++next_) out_.insert(out_.end(), lists_[next_].begin(), lists_[next_].end());
            busy_ = false;
        }
    }

private:
    const std::vector<std::vector<Pair>>& lists_;
    std::vector<std::atomic<bool>> complete_;
    std::vector<Pair>& out_;
    std::atomic<std::size_t> next_ = 0;
    std::atomic<bool> busy_ = false;

    [[nodiscard]] bool is_complete(std::size_t list) const { return list < complete_.size() && complete_[list]; }
};

/// Calls `find(part, pairs)` for each part in 0..parts-1, on the threads of `tasks` if there are any, and appends what
/// they found in the order of the parts: it does not depend on the number of threads.
template <class Find>
void find_in_parts(TaskRunner* tasks, std::size_t parts, std::vector<Pair>& out, const Find& find) {
    if (tasks == nullptr || tasks->threads() == 1 || parts < 2) {
        for (std::size_t i = 0; i < parts; ++i) find(i, out);
        return;
    }
    ThreadLocalPairBuffers kept(parts);
    std::vector<std::vector<Pair>>& found = kept.lists();
    InOrder in_order(found, parts, out);
    parallel_ranges(*tasks, parts, 1, [&](std::size_t i, std::size_t) {
        find(i, found[i]);
        in_order.append(i);
    });
}
template <class Find>
void find_in_parts(TaskRunner& tasks, std::size_t parts, std::vector<Pair>& out, const Find& find) {
    find_in_parts(&tasks, parts, out, find);
}

}  // namespace fase::broad
