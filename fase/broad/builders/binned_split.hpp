#pragma once
/// Where to cut a set of boxes in two, for trees that are built from the top.
#include <cstddef>
#include <span>

#include "fase/broad/structure.hpp"

namespace fase::broad {

/// A box on its way into a tree. Boxes must be finite, lo <= hi, and within `largest_built` of the origin.
struct BuildItem {
    Aabb box;
    Proxy proxy = 0;
};

/// Coordinates up to this size (metres) can be built with: areas of such boxes, and sums of them, stay finite in float.
inline constexpr float largest_built = 1e17f;

/// The first `left_count` items are the left side; both sides hold at least one item and come with their bounds.
struct Split {
    std::size_t left_count = 0;
    Aabb left, right;
};

/// How much it costs to have a box in a tree: half its surface, which a random line's chance to meet it is proportional
/// to, and a thousandth of the square of its sides' sum, so that boxes without surface (on one line) are told apart
/// too. 0 for a point; never less for a larger box.
constexpr float box_cost(const Aabb& box) {
    const Vec3 e = extent(box);
    const float sides = e.x + e.y + e.z;
    return e.x * e.y + e.y * e.z + e.z * e.x + 0.001f * (sides * sides);
}

/// Reorders `items` (2 or more) so that left and right have a small sum of count times box_cost(): the best of 15 cuts
/// across the longest axis of the centres; half and half, as they stand, when all centres are in one place. O(n),
/// without memory of its own; the outcome depends on the items and their order alone. Source: Wald 2007, On fast
/// construction of SAH-based bounding volume hierarchies.
Split split_by_binned_area(std::span<BuildItem> items);

}  // namespace fase::broad
