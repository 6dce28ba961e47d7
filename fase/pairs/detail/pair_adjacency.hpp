#pragma once
/// Pairs that are kept until one of their boxes is touched.
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fase/broad/structure.hpp"

namespace fase::pairs {

/// A list of pairs, each of which hangs in a chain of either of its proxies: those of one proxy are dropped without a
/// look at the others. 24 bytes a pair and 4 a proxy. The order of the list depends on the calls so far alone.
class PairAdjacency {
public:
    void clear();
    /// Pairs that are not in the list yet, smaller proxy first.
    void add(std::span<const broad::Pair> pairs);
    /// Drops the pairs of a proxy: O(how many).
    void drop(broad::Proxy p);
    /// Drops the pairs of all for which `goes(proxy)` holds: one look at each pair.
    template <class F> void drop_if(F&& goes);

    [[nodiscard]] std::span<const broad::Pair> pairs() const { return pairs_; }
    [[nodiscard]] std::size_t size() const { return pairs_.size(); }
    [[nodiscard]] std::size_t bytes() const {
        return pairs_.capacity() * sizeof(broad::Pair) + links_.capacity() * sizeof(Links) +
               first_.capacity() * sizeof(Link);
    }
    /// "" when all is well.
    [[nodiscard]] std::string broken_invariant() const;

private:
    using Link = std::uint32_t;  // twice the pair's place; and 1 for the chain of its second proxy
    static constexpr Link none = 0xffffffff;
    struct Links {
        std::array<Link, 2> next{none, none}, before{none, none};
    };
    std::vector<broad::Pair> pairs_;
    std::vector<Links> links_;  // by place
    std::vector<Link> first_;   // by proxy

    [[nodiscard]] broad::Proxy proxy_of(Link link) const {
        return (link & 1) == 0 ? pairs_[link / 2].a : pairs_[link / 2].b;
    }
    void hang(Link link);
    void unhang(Link link);
    void take_out(std::uint32_t place);
};

template <class F> void PairAdjacency::drop_if(F&& goes) {
    std::vector<broad::Pair> kept;
    for (const broad::Pair pair : pairs_)
        if (!goes(pair.a) && !goes(pair.b)) kept.push_back(pair);
    if (kept.size() == pairs_.size()) return;
    clear();
    add(kept);
}

}  // namespace fase::pairs
