#pragma once
/// Finds the query boxes that a structure stores, whose pairs are among the pairs of the structure.
#include <span>

#include "fase/broad/structure.hpp"
#include "fase/core/no_index.hpp"

namespace fase::broad {

/// The query boxes that are stored with the same box, and the others.
struct StoredQueries {
    std::vector<std::uint8_t> stored;  ///< by proxy, up to the largest query proxy: 1 if stored
    std::size_t count = 0;             ///< of the stored ones
    std::vector<Move> others;          ///< not stored, or stored with another box; in query order
};

/// Divides the query boxes into stored ones and others. O(stored boxes + query boxes).
template <Structure S> StoredQueries stored_queries(const S& structure, std::span<const Move> query_boxes) {
    Proxy largest = 0;
    for (const Move& query_box : query_boxes) largest = query_box.proxy > largest ? query_box.proxy : largest;
    std::vector<std::uint32_t> index(largest + std::size_t{1}, no_index);  // by proxy, in query_boxes
    for (std::size_t i = 0; i < query_boxes.size(); ++i) index[query_boxes[i].proxy] = static_cast<std::uint32_t>(i);
    StoredQueries known;
    known.stored.assign(index.size(), 0);
    structure.traverse(Everything{}, [&](Proxy p, const Aabb& box) {
        if (p < index.size() && index[p] != no_index && query_boxes[index[p]].box == box) {
            known.stored[p] = 1;
            ++known.count;
        }
        return true;
    });
    for (const Move& query_box : query_boxes)
        if (known.stored[query_box.proxy] == 0) known.others.push_back(query_box);
    return known;
}

/// Reduces `pairs`, from index `first` on, to the pairs that queries of the stored query boxes would find. The pairs of
/// two of them appear twice, unless `is_query` marks the smaller proxy.
inline void keep_pairs_of(const StoredQueries& known, std::span<const std::uint8_t> is_query, std::vector<Pair>& pairs,
                          std::size_t first) {
    const auto queries = [&](Proxy p) { return p < known.stored.size() && known.stored[p] != 0; };
    const auto marked = [&](Proxy p) { return p < is_query.size() && is_query[p] != 0; };
    std::vector<Pair> duplicates;
    std::size_t kept = first;
    for (std::size_t i = first; i < pairs.size(); ++i) {
        const Pair pair = pairs[i];
        const bool from_a = queries(pair.a), from_b = queries(pair.b) && !marked(pair.a);
        if (from_a || from_b) pairs[kept++] = pair;
        if (from_a && from_b) duplicates.push_back(pair);
    }
    pairs.resize(kept);
    pairs.insert(pairs.end(), duplicates.begin(), duplicates.end());
}

}  // namespace fase::broad
