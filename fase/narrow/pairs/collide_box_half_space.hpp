#pragma once
/// A box and a half-space.
#include "fase/geometry/shapes/box.hpp"
#include "fase/narrow/pairs/ground.hpp"

namespace fase::narrow {

/// The corners of the lowest face that are within the margin: 4 when the box lies flat, 2 on an edge, 1 on a corner.
/// The feature is the corner: bits 0, 1, 2 for +x, +y, +z.
[[nodiscard]] inline Manifold collide(const Box& a, const HalfSpace&, const LocalPose& b_in_a, float margin) {
    const Ground ground(b_in_a);
    Manifold manifold;
    manifold.normal = -ground.up;
    const Vec3 steep = abs(ground.up);
    const int axis = steep.y > steep.x ? (steep.z > steep.y ? 2 : 1) : (steep.z > steep.x ? 2 : 0);
    const int u = axis == 2 ? 0 : axis + 1, v = u == 2 ? 0 : u + 1;
    const std::uint32_t face = ground.up[axis] < 0 ? 1u << axis : 0u;
    for (std::uint32_t k = 0; k < 4; ++k) {
        const std::uint32_t corner = face | (k & 1u) << u | (k >> 1) << v;
        const Vec3 point = {corner & 1u ? a.half.x : -a.half.x, corner & 2u ? a.half.y : -a.half.y,
                            corner & 4u ? a.half.z : -a.half.z};
        ground.add(manifold, point, corner, margin);
    }
    return manifold;
}

}  // namespace fase::narrow
