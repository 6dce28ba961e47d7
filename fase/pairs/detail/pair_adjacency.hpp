#pragma once
/// Stored pairs, with fast removal of all pairs of a proxy.
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fase/broad/structure.hpp"

namespace fase::pairs {

/// A list of pairs. Each pair is in the linked lists of both its proxies, so that the pairs of one proxy are removed
/// without a scan of the others. 24 bytes a pair and 4 bytes a proxy. The order of the list depends only on the calls
/// so far.
class PairAdjacency {
public:
    void clear();
    /// Adds pairs that are not in the list yet, smaller proxy first.
    void add(std::span<const broad::Pair> pairs);
    /// Removes the pairs of a proxy: O(removed pairs).
    void remove_all_of(broad::Proxy p);
    /// Removes the pairs with a proxy for which `matches(proxy)` is true, in one pass over all pairs.
    template <class F> void remove_all_if(F&& matches);

    [[nodiscard]] std::span<const broad::Pair> pairs() const { return pairs_; }
    [[nodiscard]] std::size_t size() const { return pairs_.size(); }
    [[nodiscard]] std::size_t bytes() const {
        return pairs_.capacity() * sizeof(broad::Pair) + links_.capacity() * sizeof(Links) +
               heads_.capacity() * sizeof(Link);
    }
    /// Describes the first broken invariant; empty if none is broken. For tests.
    [[nodiscard]] std::string broken_invariant() const;

private:
    using Link = std::uint32_t;  // 2 * index of the pair, + 1 in the linked list of its second proxy
    static constexpr Link none = 0xffffffff;
    struct Links {
        std::array<Link, 2> next{none, none}, previous{none, none};
    };
    std::vector<broad::Pair> pairs_;
    std::vector<Links> links_;  // by index of the pair
    std::vector<Link> heads_;   // by proxy

    [[nodiscard]] broad::Proxy proxy_of(Link link) const {
        return (link & 1) == 0 ? pairs_[link / 2].a : pairs_[link / 2].b;
    }
    void push_front(Link link);
    void unlink(Link link);
    void remove_at(std::uint32_t index);
};

template <class F> void PairAdjacency::remove_all_if(F&& matches) {
    std::vector<broad::Pair> kept;
    for (const broad::Pair pair : pairs_)
        if (!matches(pair.a) && !matches(pair.b)) kept.push_back(pair);
    if (kept.size() == pairs_.size()) return;
    clear();
    add(kept);
}

}  // namespace fase::pairs
