#pragma once
/// A sphere and a convex hull.
#include "fase/geometry/shapes/sphere.hpp"
#include "fase/math/pose.hpp"
#include "fase/narrow/manifold.hpp"
#include "fase/narrow/pairs/hull_nearest.hpp"

namespace fase::narrow {

/// One point. A centre inside the hull is pushed out of the nearest face. The feature is the face, edge or vertex.
[[nodiscard]] inline Manifold collide(const Sphere& a, const ConvexHull& b, const LocalPose& b_in_a, float margin) {
    const HullView hull(b);
    const Vec3 centre = rotate_back(b_in_a.rotation, -b_in_a.position);
    const float reach = a.radius + margin;
    std::uint32_t face = 0;
    float height = -1e30f;
    for (std::uint32_t i = 0; i < hull.face_count; ++i) {
        const float here = signed_distance(hull.faces[i].plane, centre);
        if (!(here <= reach)) return {};
        face = here > height ? i : face;
        height = here > height ? here : height;
    }
    const Vec3 size = abs(centre) + abs(hull.vertices[0]);
    const float noise = 4e-7f * (size.x + size.y + size.z);
    NearestOnHull nearest;
    if (height > noise) {
        nearest = nearest_on_hull(hull, centre, face, height, noise);
        if (!(nearest.distance <= reach)) return {};
    } else {
        nearest = {centre, hull.faces[face].plane.normal, height, face << 2};
    }
    Manifold manifold;
    manifold.normal = rotate(b_in_a.rotation, -nearest.normal);
    manifold.count = 1;
    manifold.points[0] = {manifold.normal * ((a.radius + nearest.distance) * 0.5f), nearest.distance - a.radius,
                          nearest.feature};
    return manifold;
}

}  // namespace fase::narrow
