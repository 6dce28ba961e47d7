#pragma once
/// A non-owning view of a polyhedron, so that the pairs with hulls also accept a box.
#include <array>
#include <cstdint>

#include "fase/geometry/shapes/box.hpp"
#include "fase/geometry/shapes/convex_hull.hpp"
#include "fase/math/mat3.hpp"

namespace fase::narrow {

/// Refers to a hull or a BoxAsHull, which must outlive it.
struct HullView {
    const Vec3* vertices;
    const ConvexHull::Face* faces;
    const std::uint32_t* face_vertices;
    const ConvexHull::Edge* edges;
    std::uint32_t vertex_count, face_count, edge_count;

    explicit HullView(const ConvexHull& hull)
        : vertices(hull.vertices.data()),
          faces(hull.faces.data()),
          face_vertices(hull.face_vertices.data()),
          edges(hull.edges.data()),
          vertex_count(static_cast<std::uint32_t>(hull.vertices.size())),
          face_count(static_cast<std::uint32_t>(hull.faces.size())),
          edge_count(static_cast<std::uint32_t>(hull.edges.size())) {}
    HullView() = default;

    /// Returns the index of the farthest vertex in `direction`, the first among equals.
    [[nodiscard]] std::uint32_t support(Vec3 direction) const {
        std::uint32_t best = 0;
        float farthest = dot(direction, vertices[0]);
        for (std::uint32_t i = 1; i < vertex_count; ++i) {
            // Conditional moves: a branch per vertex would be mispredicted too often.
            const float along = dot(direction, vertices[i]);
            best = along > farthest ? i : best;
            farthest = along > farthest ? along : farthest;
        }
        return best;
    }
    /// Returns an interior point: the mean of some vertices.
    [[nodiscard]] Vec3 middle() const {
        const std::uint32_t step = vertex_count > 8 ? vertex_count / 8 : 1;
        Vec3 sum;
        float count = 0;
        for (std::uint32_t i = 0; i < vertex_count; i += step, count += 1) sum += vertices[i];
        return sum * (1 / count);
    }
    /// Returns the face whose normal has the largest component along `direction`, the first among equals.
    [[nodiscard]] std::uint32_t face_towards(Vec3 direction) const {
        std::uint32_t best = 0;
        float max_along = dot(direction, faces[0].plane.normal);
        for (std::uint32_t i = 1; i < face_count; ++i) {
            const float along = dot(direction, faces[i].plane.normal);
            best = along > max_along ? i : best;
            max_along = along > max_along ? along : max_along;
        }
        return best;
    }
    /// Returns the face whose plane is farthest below `point`, the first among equals.
    [[nodiscard]] std::uint32_t face_under(Vec3 point) const {
        std::uint32_t best = 0;
        float max_height = signed_distance(faces[0].plane, point);
        for (std::uint32_t i = 1; i < face_count; ++i) {
            const float height = signed_distance(faces[i].plane, point);
            best = height > max_height ? i : best;
            max_height = height > max_height ? height : max_height;
        }
        return best;
    }
    /// Returns the vertex index of the face's corner k; k == count wraps to the first corner.
    [[nodiscard]] std::uint32_t corner(const ConvexHull::Face& face, std::uint32_t k) const {
        return face_vertices[face.first + (k < face.count ? k : k - face.count)];
    }
};

/// A box in the representation of a hull. Vertex numbers: bits 0, 1, 2 for +x, +y, +z. Faces: -x, +x, -y …
class BoxAsHull {
public:
    explicit BoxAsHull(const Box& box) {
        for (std::uint32_t i = 0; i < 8; ++i) {
            vertices_[i] = {i & 1u ? box.half.x : -box.half.x, i & 2u ? box.half.y : -box.half.y,
                            i & 4u ? box.half.z : -box.half.z};
        }
        for (std::uint32_t i = 0; i < 6; ++i) {
            const int axis = static_cast<int>(i / 2);
            Vec3 normal;
            normal[axis] = i % 2 == 0 ? -1.f : 1.f;
            faces_[i] = {{normal, box.half[axis]}, 4 * i, 4};
        }
    }
    [[nodiscard]] HullView view() const {
        HullView view;
        view.vertices = vertices_.data();
        view.faces = faces_.data();
        view.face_vertices = corners.data();
        view.edges = edges.data();
        view.vertex_count = 8;
        view.face_count = 6;
        view.edge_count = 12;
        return view;
    }

private:
    static constexpr std::array<std::uint32_t, 24> corners = {0, 4, 6, 2, 1, 3, 7, 5, 0, 1, 5, 4,
                                                              2, 6, 7, 3, 0, 2, 3, 1, 4, 5, 7, 6};
    static constexpr std::array<ConvexHull::Edge, 12> edges = {{{0, 1, 2, 4},
                                                                {2, 3, 3, 4},
                                                                {4, 5, 2, 5},
                                                                {6, 7, 3, 5},
                                                                {0, 2, 0, 4},
                                                                {1, 3, 1, 4},
                                                                {4, 6, 0, 5},
                                                                {5, 7, 1, 5},
                                                                {0, 4, 0, 2},
                                                                {1, 5, 1, 2},
                                                                {2, 6, 0, 3},
                                                                {3, 7, 1, 3}}};
    std::array<Vec3, 8> vertices_;
    std::array<ConvexHull::Face, 6> faces_;
};

}  // namespace fase::narrow
