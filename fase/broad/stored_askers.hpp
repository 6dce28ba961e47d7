#pragma once
/// Which of a list of askers a structure stores, so that their pairs can be had from the structure's own pairs.
#include <span>

#include "fase/broad/structure.hpp"

namespace fase::broad {

/// Askers that are stored with the very box that they ask with, and the rest.
struct StoredAskers {
    std::vector<std::uint8_t> stored;  ///< by proxy, up to the largest asker: 1 for those that are stored
    std::size_t count = 0;             ///< of those
    std::vector<Move> others;          ///< not stored, or with another box; in the order of the askers
};

/// One pass over all that is stored, one over the askers.
template <Structure S> StoredAskers stored_askers(const S& structure, std::span<const Move> askers) {
    Proxy largest = 0;
    for (const Move& asker : askers) largest = asker.proxy > largest ? asker.proxy : largest;
    constexpr std::uint32_t none = 0xffffffff;
    std::vector<std::uint32_t> place(largest + std::size_t{1}, none);  // of a proxy among the askers
    for (std::size_t i = 0; i < askers.size(); ++i) place[askers[i].proxy] = static_cast<std::uint32_t>(i);
    StoredAskers known;
    known.stored.assign(place.size(), 0);
    structure.traverse(Everything{}, [&](Proxy p, const Aabb& box) {
        if (p < place.size() && place[p] != none && askers[place[p]].box == box) {
            known.stored[p] = 1;
            ++known.count;
        }
        return true;
    });
    for (const Move& asker : askers)
        if (known.stored[asker.proxy] == 0) known.others.push_back(asker);
    return known;
}

/// Leaves in `pairs`, from place `first` on, those that the stored askers would have found by asking: the pairs of two
/// of them twice, unless `is_asker` marks the smaller.
inline void keep_pairs_of(const StoredAskers& known, std::span<const std::uint8_t> is_asker, std::vector<Pair>& pairs,
                          std::size_t first) {
    const auto asks = [&](Proxy p) { return p < known.stored.size() && known.stored[p] != 0; };
    const auto marked = [&](Proxy p) { return p < is_asker.size() && is_asker[p] != 0; };
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
