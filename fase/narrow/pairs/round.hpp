#pragma once
/// Shared parts of the pairs with spheres and capsules: from the closest points of two cores to a contact.
#include <cmath>

#include "fase/math/pose.hpp"
#include "fase/narrow/manifold.hpp"

namespace fase::narrow {

/// The contact of a sphere of `radius_a` around `core_a` with one of `radius_b` around `core_b`; no point when their
/// separation is above `margin`. `normal_if_same` (unit): the normal when the cores coincide.
inline Manifold touch_round(Vec3 core_a, float radius_a, Vec3 core_b, float radius_b, float margin, Vec3 normal_if_same,
                            std::uint32_t feature) {
    const Vec3 between = core_b - core_a;
    const float squared = length_squared(between);
    const float reach = radius_a + radius_b + margin;
    Manifold manifold;
    if (!(squared <= reach * reach)) return manifold;
    // Below this the square has lost its digits.
    constexpr float min_squared = 1e-30f;
    const float distance = squared > min_squared ? std::sqrt(squared) : 0.f;
    manifold.normal = squared > min_squared ? between * (1 / distance) : normal_if_same;
    manifold.count = 1;
    manifold.points[0] = {core_a + manifold.normal * ((radius_a + distance - radius_b) * 0.5f),
                          distance - radius_a - radius_b, feature};
    return manifold;
}

/// A capsule's segment in the other shape's frame: centre + axis * t, |t| <= reach.
struct CapsuleSegment {
    Vec3 centre, axis;
    float reach;
    [[nodiscard]] Vec3 at(float t) const { return centre + axis * t; }
};

/// The height of a capsule's segment above a face: `height` at its centre, plus `climb` times t. `facing`: cosine of
/// the angle between the face's normal and the contact normal, which may differ a little.
struct SegmentHeight {
    float height, climb, facing;
    /// Projects the segment onto the plane of the face along the contact normal.
    [[nodiscard]] CapsuleSegment project(const CapsuleSegment& segment, Vec3 normal) const {
        return {segment.centre - normal * (height / facing), segment.axis - normal * (climb / facing), segment.reach};
    }
    /// Returns the distance from the face at `t` along the contact normal, at least `min_distance`, the distance of the
    /// closest points: the interval over the face may be a little too long.
    [[nodiscard]] float distance(float t, float min_distance) const {
        const float here = (height + climb * t) / facing;
        return here > min_distance ? here : min_distance;
    }
};

/// Replaces the one point of a capsule's contact by `lower` and `upper`, the ends of the interval over the other shape:
/// only if both are within `margin` and one of them is as deep as the point, to a thousandth of `radius`.
inline void use_both_ends(const ManifoldPoint& lower, const ManifoldPoint& upper, float margin, float radius,
                          Manifold& manifold) {
    const float deepest = lower.separation < upper.separation ? lower.separation : upper.separation;
    const bool holds_nearest = deepest <= manifold.points[0].separation + 1e-3f * radius;
    if (!(holds_nearest && lower.separation <= margin && upper.separation <= margin)) return;
    manifold.count = 2;
    manifold.points[0] = lower;
    manifold.points[1] = upper;
}

/// Returns the parameter of the point of segment `a` to `b` nearest to `point`: 0 at a, 1 at b. A segment of length 0
/// gives 0. Source: Ericson 2005, Real-Time Collision Detection, 5.1.2.
inline float nearest_fraction(Vec3 a, Vec3 b, Vec3 point) {
    const Vec3 along = b - a;
    const float squared = length_squared(along);
    if (!(squared > 0)) return 0;
    const float fraction = dot(point - a, along) / squared;
    return fraction < 0 ? 0.f : fraction > 1 ? 1.f : fraction;
}

/// Clamps x to [-limit, limit].
constexpr float clamp_to(float x, float limit) { return x < -limit ? -limit : x > limit ? limit : x; }

}  // namespace fase::narrow
