#pragma once
/// From points to the convex polyhedron around them.
#include <span>

#include "fase/core/result.hpp"
#include "fase/geometry/shapes/convex_hull.hpp"

namespace fase {

/// Limits of build_convex_hull().
struct HullOptions {
    int max_vertices = 255;  ///< the hull is simplified (never grown) to at most so many; at least 4
};

/// The convex hull of `points` (metres, any order, duplicates allowed). Triangles that lie in one plane to within what
/// floats of that size tell apart (2^-22 of the sum of the largest coordinates) are merged into one face, and vertices
/// inside such a face or edge dropped; above 4096 vertices only what is exactly coplanar. No point is farther than
/// twice that outside, unless `max_vertices` cut the hull short: then it lies inside the full one. The same points in
/// the same order give the same bits; vertices keep the order of the points. BadArgument with the counts when fewer
/// than 4 points are distinct, all lie in a plane or on a line (a thickness under 1e-4 m or eight times the above), or
/// a number is not finite or above 1e5. O(n log n) in the mean; a million points take about a second. Source: Barber,
/// Dobkin, Huhdanpaa 1996, The Quickhull algorithm for convex hulls; decisions are exact, on a grid of 2^-30 of the
/// extent (grid_hull.hpp).
Result<ConvexHull> build_convex_hull(std::span<const Vec3> points, const HullOptions& options = {});

}  // namespace fase
