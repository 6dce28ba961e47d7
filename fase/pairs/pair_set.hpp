#pragma once
/// Remembers which pairs there were, and tells which have begun, which stay and which have ended.
#include <span>
#include <vector>

#include "fase/broad/structure.hpp"

namespace fase::pairs {

/// The difference of two sets of pairs; each list sorted, each pair in one list, once. Valid until the next update().
struct PairChanges {
    std::span<const broad::Pair> begun, staying, ended;
};

/// The pairs of the last step. What it tells depends on the sets of pairs alone: not on the structure that found them,
/// nor on threads. Not thread-safe.
class PairSet {
public:
    /// Takes `current`, sorted and without repetition, as the new set. O(old + new), one merge; no allocation once
    /// warm.
    PairChanges update(std::span<const broad::Pair> current);
    /// Forgets all pairs: the next update() calls all of them begun.
    void clear() { pairs_.clear(); }
    /// The set as of the last update(), sorted.
    [[nodiscard]] std::span<const broad::Pair> pairs() const { return pairs_; }
    [[nodiscard]] std::size_t bytes() const;

private:
    std::vector<broad::Pair> pairs_, begun_, staying_, ended_;
};

}  // namespace fase::pairs
