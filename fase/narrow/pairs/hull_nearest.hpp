#pragma once
/// The point of a convex hull nearest to a point outside it.
#include <cmath>

#include "fase/narrow/pairs/hull_view.hpp"
#include "fase/narrow/pairs/round.hpp"

namespace fase::narrow {

/// What is nearest to a point. `out` is unit and points away from the hull.
struct NearestOnHull {
    Vec3 at, out;
    float distance = 1e30f;
    std::uint32_t feature = 0;  ///< bits 0–1: 0 face, 1 edge (by the vertex it starts from), 2 vertex; then its index
};

/// The point of a face nearest to `point`, which is `height` above its plane; `noise`: distances below it are no
/// direction.
inline NearestOnHull nearest_on_face(const HullView& hull, std::uint32_t face_index, Vec3 point, float height,
                                     float noise) {
    const ConvexHull::Face& face = hull.faces[face_index];
    const Vec3 normal = face.plane.normal;
    NearestOnHull best;
    float least = 1e30f;
    bool over = true;
    Vec3 from = hull.vertices[hull.corner(face, 0)];
    for (std::uint32_t k = 0; k < face.count; ++k) {
        const Vec3 to = hull.vertices[hull.corner(face, k + 1)], along = to - from;
        if (dot(cross(along, normal), point - from) > 0) {
            over = false;
            const float t = nearest_fraction(from, to, point);
            const Vec3 at = from + along * t;
            const float squared = length_squared(point - at);
            if (squared < least) {
                least = squared;
                best.at = at;
                best.feature = t <= 0   ? 2u | hull.corner(face, k) << 2
                               : t >= 1 ? 2u | hull.corner(face, k + 1) << 2
                                        : 1u | hull.corner(face, k) << 2;
            }
        }
        from = to;
    }
    if (over) return {point - normal * height, normal, height, face_index << 2};
    best.distance = std::sqrt(least);
    best.out = best.distance > noise ? (point - best.at) * (1 / best.distance) : normal;
    return best;
}

/// The point of the hull nearest to `point`, which is outside; `face` keeps it farthest away, by `height`. Cost: one
/// face, then a look at all vertices, which nearly always shows that nothing is nearer.
inline NearestOnHull nearest_on_hull(const HullView& hull, Vec3 point, std::uint32_t face, float height, float noise) {
    NearestOnHull best = nearest_on_face(hull, face, point, height, noise);
    if ((best.feature & 3u) == 0) return best;
    float beyond = 0;
    const float at = dot(best.out, best.at);
    for (std::uint32_t i = 0; i < hull.vertex_count; ++i) {
        const float more = dot(best.out, hull.vertices[i]) - at;
        beyond = more > beyond ? more : beyond;
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
