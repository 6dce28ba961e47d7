#pragma once
/// The contact of any two shapes, by GJK, SAT or EPA and clipping: for pairs without a special function, and the
/// reference (oracle) for the special functions.
#include "fase/math/pose.hpp"
#include "fase/narrow/detail/core_view.hpp"
#include "fase/narrow/manifold.hpp"

namespace fase::narrow {

/// Returns the contact of two convex shapes. Frames, margin and result as in collide(). The normal is that of the
/// closest points while the cores are apart, and that of minimum penetration when they overlap; faces are preferred to
/// edges unless those are better by a ten-thousandth of the shapes' size. Separations are along the normal. Feature
/// ids: bit 31: the reference face is b's; bit 30: a single point or two parallel edges; else 2 × 15 bits for the two
/// features. Deterministic, thread-safe, allocates nothing.
[[nodiscard]] Manifold collide_cores(const CoreView& a, const CoreView& b, const LocalPose& b_in_a, float margin);

/// Returns the contact of a half-space (a) with a convex shape (b): the corners of b's lowest feature.
[[nodiscard]] Manifold collide_with_half_space(const CoreView& b, const LocalPose& b_in_a, float margin);

/// Converts the manifold of (b, a) to that of (a, b).
[[nodiscard]] inline Manifold flipped(Manifold manifold, const LocalPose& b_in_a) {
    manifold.normal = -rotate(b_in_a.rotation, manifold.normal);
    for (int i = 0; i < manifold.count; ++i) {
        ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
        point.position = transform(b_in_a, point.position);
    }
    return manifold;
}

/// Returns the contact of two shapes of known kinds. A half-space may be either shape; two half-spaces never touch.
template <NamedShape A, NamedShape B>
[[nodiscard]] Manifold collide_general(const A& a, const B& b, const LocalPose& b_in_a, float margin) {
    if constexpr (ConvexShape<A> && ConvexShape<B>) {
        return collide_cores(core_view(a), core_view(b), b_in_a, margin);
    } else if constexpr (ConvexShape<B>) {
        return collide_with_half_space(core_view(b), b_in_a, margin);
    } else if constexpr (ConvexShape<A>) {
        return flipped(collide_with_half_space(core_view(a), inverse(b_in_a), margin), b_in_a);
    } else {
        return {};
    }
}

/// The general path for shapes of kinds known only at run time.
[[nodiscard]] inline Manifold collide_general(const Shape& a, const Shape& b, const LocalPose& b_in_a, float margin) {
    return std::visit([&](const auto& s, const auto& t) { return collide_general(s, t, b_in_a, margin); }, a, b);
}

}  // namespace fase::narrow
