#pragma once
/// Brute-force queries on a triangle mesh: ray cast, winding number, boundary edges.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fase/geometry/mesh.hpp"
#include "fase/geometry/ray.hpp"

namespace fase::level {

using TriangleCorners = std::array<Vec3d, 3>;

/// Returns the corners of a triangle of a mesh with valid indices.
[[nodiscard]] inline TriangleCorners corners_of(const TriangleMesh& mesh, std::size_t triangle) {
    const std::uint32_t* index = mesh.indices.data() + 3 * triangle;
    return {to_double(mesh.positions[index[0]]), to_double(mesh.positions[index[1]]),
            to_double(mesh.positions[index[2]])};
}

/// The intersection of a ray and a triangle.
struct TriangleHit {
    double distance = 0;  ///< metres along the ray, 0 or more
    double margin = 0;    ///< smallest barycentric coordinate: 0 on an edge, 1/3 in the middle
    bool into = false;    ///< enters from the side where the corners are counter-clockwise
};

/// Returns the intersection of an infinite ray and a triangle, from both sides, edges included; nullopt if the ray is
/// in the triangle's plane or the triangle has no area. Watertight: a ray through an edge that triangles share by equal
/// corners hits at least one of them. Source: Platis, Theoharis 2003, Fast ray-tetrahedron intersection using
/// Plücker coordinates (signs of the ray's volume with the edges).
[[nodiscard]] inline std::optional<TriangleHit> ray_triangle(Vec3d origin, Vec3d direction,
                                                             const TriangleCorners& corners) {
    const Vec3d a = corners[0] - origin, b = corners[1] - origin, c = corners[2] - origin;
    const double u = dot(direction, cross(b, c)), v = dot(direction, cross(c, a)), w = dot(direction, cross(a, b));
    const bool plus = u >= 0 && v >= 0 && w >= 0, minus = u <= 0 && v <= 0 && w <= 0;
    const double sum = u + v + w;
    if ((!plus && !minus) || sum == 0) return std::nullopt;
    const double distance =
        (u * dot(a, direction) + v * dot(b, direction) + w * dot(c, direction)) / (sum * dot(direction, direction));
    if (!(distance >= 0)) return std::nullopt;
    double least = u < 0 ? -u : u;
    for (const double other : {v < 0 ? -v : v, w < 0 ? -w : w}) least = other < least ? other : least;
    return TriangleHit{distance, least / (sum < 0 ? -sum : sum), sum < 0};
}

/// The first triangle on a ray.
struct PolygonHit {
    std::uint32_t triangle = 0;  ///< index; the smallest one of several at the same distance
    double distance = 0;         ///< metres from the ray's origin
    friend bool operator==(const PolygonHit&, const PolygonHit&) = default;
};

/// Returns the first triangle on the ray by testing all: the reference for trees.
[[nodiscard]] std::optional<PolygonHit> cast_ray_brute_force(const TriangleMesh& mesh, const Ray& ray);

/// Returns the generalized winding number of the mesh around the point, rounded to an integer: positive inside
/// triangles that are counter-clockwise seen from outside; holes in the mesh count as closed if the solid angle of the
/// mesh is more than half. On the surface, the number of either side. O(triangles). Source: Jacobson, Kavan,
/// Sorkine-Hornung 2013, Robust inside-outside segmentation using generalized winding numbers; van Oosterom, Strackee
/// 1983, The solid angle of a plane triangle. Angles are summed as products of complex numbers with a count of full
/// turns, so no arc tangent is needed.
[[nodiscard]] int winding_number(const TriangleMesh& mesh, Vec3d point);

/// An edge with more triangles on one side than on the other.
struct BoundaryEdge {
    Vec3d from, to;  ///< in the direction of its triangles
    int count = 1;   ///< the difference; above 0
};
/// Returns the boundary edges of a mesh; corners with equal coordinates are merged. Empty if the mesh is closed.
[[nodiscard]] std::vector<BoundaryEdge> boundary_of(const TriangleMesh& mesh);

/// Returns the contribution of the boundary to winding_number() of a point: to be added to the number of times that a
/// ray in direction -`direction` (unit) leaves the mesh, minus the number of times that it enters it. It is the winding
/// number of the boundary, extruded to infinity along `direction`. O(boundary edges).
[[nodiscard]] int boundary_winding(std::span<const BoundaryEdge> boundary, Vec3d point, Vec3d direction);

}  // namespace fase::level
