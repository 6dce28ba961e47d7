#pragma once
/// 3 x 3 matrices, stored by columns.
#include "fase/math/vec3.hpp"

namespace fase {

/// A 3 x 3 matrix of columns: m * v = x * v.x + y * v.y + z * v.z. Default: zero.
template <class T> struct Mat3Of {
    Vec3Of<T> x, y, z;
    friend constexpr bool operator==(const Mat3Of&, const Mat3Of&) = default;
    static constexpr Mat3Of identity() { return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}; }
    static constexpr Mat3Of diagonal(Vec3Of<T> d) { return {{d.x, 0, 0}, {0, d.y, 0}, {0, 0, d.z}}; }
    constexpr Vec3Of<T>& operator[](int column) { return column == 0 ? x : column == 1 ? y : z; }
    constexpr const Vec3Of<T>& operator[](int column) const { return column == 0 ? x : column == 1 ? y : z; }
    friend constexpr Vec3Of<T> operator*(const Mat3Of& m, Vec3Of<T> v) { return m.x * v.x + m.y * v.y + m.z * v.z; }
    friend constexpr Mat3Of operator*(const Mat3Of& a, const Mat3Of& b) { return {a * b.x, a * b.y, a * b.z}; }
    friend constexpr Mat3Of operator*(const Mat3Of& a, T s) { return {a.x * s, a.y * s, a.z * s}; }
    friend constexpr Mat3Of operator+(const Mat3Of& a, const Mat3Of& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Mat3Of operator-(const Mat3Of& a, const Mat3Of& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
};
using Mat3 = Mat3Of<float>;
using Mat3d = Mat3Of<double>;

template <class T> constexpr Mat3Of<T> transpose(const Mat3Of<T>& m) {
    return {{m.x.x, m.y.x, m.z.x}, {m.x.y, m.y.y, m.z.y}, {m.x.z, m.y.z, m.z.z}};
}
/// transpose(m) * v, without building the transpose.
template <class T> constexpr Vec3Of<T> transpose_times(const Mat3Of<T>& m, Vec3Of<T> v) {
    return {dot(m.x, v), dot(m.y, v), dot(m.z, v)};
}
template <class T> constexpr Mat3Of<T> abs(const Mat3Of<T>& m) { return {abs(m.x), abs(m.y), abs(m.z)}; }
template <class T> constexpr T determinant(const Mat3Of<T>& m) { return dot(m.x, cross(m.y, m.z)); }
/// The inverse; all zero when the determinant is 0.
template <class T> constexpr Mat3Of<T> inverse(const Mat3Of<T>& m) {
    const T d = determinant(m);
    const T s = d != 0 ? 1 / d : T(0);
    return transpose(Mat3Of<T>{cross(m.y, m.z) * s, cross(m.z, m.x) * s, cross(m.x, m.y) * s});
}
constexpr Mat3 to_float(const Mat3d& m) { return {to_float(m.x), to_float(m.y), to_float(m.z)}; }
constexpr Mat3d to_double(const Mat3& m) { return {to_double(m.x), to_double(m.y), to_double(m.z)}; }

}  // namespace fase
