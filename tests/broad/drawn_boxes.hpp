#pragma once
/// What tests of pairs share: places drawn at random, pairs in order, and the judge.
#include <algorithm>
#include <span>
#include <vector>

#include "fase/broad/brute_force.hpp"
#include "fase/broad/find_pairs.hpp"
#include "fase/core/random.hpp"

namespace fase::broad {

/// Each coordinate between two numbers.
inline Vec3 place(Random& random, float from, float to) {
    const float x = random.between(from, to), y = random.between(from, to), z = random.between(from, to);
    return {x, y, z};
}

template <class S> std::vector<Pair> sorted_pairs(const S& structure) {
    std::vector<Pair> pairs;
    find_pairs(structure, pairs);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

/// The pairs of the boxes, by trying all.
inline std::vector<Pair> judged(std::span<const Move> boxes) {
    BruteForce judge;
    for (const Move& m : boxes) judge.insert(m.proxy, m.box);
    return sorted_pairs(judge);
}

}  // namespace fase::broad
