/// The chains of kept pairs.
#include "fase/pairs/detail/pair_adjacency.hpp"

#include <algorithm>

#include "fase/core/detail/check.hpp"

namespace fase::pairs {

using namespace broad;

void PairAdjacency::clear() {
    pairs_.clear();
    links_.clear();
    std::fill(first_.begin(), first_.end(), none);
}

void PairAdjacency::add(std::span<const Pair> pairs) {
    Proxy largest = 0;
    for (const Pair pair : pairs) largest = std::max(largest, pair.b);
    if (!pairs.empty() && largest >= first_.size()) first_.resize(largest + std::size_t{1}, none);
    for (const Pair pair : pairs) {
        const auto place = static_cast<Link>(pairs_.size());
        FASE_ASSERT(place < none / 2);
        pairs_.push_back(pair);
        links_.emplace_back();
        hang(2 * place);
        hang(2 * place + 1);
    }
}

void PairAdjacency::drop(Proxy p) {
    if (p >= first_.size()) return;
    while (first_[p] != none) take_out(first_[p] / 2);
}

/// Puts it at the front of its chain.
void PairAdjacency::hang(Link link) {
    Link& first = first_[proxy_of(link)];
    links_[link / 2].next[link & 1] = first;
    links_[link / 2].before[link & 1] = none;
    if (first != none) links_[first / 2].before[first & 1] = link;
    first = link;
}

void PairAdjacency::unhang(Link link) {
    const Link next = links_[link / 2].next[link & 1], before = links_[link / 2].before[link & 1];
    if (next != none) links_[next / 2].before[next & 1] = before;
    if (before != none) {
        links_[before / 2].next[before & 1] = next;
    } else {
        first_[proxy_of(link)] = next;
    }
}

/// The last of the list takes the place.
void PairAdjacency::take_out(std::uint32_t place) {
    unhang(2 * place);
    unhang(2 * place + 1);
    const auto last = static_cast<std::uint32_t>(pairs_.size() - 1);
    if (place != last) {
        pairs_[place] = pairs_[last];
        links_[place] = links_[last];
        for (const Link side : {0u, 1u}) {
            const Link next = links_[place].next[side], before = links_[place].before[side];
            if (next != none) links_[next / 2].before[next & 1] = 2 * place + side;
            if (before != none) {
                links_[before / 2].next[before & 1] = 2 * place + side;
            } else {
                first_[proxy_of(2 * place + side)] = 2 * place + side;
            }
        }
    }
    pairs_.pop_back();
    links_.pop_back();
}

std::string PairAdjacency::broken_invariant() const {
    if (links_.size() != pairs_.size()) return "pairs and links differ in number";
    std::size_t hung = 0;
    for (Proxy p = 0; p < first_.size(); ++p) {
        Link before = none;
        for (Link link = first_[p]; link != none; before = link, link = links_[link / 2].next[link & 1]) {
            if (link / 2 >= pairs_.size() || proxy_of(link) != p) return "a pair hangs in another's chain";
            if (links_[link / 2].before[link & 1] != before) return "a chain does not lead back";
            if (++hung > 2 * pairs_.size()) return "a chain has no end";
        }
    }
    return hung == 2 * pairs_.size() ? "" : "a pair hangs in no chain";
}

}  // namespace fase::pairs
