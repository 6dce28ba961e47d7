/// The linked lists of pairs by proxy.
#include "fase/pairs/detail/pair_adjacency.hpp"

#include <algorithm>

#include "fase/core/detail/check.hpp"

namespace fase::pairs {

using namespace broad;

void PairAdjacency::clear() {
    pairs_.clear();
    links_.clear();
    std::fill(heads_.begin(), heads_.end(), none);
}

void PairAdjacency::add(std::span<const Pair> pairs) {
    Proxy largest = 0;
    for (const Pair pair : pairs) largest = std::max(largest, pair.b);
    if (!pairs.empty() && largest >= heads_.size()) heads_.resize(largest + std::size_t{1}, none);
    for (const Pair pair : pairs) {
        const auto index = static_cast<Link>(pairs_.size());
        FASE_ASSERT(index < none / 2);
        pairs_.push_back(pair);
        links_.emplace_back();
        push_front(2 * index);
        push_front(2 * index + 1);
    }
}

void PairAdjacency::remove_all_of(Proxy p) {
    if (p >= heads_.size()) return;
    while (heads_[p] != none) remove_at(heads_[p] / 2);
}

/// Inserts a link at the front of its proxy's linked list.
void PairAdjacency::push_front(Link link) {
    Link& head = heads_[proxy_of(link)];
    links_[link / 2].next[link & 1] = head;
    links_[link / 2].previous[link & 1] = none;
    if (head != none) links_[head / 2].previous[head & 1] = link;
    head = link;
}

void PairAdjacency::unlink(Link link) {
    const Link next = links_[link / 2].next[link & 1], previous = links_[link / 2].previous[link & 1];
    if (next != none) links_[next / 2].previous[next & 1] = previous;
    if (previous != none) {
        links_[previous / 2].next[previous & 1] = next;
    } else {
        heads_[proxy_of(link)] = next;
    }
}

/// Moves the last pair of the list to the free index.
void PairAdjacency::remove_at(std::uint32_t index) {
    unlink(2 * index);
    unlink(2 * index + 1);
    const auto last = static_cast<std::uint32_t>(pairs_.size() - 1);
    if (index != last) {
        pairs_[index] = pairs_[last];
        links_[index] = links_[last];
        for (const Link side : {0u, 1u}) {
            const Link next = links_[index].next[side], previous = links_[index].previous[side];
            if (next != none) links_[next / 2].previous[next & 1] = 2 * index + side;
            if (previous != none) {
                links_[previous / 2].next[previous & 1] = 2 * index + side;
            } else {
                heads_[proxy_of(2 * index + side)] = 2 * index + side;
            }
        }
    }
    pairs_.pop_back();
    links_.pop_back();
}

std::string PairAdjacency::broken_invariant() const {
    if (links_.size() != pairs_.size()) return "the numbers of pairs and links differ";
    std::size_t linked_count = 0;
    for (Proxy p = 0; p < heads_.size(); ++p) {
        Link previous = none;
        for (Link link = heads_[p]; link != none; previous = link, link = links_[link / 2].next[link & 1]) {
            if (link / 2 >= pairs_.size() || proxy_of(link) != p)
                return "a pair is in the linked list of another proxy";
            if (links_[link / 2].previous[link & 1] != previous) return "a link and its previous link disagree";
            if (++linked_count > 2 * pairs_.size()) return "a linked list has a cycle";
        }
    }
    return linked_count == 2 * pairs_.size() ? "" : "a pair is in no linked list";
}

}  // namespace fase::pairs
