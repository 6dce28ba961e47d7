#pragma once
/// The loops of a pair tracker that are compiled for every SIMD target.
#include <cstddef>
#include <span>
#include <vector>

#include "fase/broad/structure.hpp"

namespace fase::pairs::passes {

/// Where a box was and is, in one line of the cache: lower corners before and now, upper corners before and now. The
/// fourth number of each is 0 in all.
struct alignas(64) LastPlaces {
    float lo[2][4], hi[2][4];
};

/// Puts a box into both places.
void stay(const Aabb& box, LastPlaces& places);

/// What is now was before, and the boxes are now; for boxes `begin` to `end`. `spans` gets the smallest boxes that hold
/// both places (of two of which one has a NaN, at least the other).
void advance(std::span<const Aabb> boxes, std::size_t begin, std::size_t end, LastPlaces* places, Aabb* spans);

/// Tells what became of the pairs: those that overlap in both places move to the front of the list, in their order;
/// returns how many. The others are appended to `begun` or `ended`, or were no pair in either frame.
std::size_t tell(const LastPlaces* places, std::span<broad::Pair> pairs, std::vector<broad::Pair>& begun,
                 std::vector<broad::Pair>& ended);

}  // namespace fase::pairs::passes
