#pragma once
/// The convex hull of points on an integer grid, with exact decisions: the core of build_convex_hull().
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/math/vec3.hpp"

namespace fase::hull {

/// Coordinates are at most this in size: then differences fit 31 bits, products of two in 62, and a cross product of
/// differences is exact in 64-bit integers.
constexpr std::int32_t grid_limit = 1 << 29;

/// A point whose coordinates are whole numbers of grid steps.
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
    /// Counter-clockwise a, b, c seen from the positive side; they must not lie on a line.
    GridPlane(GridPoint a, GridPoint b, GridPoint c);
    /// Grid steps above the plane; right to 2^-17 of a step.
    [[nodiscard]] double distance(GridPoint p) const {
        return normal_.x * (double(p.x) - double(origin_.x)) + normal_.y * (double(p.y) - double(origin_.y)) +
               normal_.z * (double(p.z) - double(origin_.z));
    }
    /// 1 above, -1 below, 0 in the plane: exact.
    [[nodiscard]] int side(GridPoint p) const;
    /// Unit normal, right to a few units in the last place.
    [[nodiscard]] Vec3d normal() const { return normal_; }
    /// Twice the area of the triangle that made the plane, in square grid steps.
    [[nodiscard]] double twice_area() const { return twice_area_; }

private:
    Vec3Of<std::int64_t> cross_;
    Vec3d normal_;
    double twice_area_ = 0;
    GridPoint origin_;
};

/// One triangle of a closed surface, counter-clockwise seen from outside. neighbour[k] lies across the edge from
/// corner[k] to corner[k + 1].
struct Triangle {
    std::array<std::uint32_t, 3> corner{};
    std::array<std::uint32_t, 3> neighbour{};
    GridPlane plane;
};

/// What quickhull() found. `dimension` says what the points span: 3 a solid, 2 a plane, 1 a line, 0 one point, each as
/// far as `thinnest` tells; triangles are there only for 3.
struct GridHull {
    int dimension = 0;
    std::vector<Triangle> triangles;
};

/// Where quickhull() gives up and where it stops.
struct GridHullOptions {
    double thinnest = 1;  ///< grid steps: points that span less in some direction do not make a solid
    std::uint32_t max_vertices = 0xffffffff;
};

/// Triangles around the points: closed, exactly convex, no point outside, whatever the points. Of all points outside,
/// the farthest is added next, so stopping at `max_vertices` leaves a good hull inside the full one. Deterministic;
/// O(n log n) in the mean. Source: Barber, Dobkin, Huhdanpaa 1996, The Quickhull algorithm for convex hulls; here with
/// exact signs in place of its facet merging.
GridHull quickhull(std::span<const GridPoint> points, const GridHullOptions& options);

}  // namespace fase::hull
