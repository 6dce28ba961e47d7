#pragma once
/// From points to the convex polyhedron around them.
#include <span>

#include "fase/core/result.hpp"
#include "fase/geometry/shapes/convex_hull.hpp"

namespace fase {

/// Limits of build_convex_hull().
struct HullOptions {
    int most_vertices = 255;  ///< the hull is simplified (never grown) to at most so many; at least 4
};

/// The convex hull of `points` (metres, any order, duplicates allowed), coplanar neighbours merged into one face. The
/// same points in the same order give the same bits. BadArgument with the counts when fewer than 4 points are distinct,
/// all lie in a plane, or a number is not finite or above 1e5. O(n log n) in the mean. Source: Barber, Dobkin,
/// Huhdanpaa 1996, The Quickhull algorithm for convex hulls.
Result<ConvexHull> build_convex_hull(std::span<const Vec3> points, const HullOptions& options = {});

}  // namespace fase
