#pragma once
/// Islands: sets of bodies that are connected by contacts.
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fase::dynamics {

/// Disjoint sets over 0..n-1. The representative of a set is its smallest member, for any order of the unions.
/// Source: Galler, Fischer 1964, An improved equivalence algorithm; with path halving (van Leeuwen, Tarjan 1984).
class DisjointSets {
public:
    /// Creates n sets of one member each. Reuses its memory.
    void reset(std::size_t n) {
        parent_.resize(n);
        for (std::size_t i = 0; i < n; ++i) parent_[i] = static_cast<std::uint32_t>(i);
    }
    [[nodiscard]] std::uint32_t find(std::uint32_t i) {
        while (parent_[i] != i) {
            parent_[i] = parent_[parent_[i]];
            i = parent_[i];
        }
        return i;
    }
    void unite(std::uint32_t a, std::uint32_t b) {
        a = find(a);
        b = find(b);
        if (a < b) {
            parent_[b] = a;
        } else {
            parent_[a] = b;
        }
    }

private:
    std::vector<std::uint32_t> parent_;
};

}  // namespace fase::dynamics
