#pragma once
/// Sorts pairs by (smaller proxy, larger proxy), fast.
#include <vector>

#include "fase/broad/structure.hpp"

namespace fase::pairs {

/// Sorts by radix, and keeps the memory that this takes for the next call. O(n) for n above some hundred, with as many
/// passes as the largest proxies have bytes; std::sort below. Not thread-safe.
class PairSorter {
public:
    /// Sorts `pairs` in place. Equal pairs stay in the list.
    void sort(std::vector<broad::Pair>& pairs);
    [[nodiscard]] std::size_t bytes() const { return spare_.capacity() * sizeof(broad::Pair); }

private:
    std::vector<broad::Pair> spare_;
};

}  // namespace fase::pairs
