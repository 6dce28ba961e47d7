#pragma once
/// Triangles in space and what is asked of them one by one: ray against triangle, winding number, are they closed.
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

/// The corners of a triangle of a mesh, whose indices are good.
[[nodiscard]] inline TriangleCorners corners_of(const TriangleMesh& mesh, std::size_t triangle) {
    const std::uint32_t* index = mesh.indices.data() + 3 * triangle;
    return {to_double(mesh.positions[index[0]]), to_double(mesh.positions[index[1]]),
            to_double(mesh.positions[index[2]])};
}

/// Where a ray goes through a triangle.
struct TriangleHit {
    double at = 0;      ///< metres along the ray, 0 or more
    double margin = 0;  ///< share of the triangle's surface by which it is not missed: 0 on an edge, 1/3 in the middle
    bool into = false;  ///< from the side where the corners are seen counter-clockwise to the other one
};

/// The place where a ray of any length, not only its own, meets a triangle; from both sides, edges belong to it. A ray
/// within the triangle's plane, and a triangle without surface: none. Watertight: a ray through an edge that triangles
/// share by equal corners meets one of them. Source: Platis, Theoharis 2003, Fast ray-tetrahedron intersection using
/// Plücker coordinates (signs of the ray's volume with the edges).
[[nodiscard]] inline std::optional<TriangleHit> ray_triangle(Vec3d origin, Vec3d direction,
                                                             const TriangleCorners& corners) {
    const Vec3d a = corners[0] - origin, b = corners[1] - origin, c = corners[2] - origin;
    const double u = dot(direction, cross(b, c)), v = dot(direction, cross(c, a)), w = dot(direction, cross(a, b));
    const bool plus = u >= 0 && v >= 0 && w >= 0, minus = u <= 0 && v <= 0 && w <= 0;
    const double sum = u + v + w;
    if ((!plus && !minus) || sum == 0) return std::nullopt;
    const double at =
        (u * dot(a, direction) + v * dot(b, direction) + w * dot(c, direction)) / (sum * dot(direction, direction));
    if (!(at >= 0)) return std::nullopt;
    double least = u < 0 ? -u : u;
    for (const double other : {v < 0 ? -v : v, w < 0 ? -w : w}) least = other < least ? other : least;
    return TriangleHit{at, least / (sum < 0 ? -sum : sum), sum < 0};
}

/// The nearest triangle on a ray.
struct PolygonHit {
    std::uint32_t triangle = 0;  ///< its number; of those at one place the smallest
    double at = 0;               ///< metres from the ray's origin
    friend bool operator==(const PolygonHit&, const PolygonHit&) = default;
};

/// The first triangle on the ray, found by asking all: the judge of trees.
[[nodiscard]] std::optional<PolygonHit> cast_ray_at_all(const TriangleMesh& mesh, const Ray& ray);

/// How often the mesh goes around the point, counter-clockwise triangles seen from outside counting up: the generalized
/// winding number rounded to whole numbers, so that holes in the mesh are thought to be closed by what they are seen as
/// from the point. For points on the surface either neighbour's. O(triangles).
/// Source: Jacobson, Kavan, Sorkine-Hornung 2013, Robust inside-outside segmentation using generalized winding numbers;
/// van Oosterom, Strackee 1983, The solid angle of a plane triangle. The angles are summed as products of complex
/// numbers with the turns counted, so that no arc tangent is needed.
[[nodiscard]] int winding_number(const TriangleMesh& mesh, Vec3d point);

/// An edge with more triangles on its one side than on its other.
struct RimEdge {
    Vec3d from, to;  ///< as its triangles go
    int times = 1;   ///< by how many more; above 0
};
/// All of them, corners with equal coordinates being one: none when the mesh is closed.
[[nodiscard]] std::vector<RimEdge> rim_of(const TriangleMesh& mesh);

/// What is to be added to the number of times that a ray against `way` (unit) leaves the mesh less those that it enters
/// it, to get winding_number() of its origin: the rim alone, stretched along `way` without end, tells. O(rim).
[[nodiscard]] int rim_winding(std::span<const RimEdge> rim, Vec3d point, Vec3d way);

}  // namespace fase::level
