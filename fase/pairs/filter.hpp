#pragma once
/// Collision filters: category and mask bits, groups, and excluded pairs of bodies.
#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/broad/structure.hpp"

namespace fase::pairs {

/// The categories of a body, and the categories that it collides with. Default: collides with all.
struct CollisionFilter {
    std::uint64_t category = 1;  ///< its categories, one bit each; 0: only a group can make it collide
    std::uint64_t mask = ~0ull;  ///< the categories that it collides with
    std::int32_t group = 0;      ///< same group, not 0: > 0 always collide, < 0 never collide; bits are ignored
    friend constexpr bool operator==(const CollisionFilter&, const CollisionFilter&) = default;
};

/// Whether two bodies may collide. A shared group (not 0) decides; else each mask must contain a category of the other
/// body. Symmetric.
constexpr bool may_collide(const CollisionFilter& a, const CollisionFilter& b) {
    if (a.group == b.group && a.group != 0) return a.group > 0;
    return (a.category & b.mask) != 0 && (b.category & a.mask) != 0;
}

/// A set of unordered pairs that never collide (such as a door and its frame). Sorted, so that iteration is
/// deterministic. contains() is one comparison if the set is empty, else O(log n); add() and remove() are O(n).
class PairExclusions {
public:
    using Pair = broad::Pair;

    /// Adds a pair. Returns false, and changes nothing, if it is in the set already or p == q.
    bool add(std::uint32_t p, std::uint32_t q) {
        const Pair pair = broad::ordered_pair(p, q);
        const auto it = std::lower_bound(pairs_.begin(), pairs_.end(), pair);
        if (p == q || (it != pairs_.end() && *it == pair)) return false;
        pairs_.insert(it, pair);
        return true;
    }
    /// Removes a pair. Returns false if it is not in the set.
    bool remove(std::uint32_t p, std::uint32_t q) {
        const Pair pair = broad::ordered_pair(p, q);
        const auto it = std::lower_bound(pairs_.begin(), pairs_.end(), pair);
        if (it == pairs_.end() || *it != pair) return false;
        pairs_.erase(it);
        return true;
    }
    /// Removes all pairs of one body (for a body that is destroyed) and returns their number. O(n).
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
