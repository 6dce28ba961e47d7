#pragma once
/// The loops of a pair tracker that are compiled for every SIMD target.
#include <cstddef>
#include <span>
#include <vector>

#include "fase/broad/structure.hpp"

namespace fase::pairs::passes {

/// Where a box was and is, in one line of the cache: lower corners before and now, upper corners before and now. The
/// fourth number of each is 0 in all. All others are NaN where it was or is absent (Aabb{}): that overlaps nothing.
struct alignas(64) LastPlaces {
    float lo[2][4], hi[2][4];
};

/// Puts a box into both places.
void stay(const Aabb& box, LastPlaces& places);

/// What is now was before, and the boxes are now; for boxes `begin` to `end`. `changed` gets those that are not in the
/// same place for the third time, bit by bit, in order, and needs room for all; returns how many. Their `spans` become
/// the smallest boxes that hold both places (of two of which one has a NaN, at least the other; of two absent ones
/// Aabb{}).
std::size_t advance(std::span<const Aabb> boxes, std::size_t begin, std::size_t end, LastPlaces* places, Aabb* spans,
                    broad::Proxy* changed);

/// Tells what became of the pairs: those that overlap in both places move to the front of the list, in their order;
/// returns how many. The others are appended to `begun` or `ended`, or were no pair in either frame.
std::size_t tell(std::span<const LastPlaces> places, std::span<broad::Pair> pairs, std::vector<broad::Pair>& begun,
                 std::vector<broad::Pair>& ended);

}  // namespace fase::pairs::passes
