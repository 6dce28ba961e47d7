#pragma once
/// Boxes along a curve that fills space, and where to cut them in two there.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/broad/builders/binned_split.hpp"

namespace fase::broad {

/// Where a box's centre lies on the curve: 16 bits an axis, x, y, z interleaved, x highest.
struct MortonKey {
    std::uint64_t code = 0;
    std::uint32_t index = 0;  ///< of the item
};

/// Fills `keys` with one key an item, sorted by code, equal ones in the order of the items. The grid is a cube around
/// all centres. O(n). `scratch` is overwritten. Source: Morton 1966, A computer oriented geodetic data base.
void sort_by_morton(std::span<const BuildItem> items, std::vector<MortonKey>& keys, std::vector<MortonKey>& scratch);

/// How many of the sorted `keys` (2 or more) go to the left: those before the highest bit in which they differ; half
/// when all are equal. Source: Lauterbach and others 2009, Fast BVH construction on GPUs.
std::size_t morton_cut(std::span<const MortonKey> keys);

}  // namespace fase::broad
