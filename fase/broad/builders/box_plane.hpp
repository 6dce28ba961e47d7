#pragma once
/// Planes across an axis, and how they cut boxes.
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

/// A box that touches the plane from one side is on that side; one that lies in it is below.
constexpr Side side_of(const BoxPlane& plane, const Aabb& box) {
    return box.hi[plane.axis] <= plane.at ? Side::Below : box.lo[plane.axis] >= plane.at ? Side::Above : Side::Astride;
}

/// O(n).
PlaneCut cut_of(const BoxPlane& plane, std::span<const Move> boxes);

/// The k-th smallest, from 0; reorders `values`, which must hold more than k.
float ranked(std::vector<float>& values, std::size_t k);

/// A plane that leaves at most 7/8 of the boxes together (or all but one, when they are less than 8); nullopt when
/// there is none among those that go through faces in the middle of each axis, as for boxes that are all alike. O(n);
/// `scratch` is overwritten. Trees that have grown too deep end within O(log n) levels by it.
std::optional<BoxPlane> halving_plane(std::span<const Move> boxes, std::vector<float>& scratch);

}  // namespace fase::broad
