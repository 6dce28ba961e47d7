#pragma once
/// Shared part of the pairs with a half-space: its plane in the other shape's frame, and contact points on it.
#include "fase/geometry/shapes/half_space.hpp"
#include "fase/math/pose.hpp"
#include "fase/narrow/manifold.hpp"

namespace fase::narrow {

/// The surface of a half-space in the other shape's frame.
struct Ground {
    Vec3 up;      ///< unit, out of the ground
    float level;  ///< dot(up, p) == level on the surface

    explicit Ground(const LocalPose& ground_in_a)
        : up(rotate(ground_in_a.rotation, Vec3{0, 1, 0})), level(dot(up, ground_in_a.position)) {}
    [[nodiscard]] float height(Vec3 point) const { return dot(up, point) - level; }
    /// Adds a point of the shape to the manifold when its height is at most `margin`; the manifold must not be full.
    void add(Manifold& manifold, Vec3 point, std::uint32_t feature, float margin) const {
        const float above = height(point);
        if (!(above <= margin)) return;
        manifold.points[manifold.count++] = {point - up * (above * 0.5f), above, feature};
    }
};

}  // namespace fase::narrow
