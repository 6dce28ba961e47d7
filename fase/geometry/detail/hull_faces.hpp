#pragma once
/// Merges coplanar triangles of a hull into faces and drops redundant vertices.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/geometry/detail/grid_hull.hpp"

namespace fase::hull {

/// Polygonal faces, or the vertices for another run of quickhull().
struct MergedFaces {
    /// Corner indices of each face, counter-clockwise from outside, the smallest first; sorted. Filled only when
    /// `redundant` is false.
    std::vector<std::vector<std::uint32_t>> loops;
    std::vector<std::uint32_t> vertices;  ///< vertices of three faces or more, ascending
    bool redundant = false;               ///< some vertex is inside a face or an edge: compute the hull of `vertices`
    bool valid = true;                    ///< the border of every face is one simple, convex loop
};

/// The plane of a face in double: its unit normal (Newell's method) and its centroid.
struct FacePlane {
    Vec3d normal, centroid;
    /// Returns the distance above the plane in grid steps.
    [[nodiscard]] double distance(GridPoint p) const {
        return dot(normal, Vec3d{double(p.x), double(p.y), double(p.z)} - centroid);
    }
};
[[nodiscard]] FacePlane plane_of(std::span<const GridPoint> points, std::span<const std::uint32_t> loop);

/// Merges triangles within `tolerance` grid steps of one plane, largest triangle first. At 0 it merges exactly coplanar
/// triangles only, and every face is flat, convex and simple. O(n log n).
MergedFaces merge_coplanar(std::span<const GridPoint> points, std::span<const Triangle> triangles, double tolerance);

}  // namespace fase::hull
