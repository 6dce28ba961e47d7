#pragma once
/// The convex polyhedron, with the faces and edges that the narrow phase reads.
#include <cstdint>
#include <string_view>
#include <vector>

#include "fase/geometry/plane.hpp"

namespace fase {

/// A solid convex polyhedron, made by build_convex_hull() from points; immutable afterwards. Coplanar triangles are
/// merged into one face. Any hull has at least 4 vertices, 4 faces and a volume above 0.
struct ConvexHull {
    static constexpr std::string_view name = "convex_hull";
    /// One flat face: its plane looks outward; its corners are face_vertices[first, first + count), counter-clockwise
    /// seen from outside. Edge k of the face runs from corner k to corner k + 1.
    struct Face {
        Plane plane;
        std::uint32_t first = 0;
        std::uint32_t count = 0;
        friend bool operator==(const Face&, const Face&) = default;
    };
    /// One edge, each once: from < to (vertex indices); the two faces that meet there.
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

    /// Farthest vertex in `direction`: the first of the farthest, O(vertices).
    template <class T> [[nodiscard]] Vec3Of<T> core_support(Vec3Of<T> direction) const {
        const Vec3 best = vertices[support_index(direction)];
        return {T(best.x), T(best.y), T(best.z)};
    }
    /// Index of core_support()'s vertex.
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

}  // namespace fase
