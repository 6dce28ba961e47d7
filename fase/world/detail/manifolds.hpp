#pragma once
/// Manifolds from step to step: reuse, and the impulses of points that were there before.
#include <span>

#include "fase/dynamics/solver/bodies.hpp"
#include "fase/dynamics/solver/contact.hpp"
#include "fase/math/mat3.hpp"
#include "fase/narrow/manifold.hpp"

namespace fase {

/// How a body rotated since the manifolds of a contact were computed.
struct RotationSince {
    Quat rotation;
    Mat3 change;  ///< R - 1 for the rotation R

    RotationSince() = default;
    RotationSince(Quat now, Quat then);
    /// Returns the square of the sine of half the angle by which the axis tilted.
    [[nodiscard]] float tilt(Vec3 axis) const {
        const Vec3 v = rotation.vector();
        return length_squared(v - axis * dot(axis, v));
    }
    /// Returns the part of the rotation that is about the axis.
    [[nodiscard]] Quat twist(Vec3 axis) const {
        const Vec3 v = axis * dot(axis, rotation.vector());
        return normalized(Quat{v.x, v.y, v.z, rotation.w});
    }
    /// Returns where a point of the body is now, from its place then.
    [[nodiscard]] Vec3 turned(Vec3 then) const { return then + change * then; }
};

/// How both bodies of a contact moved since its manifolds were computed.
struct PairMotion {
    RotationSince a, b;
    Vec3 moved;  ///< of b from a, metres

    PairMotion() = default;
    PairMotion(const dynamics::Contact& contact, const dynamics::BodyMotion& a, const dynamics::BodyMotion& b);
};

/// Moves the manifolds of a contact with its bodies. Returns false when they must be computed again: a point moved by
/// `distance` or more between the bodies, or a body tilted by more than about two degrees. The manifolds are then
/// partly moved.
[[nodiscard]] bool reuse_manifolds(dynamics::Contact& contact, std::span<dynamics::ContactManifold> manifolds,
                                   const PairMotion& motion, float distance);

/// A manifold in world axes: offsets of its centre from the two centres of mass, and the points relative to the centre.
struct WorldManifold {
    int count = 0;
    Vec3 normal, offset_a, offset_b;
    Vec3 points[4];
    float separation[4] = {};
    std::uint32_t feature[4] = {};
};

/// Stores the manifold of two convex shapes in their contact. Its points take over the impulses of old points near by.
/// `motion`: since the old points; not read when there are none.
void store_manifold(dynamics::Contact& contact, dynamics::ContactManifold& manifold, const WorldManifold& world,
                    const dynamics::BodyMotion& a, const dynamics::BodyMotion& b, const PairMotion& motion,
                    float match_distance);

}  // namespace fase
