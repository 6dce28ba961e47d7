#pragma once
/// The point of a convex hull nearest to a point outside it.
#include <cmath>

#include "fase/narrow/pairs/hull_view.hpp"
#include "fase/narrow/pairs/round.hpp"

namespace fase::narrow {

/// The nearest point of a hull. `normal` is unit and points away from the hull.
struct NearestOnHull {
    Vec3 point, normal;
    float distance = 1e30f;
    std::uint32_t feature = 0;  ///< bits 0–1: 0 face, 1 edge (by the vertex it starts from), 2 vertex; then its index
};

/// Returns the point of a face nearest to `point`, which is `height` above its plane. A vector shorter than `noise`
/// gives no direction: the face's normal is used then.
inline NearestOnHull nearest_on_face(const HullView& hull, std::uint32_t face_index, Vec3 point, float height,
                                     float noise) {
    const ConvexHull::Face& face = hull.faces[face_index];
    const Vec3 normal = face.plane.normal;
    NearestOnHull best;
    float min_squared = 1e30f;
    bool over = true;
    Vec3 from = hull.vertices[hull.corner(face, 0)];
    for (std::uint32_t k = 0; k < face.count; ++k) {
        const Vec3 to = hull.vertices[hull.corner(face, k + 1)], along = to - from;
        if (dot(cross(along, normal), point - from) > 0) {
            over = false;
            const float t = nearest_fraction(from, to, point);
            const Vec3 on_edge = from + along * t;
            const float squared = length_squared(point - on_edge);
            if (squared < min_squared) {
                min_squared = squared;
                best.point = on_edge;
                best.feature = t <= 0   ? 2u | hull.corner(face, k) << 2
                               : t >= 1 ? 2u | hull.corner(face, k + 1) << 2
                                        : 1u | hull.corner(face, k) << 2;
            }
        }
        from = to;
    }
    if (over) return {point - normal * height, normal, height, face_index << 2};
    best.distance = std::sqrt(min_squared);
    best.normal = best.distance > noise ? (point - best.point) * (1 / best.distance) : normal;
    return best;
}

/// Returns the point of the hull nearest to `point`, which is outside; `face` has the maximum distance from it,
/// `height`. Cost: one face, then a test of all vertices, which nearly always proves that no other face is nearer.
inline NearestOnHull nearest_on_hull(const HullView& hull, Vec3 point, std::uint32_t face, float height, float noise) {
    NearestOnHull best = nearest_on_face(hull, face, point, height, noise);
    if ((best.feature & 3u) == 0) return best;
    float beyond = 0;
    const float level = dot(best.normal, best.point);
    for (std::uint32_t i = 0; i < hull.vertex_count; ++i) {
        const float height_of_vertex = dot(best.normal, hull.vertices[i]) - level;
        beyond = height_of_vertex > beyond ? height_of_vertex : beyond;
    }
    if (beyond <= noise) return best;
    for (std::uint32_t i = 0; i < hull.face_count; ++i) {
        const float here = signed_distance(hull.faces[i].plane, point);
        if (i == face || !(here > 0 && here < best.distance)) continue;
        const NearestOnHull other = nearest_on_face(hull, i, point, here, noise);
        if (other.distance < best.distance) best = other;
    }
    return best;
}

}  // namespace fase::narrow
