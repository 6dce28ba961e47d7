#pragma once
/// A sorted list of pairs that stay from step to step, each with a value of its owner: an index of a contact.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "fase/broad/structure.hpp"

namespace fase::pairs {

/// Pairs in ascending order, each once, with the index of what the owner keeps for it (a contact). Pairs that stay are
/// not copied one by one: an update reads what its predicate reads, and moves whole runs when anything was added or
/// ended. Memory is reused. Not thread-safe.
class PairList {
public:
    // Public for snapshots, which read and write both whole.
    std::vector<broad::Pair> pairs;     ///< ascending, none twice
    std::vector<std::uint32_t> values;  ///< one for each pair

    [[nodiscard]] std::size_t size() const { return pairs.size(); }
    [[nodiscard]] std::size_t bytes() const {
        return (pairs.capacity() + spare_pairs_.capacity()) * sizeof(broad::Pair) +
               (values.capacity() + spare_values_.capacity() + ended_.capacity()) * sizeof(std::uint32_t);
    }
    void clear() {
        pairs.clear();
        values.clear();
    }
    /// Allocates for `count` pairs, twice as much when it must grow: as long as the list stays this small, update() and
    /// append() cannot fail.
    void reserve(std::size_t count) {
        const auto grow = [count](auto& v) {
            if (v.capacity() < count) v.reserve(std::max(count, 2 * v.capacity()));
        };
        grow(pairs);
        grow(values);
        grow(spare_pairs_);
        grow(spare_values_);
        grow(ended_);
    }
    /// Appends a pair; one greater than all in the list where update() is used.
    void append(broad::Pair pair, std::uint32_t value) {
        pairs.push_back(pair);
        values.push_back(value);
    }

    /// Ends pairs and adds new ones. `has_ended(index)` is called for each pair in order, `end(value)` for each that
    /// has ended, and `add(pair)`, which returns the value, for each pair of `found` that is not in the list, or has
    /// just ended. `found` is ascending and has no pair twice. Calls of end and add follow the order of the pairs.
    /// O(size + found).
    template <class HasEnded, class End, class Add>
    void update(std::span<const broad::Pair> found, const HasEnded& has_ended, const End& end, const Add& add);

private:
    std::vector<broad::Pair> spare_pairs_;
    std::vector<std::uint32_t> spare_values_;
    std::vector<std::uint32_t> ended_;  // indices of ended pairs in an update

    void swap_with_spare() {
        std::swap(pairs, spare_pairs_);
        std::swap(values, spare_values_);
    }
};

template <class HasEnded, class End, class Add>
void PairList::update(std::span<const broad::Pair> found, const HasEnded& has_ended, const End& end, const Add& add) {
    ended_.clear();
    for (std::size_t i = 0; i < size(); ++i)
        if (has_ended(i)) ended_.push_back(static_cast<std::uint32_t>(i));
    if (ended_.empty() && found.empty()) return;

    spare_pairs_.clear();
    spare_values_.clear();
    spare_pairs_.reserve(size() + found.size());
    spare_values_.reserve(size() + found.size());
    std::size_t copied = 0;  // of this list
    const auto copy_until = [&](std::size_t place) {
        const auto run = [&](const auto& from, auto& into) {
            into.insert(into.end(), from.begin() + static_cast<std::ptrdiff_t>(copied),
                        from.begin() + static_cast<std::ptrdiff_t>(place));
        };
        run(pairs, spare_pairs_);
        run(values, spare_values_);
        copied = place;
    };
    std::size_t i = 0, j = 0;
    while (i < ended_.size() || j < found.size()) {
        if (j == found.size() || (i < ended_.size() && pairs[ended_[i]] <= found[j])) {
            copy_until(ended_[i]);
            end(values[ended_[i++]]);
            ++copied;  // a found pair of the same key counts as new
        } else {
            const auto from = pairs.begin() + static_cast<std::ptrdiff_t>(copied);
            copy_until(static_cast<std::size_t>(std::lower_bound(from, pairs.end(), found[j]) - pairs.begin()));
            if (copied == size() || pairs[copied] != found[j]) {
                spare_pairs_.push_back(found[j]);
                spare_values_.push_back(add(found[j]));
            }
            ++j;
        }
    }
    copy_until(size());
    swap_with_spare();
}

}  // namespace fase::pairs
