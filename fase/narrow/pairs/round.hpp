#pragma once
/// What the pairs with a rounded shape share: from the nearest points of two cores to a contact.
#include <cmath>

#include "fase/math/pose.hpp"
#include "fase/narrow/manifold.hpp"

namespace fase::narrow {

/// The contact of a ball of `radius_a` around `core_a` with one of `radius_b` around `core_b`: no point when their
/// separation is not below or at `margin`. `normal_if_same` (unit): the normal when the cores coincide.
inline Manifold touch_round(Vec3 core_a, float radius_a, Vec3 core_b, float radius_b, float margin, Vec3 normal_if_same,
                            std::uint32_t feature) {
    const Vec3 between = core_b - core_a;
    const float squared = length_squared(between);
    const float reach = radius_a + radius_b + margin;
    Manifold manifold;
    if (!(squared <= reach * reach)) return manifold;
    // Below this the square has lost its digits.
    constexpr float seen = 1e-30f;
    const float distance = squared > seen ? std::sqrt(squared) : 0.f;
    manifold.normal = squared > seen ? between * (1 / distance) : normal_if_same;
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

/// How far along the segment from `a` to `b` its nearest point to `point` lies: 0 at a, 1 at b. A segment of length 0
/// answers 0. Source: Ericson 2005, Real-Time Collision Detection, 5.1.2.
inline float nearest_fraction(Vec3 a, Vec3 b, Vec3 point) {
    const Vec3 along = b - a;
    const float squared = length_squared(along);
    if (!(squared > 0)) return 0;
    const float at = dot(point - a, along) / squared;
    return at < 0 ? 0.f : at > 1 ? 1.f : at;
}

/// x held to [-limit, limit].
constexpr float clamp_to(float x, float limit) { return x < -limit ? -limit : x > limit ? limit : x; }

}  // namespace fase::narrow
