#pragma once
/// Axis-aligned boxes in float.
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "fase/math/pose.hpp"

namespace fase {

/// Axis-aligned box, closed at both ends: touching boxes overlap. Default: empty, overlaps nothing but endless boxes.
/// May be infinite.
struct Aabb {
    static constexpr float infinity = std::numeric_limits<float>::infinity();
    Vec3 lo{infinity, infinity, infinity};
    Vec3 hi{-infinity, -infinity, -infinity};
    friend constexpr bool operator==(const Aabb&, const Aabb&) = default;
    /// The box that holds everything.
    static constexpr Aabb everything() { return {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}}; }
};

/// Whether they have a point in common; a border is enough. False for a NaN.
constexpr bool overlaps(const Aabb& a, const Aabb& b) {
    return a.lo.x <= b.hi.x && b.lo.x <= a.hi.x && a.lo.y <= b.hi.y && b.lo.y <= a.hi.y && a.lo.z <= b.hi.z &&
           b.lo.z <= a.hi.z;
}
/// The same without branches: for loops in which the answer cannot be predicted.
constexpr bool overlaps_branchless(const Aabb& a, const Aabb& b) {
    return (int(a.lo.x <= b.hi.x) & int(b.lo.x <= a.hi.x) & int(a.lo.y <= b.hi.y) & int(b.lo.y <= a.hi.y) &
            int(a.lo.z <= b.hi.z) & int(b.lo.z <= a.hi.z)) != 0;
}
/// The smallest box that holds both.
constexpr Aabb merge(const Aabb& a, const Aabb& b) { return {min(a.lo, b.lo), max(a.hi, b.hi)}; }
/// Whether no point of `inner` lies outside of `outer`; borders may touch. False for a NaN.
constexpr bool contains(const Aabb& outer, const Aabb& inner) {
    return outer.lo.x <= inner.lo.x && outer.lo.y <= inner.lo.y && outer.lo.z <= inner.lo.z &&
           inner.hi.x <= outer.hi.x && inner.hi.y <= outer.hi.y && inner.hi.z <= outer.hi.z;
}
/// Whether the point lies in the box or on its border.
constexpr bool contains(const Aabb& box, Vec3 p) { return contains(box, Aabb{p, p}); }
/// No point inside: some lo above its hi, or a NaN.
constexpr bool is_empty(const Aabb& a) { return !(a.lo.x <= a.hi.x && a.lo.y <= a.hi.y && a.lo.z <= a.hi.z); }
/// Middle of a finite box; NaN on axes that are infinite both ways.
constexpr Vec3 centre(const Aabb& a) { return (a.lo + a.hi) * 0.5f; }
/// Lengths of its sides, metres; negative where it is inverted.
constexpr Vec3 extent(const Aabb& a) { return a.hi - a.lo; }
/// Of all six sides, square metres; of a box that is not inverted.
constexpr float surface_area(const Aabb& a) {
    const Vec3 e = extent(a);
    return 2 * (e.x * e.y + e.y * e.z + e.z * e.x);
}
/// Grown by `margin` metres on every side.
constexpr Aabb grown(const Aabb& a, float margin) {
    const Vec3 m{margin, margin, margin};
    return {a.lo - m, a.hi + m};
}
/// Float box of a double one, rounded outward: never smaller than what it stands for. Without branches, which could not
/// be foreseen: a step of the bits is a step to the next float, away from 0 (what rounds to 0 keeps its sign).
constexpr Aabb rounded_outward(Vec3d lo, Vec3d hi) {
    const auto stepped = [](float f, bool outward, std::uint32_t away_when) {
        const auto bits = std::bit_cast<std::uint32_t>(f);
        const std::uint32_t step = outward ? 1 : 0;
        return std::bit_cast<float>((bits >> 31) == away_when ? bits + step : bits - step);
    };
    const auto down = [&](double v) {
        const float f = static_cast<float>(v);
        return stepped(f, f > v, 1);
    };
    const auto up = [&](double v) {
        const float f = static_cast<float>(v);
        return stepped(f, f < v, 0);
    };
    return {{down(lo.x), down(lo.y), down(lo.z)}, {up(hi.x), up(hi.y), up(hi.z)}};
}

}  // namespace fase
