#pragma once
/// Splits a set of boxes in two by the surface area heuristic, for top-down builds of trees.
#include <cstddef>
#include <span>

#include "fase/broad/boxes/largest_built.hpp"
#include "fase/broad/structure.hpp"

namespace fase::broad {

/// A box of a tree build. Boxes must be finite, lo <= hi, and within `largest_built` of the origin.
struct BuildItem {
    Aabb box;
    Proxy proxy = 0;
};

/// Twice the centre of a box along an axis.
constexpr float doubled_centre(const Aabb& box, int axis) { return box.lo[axis] + box.hi[axis]; }

/// The first `left_count` items are the left side. Both sides have at least one item; `left` and `right` are their
/// bounds.
struct Split {
    std::size_t left_count = 0;
    Aabb left, right;
};

/// Cost of a box in a tree: half its surface, as the probability that a random line hits a box is proportional to its
/// surface, plus a thousandth of the square of the sum of its sides, which also ranks boxes without surface (segments).
/// 0 for a point; monotone in the box.
constexpr float box_cost(const Aabb& box) {
    const Vec3 e = extent(box);
    const float sides = e.x + e.y + e.z;
    return e.x * e.y + e.y * e.z + e.z * e.x + 0.001f * (sides * sides);
}

/// Reorders `items` (2 or more) so that left and right have a small sum of count times box_cost(): takes the best of 15
/// splits on the longest axis of the centres; splits in half, without reordering, when all centres coincide. O(n),
/// allocates nothing. The result depends only on the items and their order. Source: Wald 2007, On fast
/// construction of SAH-based bounding volume hierarchies.
Split split_by_binned_area(std::span<BuildItem> items);

}  // namespace fase::broad
