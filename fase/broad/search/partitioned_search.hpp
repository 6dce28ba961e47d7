#pragma once
/// A partitioned search for pairs: several threads search the parts, and the pairs are appended in the order of the
/// parts.
#include <atomic>
#include <vector>

#include "fase/broad/structure.hpp"
#include "fase/core/tasks.hpp"

namespace fase::broad {

/// The pair lists of a partitioned search: one list a part, written by one thread. A structure owns them and reuses
/// them in each search, because allocation in each frame costs more than the search. Between searches they hold no
/// information: a copy of the structure, and one that it is moved to, starts with empty lists. Not counted in bytes().
class ThreadLocalPairBuffers {
public:
    ThreadLocalPairBuffers() = default;
    ThreadLocalPairBuffers(const ThreadLocalPairBuffers&) noexcept {}
    ThreadLocalPairBuffers& operator=(const ThreadLocalPairBuffers&) noexcept { return *this; }

    /// Exclusive access to the lists during one search. A search that starts while another one has the lists (on
    /// another thread, or on a thread that waits for tasks) allocates its own.
    class Lease {
    public:
        /// Provides at least `count` empty lists.
        Lease(ThreadLocalPairBuffers& buffers, std::size_t count)
            : buffers_(buffers), is_owner_(!buffers.in_use_.exchange(true)) {
            try {
                if (lists().size() < count) lists().resize(count);
            } catch (...) {
                if (is_owner_) buffers_.in_use_ = false;
                throw;
            }
            for (std::vector<Pair>& list : lists()) list.clear();
        }
        Lease(const Lease&) = delete;
        Lease& operator=(const Lease&) = delete;
        ~Lease() {
            if (is_owner_) buffers_.in_use_ = false;
        }
        [[nodiscard]] std::vector<std::vector<Pair>>& lists() { return is_owner_ ? buffers_.lists_ : own_lists_; }

    private:
        ThreadLocalPairBuffers& buffers_;
        bool is_owner_;
        std::vector<std::vector<Pair>> own_lists_;
    };

private:
    std::vector<std::vector<Pair>> lists_;
    std::atomic<bool> in_use_ = false;
};

/// Appends lists in order, although tasks complete them in any order; some are appended while others are still written.
class OrderedAppender {
public:
    /// @param count number of lists to append; `lists` may be longer
    OrderedAppender(const std::vector<std::vector<Pair>>& lists, std::size_t count, std::vector<Pair>& out)
        : lists_(lists), complete_(count), out_(out) {}

    /// Marks the list as complete. Appends it and the complete lists after it, unless an earlier list is incomplete or
    /// another thread appends.
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

/// Calls `find(part, pairs)` for each part in 0..parts-1, on the threads of `tasks` if there are several, and appends
/// the pairs in the order of the parts. The result does not depend on the number of threads. Allocates no list when
/// `buffers` has served a search of this size before. Safe from several threads with the same `buffers`.
template <class Find>
void find_in_parts(TaskRunner* tasks, std::size_t parts, ThreadLocalPairBuffers& buffers, std::vector<Pair>& out,
                   const Find& find) {
    if (tasks == nullptr || tasks->threads() == 1 || parts < 2) {
        for (std::size_t i = 0; i < parts; ++i) find(i, out);
        return;
    }
    ThreadLocalPairBuffers::Lease lease(buffers, parts);
    std::vector<std::vector<Pair>>& found = lease.lists();
    OrderedAppender appender(found, parts, out);
    parallel_ranges(*tasks, parts, 1, [&](std::size_t i, std::size_t) {
        find(i, found[i]);
        appender.append(i);
    });
}
template <class Find>
void find_in_parts(TaskRunner& tasks, std::size_t parts, ThreadLocalPairBuffers& buffers, std::vector<Pair>& out,
                   const Find& find) {
    find_in_parts(&tasks, parts, buffers, out, find);
}

}  // namespace fase::broad
