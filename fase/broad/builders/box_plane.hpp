#pragma once
/// Axis-aligned planes, and how they split boxes.
#include <optional>
#include <span>
#include <vector>

#include "fase/broad/builders/plane_choice.hpp"
#include "fase/broad/structure.hpp"

namespace fase::broad {

/// The points whose coordinate `axis` (0, 1, 2 for x, y, z) is `at`.
struct BoxPlane {
    int axis = 0;
    float at = 0;
    friend constexpr bool operator==(const BoxPlane&, const BoxPlane&) = default;
};

/// A box that touches the plane from one side is on that side; a box in the plane is below.
constexpr Side side_of(const BoxPlane& plane, const Aabb& box) {
    return box.hi[plane.axis] <= plane.at   ? Side::Below
           : box.lo[plane.axis] >= plane.at ? Side::Above
                                            : Side::Straddling;
}

/// Counts the boxes on each side of the plane. O(n).
PlaneCut cut_of(const BoxPlane& plane, std::span<const Move> boxes);

/// Returns the k-th smallest value, counted from 0. Reorders `values`, which must hold more than k.
float nth_smallest(std::vector<float>& values, std::size_t k);

/// Returns a plane that leaves at most 7/8 of the boxes together (for less than 8 boxes: all but one). Tries planes
/// through the median faces of each axis; nullopt when none of them is good enough, for example for identical boxes.
/// O(n); `scratch` is overwritten. Ends trees that have become too deep within O(log n) levels.
std::optional<BoxPlane> halving_plane(std::span<const Move> boxes, std::vector<float>& scratch);

}  // namespace fase::broad
