#pragma once
/// Axis-aligned boxes in float.
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>

#include "fase/math/pose.hpp"

namespace fase {

/// Axis-aligned bounding box, closed: touching boxes overlap. Default: empty, overlaps only boxes that are infinite on
/// all axes. May be infinite.
struct Aabb {
    static constexpr float infinity = std::numeric_limits<float>::infinity();
    Vec3 lo{infinity, infinity, infinity};
    Vec3 hi{-infinity, -infinity, -infinity};
    friend constexpr bool operator==(const Aabb&, const Aabb&) = default;
    /// The box that contains all points.
    static constexpr Aabb everything() { return {{-infinity, -infinity, -infinity}, {infinity, infinity, infinity}}; }
};

/// Whether the boxes share a point; touching counts. False for a NaN.
constexpr bool overlaps(const Aabb& a, const Aabb& b) {
    return a.lo.x <= b.hi.x && b.lo.x <= a.hi.x && a.lo.y <= b.hi.y && b.lo.y <= a.hi.y && a.lo.z <= b.hi.z &&
           b.lo.z <= a.hi.z;
}
/// The same without branches, for loops with unpredictable results.
constexpr bool overlaps_branchless(const Aabb& a, const Aabb& b) {
    return (int(a.lo.x <= b.hi.x) & int(b.lo.x <= a.hi.x) & int(a.lo.y <= b.hi.y) & int(b.lo.y <= a.hi.y) &
            int(a.lo.z <= b.hi.z) & int(b.lo.z <= a.hi.z)) != 0;
}
/// Returns the smallest box that contains both.
constexpr Aabb merge(const Aabb& a, const Aabb& b) { return {min(a.lo, b.lo), max(a.hi, b.hi)}; }
/// Whether `inner` is inside `outer`; borders may touch. False for a NaN.
constexpr bool contains(const Aabb& outer, const Aabb& inner) {
    return outer.lo.x <= inner.lo.x && outer.lo.y <= inner.lo.y && outer.lo.z <= inner.lo.z &&
           inner.hi.x <= outer.hi.x && inner.hi.y <= outer.hi.y && inner.hi.z <= outer.hi.z;
}
/// Whether the point is inside the box or on its border.
constexpr bool contains(const Aabb& box, Vec3 p) { return contains(box, Aabb{p, p}); }
/// Whether the box contains no point: some lo is above its hi, or is a NaN.
constexpr bool is_empty(const Aabb& a) { return !(a.lo.x <= a.hi.x && a.lo.y <= a.hi.y && a.lo.z <= a.hi.z); }
/// Returns the centre of a finite box; NaN on axes that are infinite in both directions.
constexpr Vec3 centre(const Aabb& a) { return (a.lo + a.hi) * 0.5f; }
/// Returns the side lengths in metres; negative where the box is inverted.
constexpr Vec3 extent(const Aabb& a) { return a.hi - a.lo; }
/// Returns the longest side in metres. Arbitrary when a side is a NaN.
constexpr float longest_side(const Aabb& a) {
    const Vec3 e = extent(a);
    const float xy = e.x < e.y ? e.y : e.x;
    return xy < e.z ? e.z : xy;
}
/// Returns the area of all six sides, in square metres. The box must not be inverted.
constexpr float surface_area(const Aabb& a) {
    const Vec3 e = extent(a);
    return 2 * (e.x * e.y + e.y * e.z + e.z * e.x);
}
/// Returns the box enlarged by `margin` metres on every side.
constexpr Aabb enlarged(const Aabb& a, float margin) {
    const Vec3 m{margin, margin, margin};
    return {a.lo - m, a.hi + m};
}
/// Converts a double box to float, rounded outward: the result contains the double box. Branchless, because branches
/// would be unpredictable: adding 1 to the bits gives the next float away from 0 (a value that rounds to 0 keeps its
/// sign).
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
