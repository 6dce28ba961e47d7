#pragma once
/// A set of pairs with single insertions and removals, stored as a list.
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fase/broad/structure.hpp"
#include "fase/core/hash.hpp"
#include "fase/core/no_index.hpp"

namespace fase::broad {

/// A dense list of pairs, with a hash table, at most half full, of their indices. The table is built on first use. add,
/// remove: O(1). The order of the list depends only on the previous calls.
class PairTable {
public:
    /// Clears the set, then calls `fill` to append pairs to the list, each at most once.
    template <class Fill> void refill(Fill&& fill) {
        pairs_.clear();
        indexed_ = false;
        fill(pairs_);
    }
    /// The pair must not be in the set.
    void add(Pair pair) {
        build_index(pairs_.size() + 1);
        slots_[slot_of(pair)] = static_cast<std::uint32_t>(pairs_.size());
        pairs_.push_back(pair);
    }
    /// The pair must be in the set. The last pair of the list moves to its index.
    void remove(Pair pair) {
        build_index(pairs_.size());
        const std::size_t slot = slot_of(pair);
        const std::uint32_t at = slots_[slot];
        const Pair last = pairs_.back();
        slots_[slot_of(last)] = at;
        pairs_[at] = last;
        pairs_.pop_back();
        close_gap(slot);
    }
    /// Removes all pairs with `condition(pair)`. O(n).
    template <class Condition> void remove_if(Condition&& condition) {
        const std::size_t before = pairs_.size();
        std::erase_if(pairs_, condition);
        indexed_ = indexed_ && pairs_.size() == before;
    }
    [[nodiscard]] std::span<const Pair> pairs() const { return pairs_; }
    [[nodiscard]] std::size_t bytes() const {
        return pairs_.capacity() * sizeof(Pair) + slots_.capacity() * sizeof(std::uint32_t);
    }
    /// "" when none is broken.
    [[nodiscard]] std::string broken_invariant() const {
        if (!indexed_) return {};
        std::size_t used = 0;
        for (const std::uint32_t slot : slots_) used += slot == no_index ? 0 : 1;
        if (used != pairs_.size()) return "the table and the list of pairs differ in length";
        for (std::size_t i = 0; i < pairs_.size(); ++i)
            if (slots_[slot_of(pairs_[i])] != i) return "a pair is not in the table";
        return {};
    }

private:
    std::vector<Pair> pairs_;
    std::vector<std::uint32_t> slots_;  // indices in pairs_; the size is a power of two
    bool indexed_ = false;              // whether the slots match the pairs

    [[nodiscard]] std::size_t home_of(Pair pair) const {
        return mix_bits(std::uint64_t{pair.a} << 32 | pair.b) & (slots_.size() - 1);
    }
    /// Returns the slot of the pair, or the free slot for it.
    [[nodiscard]] std::size_t slot_of(Pair pair) const {
        std::size_t slot = home_of(pair);
        while (slots_[slot] != no_index && !(pairs_[slots_[slot]] == pair)) slot = (slot + 1) & (slots_.size() - 1);
        return slot;
    }
    void build_index(std::size_t count) {
        std::size_t size = slots_.size() < 64 ? 64 : slots_.size();
        while (size < 2 * count) size *= 2;
        if (indexed_ && size == slots_.size()) return;
        slots_.assign(size, no_index);
        for (std::size_t i = 0; i < pairs_.size(); ++i) slots_[slot_of(pairs_[i])] = static_cast<std::uint32_t>(i);
        indexed_ = true;
    }
    /// Frees a slot, and moves later entries back that it displaced from their home slots. Source: Knuth 1973, The Art
    /// of Computer Programming 3, 6.4, algorithm R.
    void close_gap(std::size_t gap) {
        const std::size_t mask = slots_.size() - 1;
        slots_[gap] = no_index;
        for (std::size_t at = (gap + 1) & mask; slots_[at] != no_index; at = (at + 1) & mask) {
            const std::size_t home = home_of(pairs_[slots_[at]]);
            if (((at - home) & mask) < ((at - gap) & mask)) continue;  // its home is after the gap
            slots_[gap] = std::exchange(slots_[at], no_index);
            gap = at;
        }
    }
};

}  // namespace fase::broad
