#pragma once
/// Interpolation of places, rotations and poses, for drawing between two steps. `t` = 0 gives a, 1 gives b.
#include <algorithm>
#include <cmath>

#include "fase/math/pose.hpp"

namespace fase {

/// Returns the point that lies at `t` on the way from a to b. Values of t outside 0 to 1 extrapolate.
template <class T> constexpr Vec3Of<T> lerp(Vec3Of<T> a, Vec3Of<T> b, T t) { return a + (b - a) * t; }

/// Returns the rotation at `t` from a to b along the shorter way: normalised linear interpolation. Fast, and exact at
/// both ends; in between its speed varies by 1 % for rotations 60 degrees apart. Both must be unit.
template <class T> QuatOf<T> nlerp(QuatOf<T> a, QuatOf<T> b, T t) {
    const T sign = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w < 0 ? T(-1) : T(1);
    const T s = 1 - t, u = t * sign;
    return normalized(QuatOf<T>{a.x * s + b.x * u, a.y * s + b.y * u, a.z * s + b.z * u, a.w * s + b.w * u});
}

/// Returns the rotation at `t` from a to b along the shorter way with constant speed: spherical linear interpolation.
/// Both must be unit. Uses libm: for drawing and animation, never inside a step. Source: Shoemake 1985, Animating
/// rotation with quaternion curves.
template <class T> QuatOf<T> slerp(QuatOf<T> a, QuatOf<T> b, T t) {
    const T signed_cosine = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
    const T cosine = std::min(std::abs(signed_cosine), T(1));
    if (cosine > T(0.9995)) return nlerp(a, b, t);  // the sines below are too small to divide
    const T angle = std::acos(cosine), sine = std::sin(angle);
    const T s = std::sin((1 - t) * angle) / sine;
    const T u = std::sin(t * angle) / sine * (signed_cosine < 0 ? T(-1) : T(1));
    return normalized(QuatOf<T>{a.x * s + b.x * u, a.y * s + b.y * u, a.z * s + b.z * u, a.w * s + b.w * u});
}

/// Returns the pose at `t` from a to b: positions by lerp(), rotations by nlerp().
inline Pose interpolate(const Pose& a, const Pose& b, float t) {
    return {lerp(a.position, b.position, static_cast<double>(t)), nlerp(a.rotation, b.rotation, t)};
}
inline LocalPose interpolate(const LocalPose& a, const LocalPose& b, float t) {
    return {lerp(a.position, b.position, t), nlerp(a.rotation, b.rotation, t)};
}

}  // namespace fase
