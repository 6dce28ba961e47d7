#pragma once
/// Which of a list of askers a structure stores, so that their pairs can be had from the structure's own pairs.
#include <span>

#include "fase/broad/structure.hpp"

namespace fase::broad {

/// QueryBoxes that are stored with the very box that they ask with, and the rest.
struct StoredQueries {
    std::vector<std::uint8_t> stored;  ///< by proxy, up to the largest asker: 1 for those that are stored
    std::size_t count = 0;             ///< of those
    std::vector<Move> others;          ///< not stored, or with another box; in the order of the askers
};

/// One pass over all that is stored, one over the askers.
template <Structure S> StoredQueries stored_queries(const S& structure, std::span<const Move> query_boxes) {
    Proxy largest = 0;
    for (const Move& query_box : query_boxes) largest = query_box.proxy > largest ? query_box.proxy : largest;
    constexpr std::uint32_t none = 0xffffffff;
    std::vector<std::uint32_t> place(largest + std::size_t{1}, none);  // of a proxy among the askers
    for (std::size_t i = 0; i < query_boxes.size(); ++i) place[query_boxes[i].proxy] = static_cast<std::uint32_t>(i);
    StoredQueries known;
    known.stored.assign(place.size(), 0);
    structure.traverse(Everything{}, [&](Proxy p, const Aabb& box) {
        if (p < place.size() && place[p] != none && query_boxes[place[p]].box == box) {
            known.stored[p] = 1;
            ++known.count;
        }
        return true;
    });
    for (const Move& query_box : query_boxes)
        if (known.stored[query_box.proxy] == 0) known.others.push_back(query_box);
    return known;
}

/// Leaves in `pairs`, from place `first` on, those that the stored askers would have found by asking: the pairs of two
/// of them twice, unless `is_query` marks the smaller.
inline void keep_pairs_of(const StoredQueries& known, std::span<const std::uint8_t> is_query, std::vector<Pair>& pairs,
                          std::size_t first) {
    const auto asks = [&](Proxy p) { return p < known.stored.size() && known.stored[p] != 0; };
    const auto marked = [&](Proxy p) { return p < is_query.size() && is_query[p] != 0; };
    std::vector<Pair> again;
    std::size_t kept = first;
    for (std::size_t i = first; i < pairs.size(); ++i) {
        const Pair pair = pairs[i];
        const bool from_a = asks(pair.a), from_b = asks(pair.b) && !marked(pair.a);
        if (from_a || from_b) pairs[kept++] = pair;
        if (from_a && from_b) again.push_back(pair);
    }
    pairs.resize(kept);
    pairs.insert(pairs.end(), again.begin(), again.end());
}

}  // namespace fase::broad
