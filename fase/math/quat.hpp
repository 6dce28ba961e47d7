#pragma once
/// Rotations as unit quaternions.
#include "fase/math/mat3.hpp"

namespace fase {

/// A quaternion; of length 1 it is a rotation: x, y, z are axis * sin(angle / 2), w is cos(angle / 2). Default:
/// identity.
template <class T> struct QuatOf {
    T x = 0, y = 0, z = 0, w = 1;
    friend constexpr bool operator==(QuatOf, QuatOf) = default;
    [[nodiscard]] constexpr Vec3Of<T> vector() const { return {x, y, z}; }
    /// Applies b, then a.
    friend constexpr QuatOf operator*(QuatOf a, QuatOf b) {
        return {a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y + a.y * b.w + a.z * b.x - a.x * b.z,
                a.w * b.z + a.z * b.w + a.x * b.y - a.y * b.x, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
    }
};
using Quat = QuatOf<float>;
using Quatd = QuatOf<double>;

template <class T> constexpr QuatOf<T> conjugate(QuatOf<T> q) { return {-q.x, -q.y, -q.z, q.w}; }
template <class T> constexpr T length_squared(QuatOf<T> q) { return q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w; }
/// Returns q scaled to length 1; the identity when q's length is 0.
template <class T> QuatOf<T> normalized(QuatOf<T> q) {
    const T l = std::sqrt(length_squared(q));
    if (!(l > 0)) return {};
    const T s = 1 / l;
    return {q.x * s, q.y * s, q.z * s, q.w * s};
}
template <class T> bool is_finite(QuatOf<T> q) { return is_finite(q.vector()) && std::isfinite(q.w); }
/// Rotates v by the unit quaternion q.
template <class T> constexpr Vec3Of<T> rotate(QuatOf<T> q, Vec3Of<T> v) {
    const Vec3Of<T> u = q.vector();
    const Vec3Of<T> t = cross(u, v) * T(2);
    return v + t * q.w + cross(u, t);
}
/// Rotates v by the inverse of the unit quaternion q.
template <class T> constexpr Vec3Of<T> rotate_back(QuatOf<T> q, Vec3Of<T> v) { return rotate(conjugate(q), v); }
/// Returns the matrix of the unit quaternion q; its columns are the rotated axes.
template <class T> constexpr Mat3Of<T> to_matrix(QuatOf<T> q) {
    const T xx = q.x * q.x, yy = q.y * q.y, zz = q.z * q.z, xy = q.x * q.y, xz = q.x * q.z, yz = q.y * q.z;
    const T wx = q.w * q.x, wy = q.w * q.y, wz = q.w * q.z;
    return {{1 - 2 * (yy + zz), 2 * (xy + wz), 2 * (xz - wy)},
            {2 * (xy - wz), 1 - 2 * (xx + zz), 2 * (yz + wx)},
            {2 * (xz + wy), 2 * (yz - wx), 1 - 2 * (xx + yy)}};
}
/// Returns the unit quaternion of a rotation matrix (orthonormal, determinant 1). Source: Shepperd 1978, Quaternion
/// from rotation matrix: computes the largest of the four components first.
template <class T> QuatOf<T> to_quat(const Mat3Of<T>& m) {
    const T trace = m.x.x + m.y.y + m.z.z;
    QuatOf<T> q;
    if (trace > 0) {
        q = {m.y.z - m.z.y, m.z.x - m.x.z, m.x.y - m.y.x, 1 + trace};
    } else if (m.x.x >= m.y.y && m.x.x >= m.z.z) {
        q = {1 + m.x.x - m.y.y - m.z.z, m.y.x + m.x.y, m.z.x + m.x.z, m.y.z - m.z.y};
    } else if (m.y.y >= m.z.z) {
        q = {m.y.x + m.x.y, 1 + m.y.y - m.x.x - m.z.z, m.z.y + m.y.z, m.z.x - m.x.z};
    } else {
        q = {m.z.x + m.x.z, m.z.y + m.y.z, 1 + m.z.z - m.x.x - m.y.y, m.x.y - m.y.x};
    }
    return normalized(q);
}
/// Returns the rotation by `angle` radians about the unit vector `axis`. Uses libm: for set-up, never inside a step.
template <class T> QuatOf<T> rotation_about(Vec3Of<T> axis, T angle) {
    const T s = std::sin(angle / 2);
    return {axis.x * s, axis.y * s, axis.z * s, std::cos(angle / 2)};
}
constexpr Quat to_float(Quatd q) {
    return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z), static_cast<float>(q.w)};
}
constexpr Quatd to_double(Quat q) { return {q.x, q.y, q.z, q.w}; }

}  // namespace fase
