#pragma once
/// The convex hull of points on an integer grid, with exact decisions: the core of build_convex_hull().
#include <array>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "fase/math/vec3.hpp"

namespace fase::hull {

/// The largest absolute value of a coordinate: differences then fit in 31 bits, products of two in 62, and a cross
/// product of differences is exact in 64-bit integers.
constexpr std::int32_t grid_limit = 1 << 29;

/// A point with integer coordinates, in grid steps.
struct GridPoint {
    std::int32_t x = 0, y = 0, z = 0;
    friend bool operator==(GridPoint, GridPoint) = default;
};
constexpr Vec3Of<std::int64_t> operator-(GridPoint a, GridPoint b) {
    return {std::int64_t{a.x} - b.x, std::int64_t{a.y} - b.y, std::int64_t{a.z} - b.z};
}

/// An oriented plane through three grid points; the sign of a distance to it is exact.
class GridPlane {
public:
    GridPlane() = default;
    /// a, b, c are counter-clockwise seen from the positive side and not collinear.
    GridPlane(GridPoint a, GridPoint b, GridPoint c);
    /// Returns the distance above the plane in grid steps; accurate to 2^-17 of a step.
    [[nodiscard]] double distance(GridPoint p) const {
        return normal_.x * (double(p.x) - double(origin_.x)) + normal_.y * (double(p.y) - double(origin_.y)) +
               normal_.z * (double(p.z) - double(origin_.z));
    }
    /// Returns 1 above, -1 below, 0 in the plane; exact.
    [[nodiscard]] int side(GridPoint p) const;
    /// The unit normal, accurate to a few units in the last place.
    [[nodiscard]] Vec3d normal() const { return normal_; }
    /// Twice the area of the triangle (a, b, c), in square grid steps.
    [[nodiscard]] double twice_area() const { return twice_area_; }

private:
    Vec3Of<std::int64_t> cross_;
    Vec3d normal_;
    double twice_area_ = 0;
    GridPoint origin_;
};

/// One triangle of a closed surface, counter-clockwise seen from outside. neighbour[k] is across the edge from
/// corner[k] to corner[k + 1].
struct Triangle {
    std::array<std::uint32_t, 3> corner{};
    std::array<std::uint32_t, 3> neighbour{};
    GridPlane plane;
};

/// The result of quickhull(). `dimension` of the points: 3 a solid, 2 a plane, 1 a line, 0 one point, within
/// `min_thickness`; there are triangles only for 3.
struct GridHull {
    int dimension = 0;
    std::vector<Triangle> triangles;
};

/// Limits of quickhull().
struct GridHullOptions {
    double min_thickness = 1;  ///< grid steps: points that span less in some direction are no solid
    std::uint32_t max_vertices = std::numeric_limits<std::uint32_t>::max();
};

/// Computes the hull of the points as triangles: closed, exactly convex, no point outside, for any input. Adds the
/// farthest of all outside points next, so that stopping at `max_vertices` leaves a good hull inside the full one.
/// Deterministic; O(n log n) on average. Source: Barber, Dobkin, Huhdanpaa 1996, The Quickhull algorithm for convex
/// hulls; with exact signs in place of its facet merging.
GridHull quickhull(std::span<const GridPoint> points, const GridHullOptions& options);

}  // namespace fase::hull
