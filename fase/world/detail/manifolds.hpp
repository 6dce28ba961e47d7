#pragma once
/// Manifolds from step to step: reuse, and the impulses of points that were there before.
#include <span>

#include "fase/dynamics/solver/bodies.hpp"
#include "fase/dynamics/solver/contact.hpp"
#include "fase/math/mat3.hpp"
#include "fase/narrow/manifold.hpp"

namespace fase {

/// How a body rotated since the manifolds of a contact were computed. T: float, or a vector of floats for as many
/// bodies.
template <class T> struct RotationSinceOf {
    QuatOf<T> rotation;
    Mat3Of<T> change;  ///< R - 1 for the rotation R

    RotationSinceOf() = default;
    RotationSinceOf(QuatOf<T> now, QuatOf<T> then) : rotation(now * conjugate(then)) {
        const auto [x, y, z, w] = rotation;
        const T xx = x * x, yy = y * y, zz = z * z;
        change = {Vec3Of<T>{-yy - zz, x * y + w * z, x * z - w * y} * T(2),
                  Vec3Of<T>{x * y - w * z, -xx - zz, y * z + w * x} * T(2),
                  Vec3Of<T>{x * z + w * y, y * z - w * x, -xx - yy} * T(2)};
    }
    /// Returns the square of the sine of half the angle by which the axis tilted.
    [[nodiscard]] T tilt(Vec3Of<T> axis) const {
        const Vec3Of<T> v = rotation.vector();
        return length_squared(v - axis * dot(axis, v));
    }
    /// Returns where a point of the body is now, from its place then.
    [[nodiscard]] Vec3Of<T> turned(Vec3Of<T> then) const { return then + change * then; }
};

/// How both bodies of a contact moved since its manifolds were computed.
template <class T> struct PairMotionOf {
    RotationSinceOf<T> a, b;
    Vec3Of<T> moved;  ///< of b from a, metres
};
using PairMotion = PairMotionOf<float>;

[[nodiscard]] PairMotion pair_motion(const dynamics::Contact& contact, const dynamics::BodyMotion& a,
                                     const dynamics::BodyMotion& b);

/// The number of contacts that reuse_four() takes.
inline constexpr int reused_together = 4;

/// A contact to reuse, and what moves it.
struct ReuseInput {
    dynamics::Contact* contact = nullptr;
    dynamics::ContactManifold* manifold = nullptr;  ///< the first
    const dynamics::BodyMotion *a = nullptr, *b = nullptr;
    float distance = 0;  ///< metres that a point may move between the bodies
};

/// Moves the manifolds of a contact with its bodies. Returns false when they must be computed again: a point moved by
/// ReuseInput::distance or more between the bodies, or a body tilted by more than about two degrees. The manifolds are
/// then partly moved.
[[nodiscard]] bool reuse_manifolds(const ReuseInput& input);
/// The same for four contacts of one manifold each, with the same bits. Returns a bit for each that is reused.
[[nodiscard]] unsigned reuse_four(const ReuseInput (&inputs)[reused_together]);

/// A manifold in world axes: offsets of its centre from the two centres of mass, and the points relative to the centre.
struct WorldManifold {
    int count = 0;
    Vec3 normal, offset_a, offset_b;
    Vec3 points[4];
    float separation[4] = {};
    std::uint32_t feature[4] = {};
};

/// Returns the points of a manifold relative to their centre, which `centre` receives in the manifold's frame.
/// `to_world(v)` rotates from that frame to world axes. Normal and offsets are left to the caller.
template <class F>
[[nodiscard]] WorldManifold around_centre(const narrow::Manifold& manifold, const F& to_world, Vec3& centre) {
    WorldManifold world;
    world.count = manifold.count;
    if (manifold.count == 0) return world;
    for (int i = 0; i < manifold.count; ++i) centre += manifold.points[static_cast<std::size_t>(i)].position;
    centre *= 1.0f / static_cast<float>(manifold.count);
    for (int i = 0; i < manifold.count; ++i) {
        const narrow::ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
        world.points[i] = to_world(point.position - centre);
        world.separation[i] = point.separation;
        world.feature[i] = point.feature;
    }
    return world;
}

/// Stores the manifold of two convex shapes in their contact. Its points take over the impulses of old points near by;
/// a single point those of a single point anywhere.
void store_manifold(dynamics::Contact& contact, dynamics::ContactManifold& manifold, const WorldManifold& world,
                    const dynamics::BodyMotion& a, const dynamics::BodyMotion& b, float match_distance);

/// A manifold in world axes and the key that names it in its contact.
struct KeyedManifold : WorldManifold {
    dynamics::ManifoldKey key;
};

/// Stores all manifolds of a contact; there are as many places or more. Each takes over impulses from the old one with
/// the same key, or else from the one with the most similar normal. Their materials are then to be set.
void store_manifolds(dynamics::Contact& contact, std::span<dynamics::ContactManifold> places,
                     std::span<const KeyedManifold> worlds, const dynamics::BodyMotion& a,
                     const dynamics::BodyMotion& b, float match_distance);

}  // namespace fase
