#pragma once
/// The answers to many questions of which each has a list for an answer.
#include <span>
#include <vector>

#include "fase/core/tasks.hpp"

namespace fase::query {

/// Lists in one row: list i is the answer to question i. Keeps its memory from use to use.
template <class T> class Lists {
public:
    [[nodiscard]] std::size_t size() const { return begins_.size() - 1; }
    [[nodiscard]] std::span<const T> operator[](std::size_t i) const {
        return std::span(items_).subspan(begins_[i], begins_[i + 1] - begins_[i]);
    }
    /// All lists, one after the other.
    [[nodiscard]] std::span<const T> items() const { return items_; }

    /// Replaces everything: `ask(i, out)` appends the answer to question i to `out`; called once for each i below
    /// `count`, at most `grain` of them in a row, by the threads of `tasks`. What comes out does not depend on them.
    template <class Ask> void fill(TaskRunner& tasks, std::size_t count, std::size_t grain, const Ask& ask) {
        const std::size_t chunks = (count + grain - 1) / grain;
        if (parts_.size() < chunks) parts_.resize(chunks);
        begins_.assign(count + 1, 0);
        parallel_ranges(tasks, count, grain, [&](std::size_t begin, std::size_t end) {
            std::vector<T>& part = parts_[begin / grain];
            part.clear();
            for (std::size_t i = begin; i < end; ++i) {
                ask(i, part);
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
    std::vector<std::size_t> begins_{0};  // of each list in items_, and the end
    std::vector<std::vector<T>> parts_;   // one a range of questions; scratch
};

}  // namespace fase::query
