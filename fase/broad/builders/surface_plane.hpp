#pragma once
/// The plane across an axis that leaves least surface times boxes on its sides.
#include <optional>
#include <span>

#include "fase/broad/builders/box_plane.hpp"

namespace fase::broad {

/// The best of `bins` - 1 (1 to 31) evenly spaced planes across each axis, moved back to the face of the last box
/// below; and what a query is expected to cost behind it: the sum over below, astride and above of count times
/// box_cost() of their bounds, where the bounds of those astride are known along the plane's axis only and else taken
/// from `bounds`. The first of equals; nullopt when no such plane separates anything. `bounds` encloses the boxes.
/// O(n). Sources: MacDonald and Booth 1990, Heuristics for ray tracing using space subdivision (surface); Wald 2007, On
/// fast construction of SAH-based bounding volume hierarchies (bins).
struct SurfacePlane {
    BoxPlane plane;
    double cost = 0;
};
std::optional<SurfacePlane> plane_of_least_surface(std::span<const Move> boxes, const Aabb& bounds, int bins);

}  // namespace fase::broad
