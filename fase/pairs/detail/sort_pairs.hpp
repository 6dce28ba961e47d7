#pragma once
/// A radix sort of pairs by (a, b).
#include <vector>

#include "fase/broad/structure.hpp"

namespace fase::pairs {

/// Sorts pairs by radix, and keeps its scratch memory for the next call. O(n), one pass for each 11-bit digit in which
/// the pairs differ (at most 6); uses std::sort for fewer than 256 pairs. Not thread-safe.
class PairSorter {
public:
    /// Sorts `pairs` in place. Duplicates stay in the list.
    void sort(std::vector<broad::Pair>& pairs);
    [[nodiscard]] std::size_t bytes() const { return spare_.capacity() * sizeof(broad::Pair); }

private:
    std::vector<broad::Pair> spare_;
};

}  // namespace fase::pairs
