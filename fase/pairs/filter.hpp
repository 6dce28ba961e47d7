#pragma once
/// Which bodies may collide at all: category and mask bits, groups, and single pairs that are let through each other.
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/broad/structure.hpp"

namespace fase::pairs {

/// What a body is, and with what it collides. Default: collides with all.
struct CollisionFilter {
    std::uint64_t category = 1;  ///< the kinds that it is, a bit each; none: nothing with a mask sees it
    std::uint64_t mask = ~0ull;  ///< the kinds that it collides with
    std::int32_t group = 0;  ///< two of one group other than 0: above 0 they collide, below never, whatever the bits
    friend constexpr bool operator==(const CollisionFilter&, const CollisionFilter&) = default;
};

/// Whether two bodies may collide: the group they share decides, else each must be in the other's mask. Symmetric.
constexpr bool may_collide(const CollisionFilter& a, const CollisionFilter& b) {
    if (a.group == b.group && a.group != 0) return a.group > 0;
    return (a.category & b.mask) != 0 && (b.category & a.mask) != 0;
}

/// A set of unordered pairs that never collide (a body and the door it hangs in). Sorted, so that walking through it is
/// deterministic. contains() is one compare when the set is empty, O(log n) else; add() and remove() are O(n).
class PairExclusions {
public:
    using Pair = broad::Pair;

    /// False when the pair was excluded already, or is a body with itself (nothing changes).
    bool add(std::uint32_t p, std::uint32_t q) {
        const Pair pair = broad::ordered_pair(p, q);
        const auto at = std::lower_bound(pairs_.begin(), pairs_.end(), pair);
        if (p == q || (at != pairs_.end() && *at == pair)) return false;
        pairs_.insert(at, pair);
        return true;
    }
    /// False when the pair was not excluded.
    bool remove(std::uint32_t p, std::uint32_t q) {
        const Pair pair = broad::ordered_pair(p, q);
        const auto at = std::lower_bound(pairs_.begin(), pairs_.end(), pair);
        if (at == pairs_.end() || *at != pair) return false;
        pairs_.erase(at);
        return true;
    }
    /// Drops all pairs of one body, as when it is destroyed; returns how many. O(n).
    std::size_t remove_all_of(std::uint32_t p) {
        return std::erase_if(pairs_, [p](Pair pair) { return pair.a == p || pair.b == p; });
    }
    [[nodiscard]] bool contains(std::uint32_t p, std::uint32_t q) const {
        return !pairs_.empty() && std::binary_search(pairs_.begin(), pairs_.end(), broad::ordered_pair(p, q));
    }
    void clear() { pairs_.clear(); }
    [[nodiscard]] std::size_t size() const { return pairs_.size(); }
    /// All pairs, sorted, smaller index first.
    [[nodiscard]] std::span<const Pair> pairs() const { return pairs_; }

private:
    std::vector<Pair> pairs_;
};

}  // namespace fase::pairs
