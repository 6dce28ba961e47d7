#pragma once
/// A set of pairs that is changed one by one, and lies ready as a list.
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fase/broad/structure.hpp"
#include "fase/core/hash.hpp"

namespace fase::broad {

/// The pairs stand in a list without holes; a hash table, at most half full, knows where each stands. The table is made
/// when it is first needed. add, remove: O(1). The order of the list depends on the calls so far alone.
class PairTable {
public:
    /// Forgets all, and lets a function append pairs to the list; no pair twice.
    template <class Fill> void refill(Fill&& fill) {
        pairs_.clear();
        indexed_ = false;
        fill(pairs_);
    }
    /// The pair must not be there yet.
    void add(Pair pair) {
        make_index(pairs_.size() + 1);
        slots_[slot_of(pair)] = static_cast<std::uint32_t>(pairs_.size());
        pairs_.push_back(pair);
    }
    /// The pair must be there; the last of the list takes its place.
    void remove(Pair pair) {
        make_index(pairs_.size());
        const std::size_t slot = slot_of(pair);
        const std::uint32_t at = slots_[slot];
        const Pair last = pairs_.back();
        slots_[slot_of(last)] = at;
        pairs_[at] = last;
        pairs_.pop_back();
        close_gap(slot);
    }
    /// Removes all that `unwanted(pair)` names. O(n).
    template <class Unwanted> void remove_if(Unwanted&& unwanted) {
        const std::size_t before = pairs_.size();
        std::erase_if(pairs_, unwanted);
        indexed_ = indexed_ && pairs_.size() == before;
    }
    [[nodiscard]] std::span<const Pair> pairs() const { return pairs_; }
    [[nodiscard]] std::size_t bytes() const {
        return pairs_.capacity() * sizeof(Pair) + slots_.capacity() * sizeof(std::uint32_t);
    }
    /// "" when all is well.
    [[nodiscard]] std::string broken_invariant() const {
        if (!indexed_) return {};
        std::size_t used = 0;
        for (const std::uint32_t slot : slots_) used += slot == none ? 0 : 1;
        if (used != pairs_.size()) return "the table and the list of pairs differ in length";
        for (std::size_t i = 0; i < pairs_.size(); ++i)
            if (slots_[slot_of(pairs_[i])] != i) return "a pair is not found in the table";
        return {};
    }

private:
    static constexpr std::uint32_t none = 0xffffffff;
    std::vector<Pair> pairs_;
    std::vector<std::uint32_t> slots_;  // places in pairs_; a power of two
    bool indexed_ = false;              // do the slots belong to the pairs?

    [[nodiscard]] std::size_t home_of(Pair pair) const {
        return mix_bits(std::uint64_t{pair.a} << 32 | pair.b) & (slots_.size() - 1);
    }
    /// Where the pair is, or the free slot where it would be.
    [[nodiscard]] std::size_t slot_of(Pair pair) const {
        std::size_t slot = home_of(pair);
        while (slots_[slot] != none && !(pairs_[slots_[slot]] == pair)) slot = (slot + 1) & (slots_.size() - 1);
        return slot;
    }
    void make_index(std::size_t wanted) {
        std::size_t size = slots_.size() < 64 ? 64 : slots_.size();
        while (size < 2 * wanted) size *= 2;
        if (indexed_ && size == slots_.size()) return;
        slots_.assign(size, none);
        for (std::size_t i = 0; i < pairs_.size(); ++i) slots_[slot_of(pairs_[i])] = static_cast<std::uint32_t>(i);
        indexed_ = true;
    }
    /// Frees a slot, and moves those behind it that were kept from their home by it. Source: Knuth 1973, The Art of
    /// Computer Programming 3, 6.4, algorithm R.
    void close_gap(std::size_t gap) {
        const std::size_t mask = slots_.size() - 1;
        slots_[gap] = none;
        for (std::size_t at = (gap + 1) & mask; slots_[at] != none; at = (at + 1) & mask) {
            const std::size_t home = home_of(pairs_[slots_[at]]);
            if (((at - home) & mask) < ((at - gap) & mask)) continue;  // its home lies behind the gap
            slots_[gap] = std::exchange(slots_[at], none);
            gap = at;
        }
    }
};

}  // namespace fase::broad
