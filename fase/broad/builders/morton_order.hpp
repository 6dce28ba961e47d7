#pragma once
/// Morton order of boxes, and where to split it.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/broad/builders/binned_split.hpp"

namespace fase::broad {

/// Position of the centre of a box on the Morton curve: 16 bits per axis, x, y, z interleaved, x highest.
struct MortonKey {
    std::uint64_t code = 0;
    std::uint32_t index = 0;  ///< of the item
};

/// Fills `keys` with one key per item, sorted by code; equal codes are in the order of the items. The grid is a cube
/// around all centres. O(n). `scratch` is overwritten. Source: Morton 1966, A computer oriented geodetic data base.
void sort_by_morton(std::span<const BuildItem> items, std::vector<MortonKey>& keys, std::vector<MortonKey>& scratch);

/// Returns how many of the sorted `keys` (2 or more) go to the left: those with a 0 in the highest bit in which the
/// first and last key differ; half of them when all are equal. Source: Lauterbach and others 2009, Fast BVH
/// construction on GPUs.
std::size_t morton_cut(std::span<const MortonKey> keys);

}  // namespace fase::broad
