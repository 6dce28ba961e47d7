#pragma once
/// Shared by the tests of pairs: random points and boxes, sorted pairs, and reference results.
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "fase/broad/brute_force.hpp"
#include "fase/broad/find_pairs.hpp"
#include "fase/core/random.hpp"

namespace fase::broad {

/// A random point with each coordinate between two numbers.
inline Vec3 place(Random& random, float from, float to) {
    const float x = random.between(from, to), y = random.between(from, to), z = random.between(from, to);
    return {x, y, z};
}

inline Aabb cube(Vec3 at, float side = 1) { return {at, at + Vec3{side, side, side}}; }

/// Boxes with sides of 0.5 to 1.5 in a cube, with about two neighbours each.
inline std::vector<Move> gas(std::size_t count, std::uint64_t seed, Vec3 at = {}) {
    Random random(seed);
    const float world = std::cbrt(static_cast<float>(count) * 2);
    std::vector<Move> boxes;
    for (Proxy p = 0; p < count; ++p) {
        const Vec3 lo = at + place(random, 0, world);
        boxes.push_back({p, {lo, lo + place(random, 0.5f, 1.5f)}});
    }
    return boxes;
}

/// Inserts boxes into a structure and commits.
template <class S> S filled(S s, const std::vector<Move>& boxes) {
    for (const Move& m : boxes) s.insert(m.proxy, m.box);
    s.commit();
    return s;
}

template <class S> std::vector<Pair> sorted_pairs(const S& structure) {
    std::vector<Pair> pairs;
    find_pairs(structure, pairs);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

/// The sorted pairs of the boxes, by brute force.
inline std::vector<Pair> reference_pairs(std::span<const Move> boxes) {
    BruteForce reference;
    for (const Move& m : boxes) reference.insert(m.proxy, m.box);
    return sorted_pairs(reference);
}

}  // namespace fase::broad
