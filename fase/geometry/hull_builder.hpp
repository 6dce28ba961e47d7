#pragma once
/// Builds convex hulls from points.
#include <span>

#include "fase/core/result.hpp"
#include "fase/geometry/shapes/convex_hull.hpp"

namespace fase {

/// Limits of build_convex_hull().
struct HullOptions {
    int max_vertices = 255;  ///< at least 4; a hull with more vertices is simplified inward
};

/// Builds the convex hull of `points` (metres, any order, duplicates allowed). Merges triangles that are coplanar
/// within the float resolution (2^-22 of the sum of the largest coordinates) into one face and drops vertices inside
/// such a face or edge; above 4096 vertices it merges only exactly coplanar triangles. No point is outside by more than
/// twice that tolerance, unless `max_vertices` limits the hull: then it is inside the full hull. The same points in the
/// same order give the same bits; vertices keep the order of the points. BadArgument with the counts when fewer than 4
/// points are distinct, when all are on a plane or a line (thickness below 1e-4 m or eight times the tolerance), or
/// when a number is not finite or above 1e5. O(n log n) on average; a million points take about a second. Source:
/// Barber, Dobkin, Huhdanpaa 1996, The Quickhull algorithm for convex hulls; with exact decisions on a grid of 2^-30 of
/// the extent (grid_hull.hpp).
Result<ConvexHull> build_convex_hull(std::span<const Vec3> points, const HullOptions& options = {});

}  // namespace fase
