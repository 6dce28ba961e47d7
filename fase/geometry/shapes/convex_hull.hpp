#pragma once
/// The convex polyhedron, with faces and edges for the narrow phase.
#include <cstdint>
#include <string_view>
#include <vector>

#include "fase/geometry/plane.hpp"
#include "fase/geometry/shape_description.hpp"

namespace fase {

/// A solid convex polyhedron, built by build_convex_hull() from points; immutable afterwards. Coplanar triangles are
/// merged into one face. Any hull has at least 4 vertices, 4 faces and a volume above 0.
struct ConvexHull {
    static constexpr std::string_view name = "convex_hull";
    static constexpr bool is_curved = false;
    /// One flat face with an outward plane; its corners are face_vertices[first, first + count), counter-clockwise
    /// seen from outside. Edge k of the face runs from corner k to corner k + 1.
    struct Face {
        Plane plane;
        std::uint32_t first = 0;
        std::uint32_t count = 0;
        friend bool operator==(const Face&, const Face&) = default;
    };
    /// One edge, listed once, with from < to (vertex indices) and its two faces.
    struct Edge {
        std::uint32_t from = 0, to = 0;
        std::uint32_t face_a = 0, face_b = 0;
        friend bool operator==(const Edge&, const Edge&) = default;
    };
    std::vector<Vec3> vertices;  ///< metres, in the frame of the shape
    std::vector<Face> faces;
    std::vector<std::uint32_t> face_vertices;
    std::vector<Edge> edges;
    friend bool operator==(const ConvexHull&, const ConvexHull&) = default;

    /// Returns the farthest vertex in `direction`, the first one among equals; O(vertices).
    template <class T> [[nodiscard]] Vec3Of<T> core_support(Vec3Of<T> direction) const {
        const Vec3 best = vertices[support_index(direction)];
        return {T(best.x), T(best.y), T(best.z)};
    }
    /// Returns the index of the vertex of core_support().
    template <class T> [[nodiscard]] std::uint32_t support_index(Vec3Of<T> direction) const {
        std::uint32_t best = 0;
        T farthest = 0;
        for (std::uint32_t i = 0; i < vertices.size(); ++i) {
            const Vec3 v = vertices[i];
            const T along = direction.x * T(v.x) + direction.y * T(v.y) + direction.z * T(v.z);
            if (i == 0 || along > farthest) {
                best = i;
                farthest = along;
            }
        }
        return best;
    }
    [[nodiscard]] constexpr float core_radius() const { return 0; }
};

namespace detail {  // defined in convex_hull.cpp and convex_hull_check.cpp; shape_functions.hpp describes them
[[nodiscard]] Aabb bounds_of(const ConvexHull& hull, const Pose& pose);
[[nodiscard]] float outer_radius_of(const ConvexHull& hull);
[[nodiscard]] float inner_radius_of(const ConvexHull& hull);
[[nodiscard]] Solid solid_of(const ConvexHull& hull, double density);
[[nodiscard]] TriangleMesh mesh_of(const ConvexHull& hull, int segments);
[[nodiscard]] Result<RotatedShape> image_of(const ConvexHull& hull, const LinearMap& map);
/// Returns an error that names the fault unless the hull is closed, convex and of volume above 0.
Result<void> check_of(const ConvexHull& hull);
}  // namespace detail

}  // namespace fase
