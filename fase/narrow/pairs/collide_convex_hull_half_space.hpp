#pragma once
/// A convex hull and a half-space.
#include "fase/geometry/shapes/convex_hull.hpp"
#include "fase/narrow/detail/polygon.hpp"
#include "fase/narrow/pairs/ground.hpp"

namespace fase::narrow {

/// The vertices within the margin; of more than 4, the deepest, the farthest from it and the farthest on both sides
/// (see choose_four()). The feature is the vertex. Cost: O(vertices).
[[nodiscard]] inline Manifold collide(const ConvexHull& a, const HalfSpace&, const LocalPose& b_in_a, float margin) {
    const Ground ground(b_in_a);
    Manifold manifold;
    manifold.normal = -ground.up;
    const Vec3 u_axis = any_perpendicular(ground.up), v_axis = cross(ground.up, u_axis);
    PlanarPoints near;
    const auto put_reduced = [&](std::uint32_t i, float height) {
        // A full buffer is reduced to the four best points so far.
        if (near.count == PlanarPoints::capacity) reduce_to_four(near, 0);
        near.put(dot(u_axis, a.vertices[i]), dot(v_axis, a.vertices[i]), height, i);
    };
    const auto size = static_cast<std::uint32_t>(a.vertices.size());
    for (std::uint32_t i = 0; i < size; ++i) {
        const float height = ground.height(a.vertices[i]);
        if (height <= margin) put_reduced(i, height);
    }
    if (near.count > 4) {
        float extent = 0;
        for (int i = 1; i < near.count; ++i) {
            const float du = std::fabs(near.u[i] - near.u[0]), dv = std::fabs(near.v[i] - near.v[0]);
            const float larger = du > dv ? du : dv;
            extent = larger > extent ? larger : extent;
        }
        reduce_to_four(near, 5e-5f * extent);
    }
    for (int i = 0; i < near.count; ++i) ground.add(manifold, a.vertices[near.feature[i]], near.feature[i], margin);
    return manifold;
}

}  // namespace fase::narrow
