#pragma once
/// The signed distance of two cores.
#include "fase/narrow/detail/core_view.hpp"
#include "fase/narrow/distance.hpp"

namespace fase::narrow {

/// signed_distance() of two convex shapes.
[[nodiscard]] Distance distance_of_cores(const CoreView& a, const CoreView& b, const TransformD& b_in_a);
/// overlaps() of two convex shapes.
[[nodiscard]] bool cores_overlap(const CoreView& a, const CoreView& b, const TransformD& b_in_a);
/// Converts the distance of (b, a) to that of (a, b).
[[nodiscard]] inline Distance flipped(const Distance& d, const TransformD& b_in_a) {
    return {d.distance, transform(b_in_a, d.on_b), transform(b_in_a, d.on_a), -(b_in_a.rotation * d.normal)};
}

}  // namespace fase::narrow
