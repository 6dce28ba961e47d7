#pragma once
/// A list of results for each query of a batch.
#include <span>
#include <vector>

#include "fase/core/tasks.hpp"

namespace fase::query {

/// Lists in one array: list i is the result of query i. Reuses its memory.
template <class T> class Lists {
public:
    [[nodiscard]] std::size_t size() const { return begins_.size() - 1; }
    [[nodiscard]] std::span<const T> operator[](std::size_t i) const {
        return std::span(items_).subspan(begins_[i], begins_[i + 1] - begins_[i]);
    }
    /// Returns all lists, concatenated.
    [[nodiscard]] std::span<const T> items() const { return items_; }

    /// Replaces all lists: runs `query(i, out)`, which appends the result of query i to `out`, once for each i below
    /// `count`, on the threads of `tasks` in chunks of `grain`. The result does not depend on the threads.
    template <class Query> void fill(TaskRunner& tasks, std::size_t count, std::size_t grain, const Query& query) {
        const std::size_t chunks = (count + grain - 1) / grain;
        if (parts_.size() < chunks) parts_.resize(chunks);
        begins_.assign(count + 1, 0);
        parallel_ranges(tasks, count, grain, [&](std::size_t begin, std::size_t end) {
            std::vector<T>& part = parts_[begin / grain];
            part.clear();
            for (std::size_t i = begin; i < end; ++i) {
                query(i, part);
                begins_[i + 1] = part.size();  // within the part, for now
            }
        });
        items_.clear();
        for (std::size_t chunk = 0; chunk < chunks; ++chunk) {
            const std::size_t before = items_.size();
            items_.insert(items_.end(), parts_[chunk].begin(), parts_[chunk].end());
            const std::size_t end = (chunk + 1) * grain < count ? (chunk + 1) * grain : count;
            for (std::size_t i = chunk * grain; i < end; ++i) begins_[i + 1] += before;
        }
    }

private:
    std::vector<T> items_;
    std::vector<std::size_t> begins_{0};  // begin of each list in items_, then the end
    std::vector<std::vector<T>> parts_;   // one for each chunk of queries; scratch
};

}  // namespace fase::query
