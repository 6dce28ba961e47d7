#pragma once
/// From triangles to flat faces: merges what is coplanar and drops the vertices that no longer matter.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/geometry/detail/grid_hull.hpp"

namespace fase::hull {

/// Faces of many corners, or the vertices to start again from.
struct MergedFaces {
    /// Corner indices of each face, counter-clockwise from outside, the smallest first; sorted. Filled only when
    /// `superfluous` is false.
    std::vector<std::vector<std::uint32_t>> loops;
    std::vector<std::uint32_t> vertices;  ///< those that three faces or more meet at, ascending
    bool superfluous = false;             ///< some vertex lies inside a face or an edge: the hull of `vertices` is due
    bool sound = true;                    ///< the border of every face is one simple loop that turns left all round
};

/// A plane in double through the middle of a face: its unit normal (by Newell's sum) and one of its points.
struct FacePlane {
    Vec3d normal, at;
    /// Grid steps above the plane.
    [[nodiscard]] double distance(GridPoint p) const {
        return dot(normal, Vec3d{double(p.x), double(p.y), double(p.z)} - at);
    }
};
[[nodiscard]] FacePlane plane_of(std::span<const GridPoint> points, std::span<const std::uint32_t> loop);

/// Joins triangles that lie within `tolerance` grid steps of one plane; largest triangle first. At 0 only those exactly
/// in one plane, and then every face is flat, convex and simple. O(n log n).
MergedFaces merge_coplanar(std::span<const GridPoint> points, std::span<const Triangle> triangles, double tolerance);

}  // namespace fase::hull
