#pragma once
/// Axis-aligned splitting planes by the surface area heuristic.
#include <optional>
#include <span>

#include "fase/broad/builders/box_plane.hpp"

namespace fase::broad {

/// A plane and the expected cost of a query below it.
struct SurfacePlane {
    BoxPlane plane;
    double cost = 0;
};
/// Returns the best of `bins` - 1 (1 to 31) evenly spaced planes per axis, moved back to the face of the last box
/// below. The cost is the sum over the boxes below, straddling and above of count times box_cost() of their bounds; the
/// bounds of straddling boxes are computed on the axis of the plane only and otherwise taken from `bounds`. Returns the
/// first of equals; nullopt when no such plane separates the boxes. `bounds` encloses the boxes. O(n). Sources:
/// MacDonald and Booth 1990, Heuristics for ray tracing using space subdivision (surface); Wald 2007, On fast
/// construction of SAH-based bounding volume hierarchies (bins).
std::optional<SurfacePlane> plane_of_least_surface(std::span<const Move> boxes, const Aabb& bounds, int bins);

}  // namespace fase::broad
