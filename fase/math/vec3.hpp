#pragma once
/// Vectors and points: float (Vec3) for local coordinates, double (Vec3d) for world positions.
#include <cmath>

namespace fase {

/// Three components of type T; metres, metres per second or dimensionless, as the variable's name says.
template <class T> struct Vec3Of {
    T x = 0, y = 0, z = 0;
    friend constexpr bool operator==(Vec3Of, Vec3Of) = default;
    constexpr T& operator[](int i) { return i == 0 ? x : i == 1 ? y : z; }
    constexpr T operator[](int i) const { return i == 0 ? x : i == 1 ? y : z; }
    constexpr Vec3Of& operator+=(Vec3Of b) { return *this = {x + b.x, y + b.y, z + b.z}; }
    constexpr Vec3Of& operator-=(Vec3Of b) { return *this = {x - b.x, y - b.y, z - b.z}; }
    constexpr Vec3Of& operator*=(T s) { return *this = {x * s, y * s, z * s}; }
    friend constexpr Vec3Of operator+(Vec3Of a, Vec3Of b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
    friend constexpr Vec3Of operator-(Vec3Of a, Vec3Of b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
    friend constexpr Vec3Of operator-(Vec3Of a) { return {-a.x, -a.y, -a.z}; }
    friend constexpr Vec3Of operator*(Vec3Of a, T s) { return {a.x * s, a.y * s, a.z * s}; }
    friend constexpr Vec3Of operator*(T s, Vec3Of a) { return {a.x * s, a.y * s, a.z * s}; }
};
using Vec3 = Vec3Of<float>;
using Vec3d = Vec3Of<double>;

template <class T> constexpr T dot(Vec3Of<T> a, Vec3Of<T> b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
template <class T> constexpr Vec3Of<T> cross(Vec3Of<T> a, Vec3Of<T> b) {
    return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class T> constexpr T length_squared(Vec3Of<T> a) { return dot(a, a); }
template <class T> T length(Vec3Of<T> a) { return std::sqrt(dot(a, a)); }
/// Returns the unit vector along `a`; (0, 0, 0) when a's length is 0 or its square underflows.
template <class T> Vec3Of<T> normalized(Vec3Of<T> a) {
    const T l = length(a);
    return l > 0 ? a * (1 / l) : Vec3Of<T>{};
}
/// The component-wise product.
template <class T> constexpr Vec3Of<T> multiply(Vec3Of<T> a, Vec3Of<T> b) { return {a.x * b.x, a.y * b.y, a.z * b.z}; }
/// a < b ? a : b for each component (so a NaN in `a` gives b).
template <class T> constexpr Vec3Of<T> min(Vec3Of<T> a, Vec3Of<T> b) {
    return {a.x < b.x ? a.x : b.x, a.y < b.y ? a.y : b.y, a.z < b.z ? a.z : b.z};
}
template <class T> constexpr Vec3Of<T> max(Vec3Of<T> a, Vec3Of<T> b) {
    return {a.x > b.x ? a.x : b.x, a.y > b.y ? a.y : b.y, a.z > b.z ? a.z : b.z};
}
template <class T> constexpr Vec3Of<T> abs(Vec3Of<T> a) {
    return {a.x < 0 ? -a.x : a.x, a.y < 0 ? -a.y : a.y, a.z < 0 ? -a.z : a.z};
}
template <class T> bool is_finite(Vec3Of<T> a) {
    return std::isfinite(a.x) && std::isfinite(a.y) && std::isfinite(a.z);
}

/// Rounds to nearest.
constexpr Vec3 to_float(Vec3d a) { return {static_cast<float>(a.x), static_cast<float>(a.y), static_cast<float>(a.z)}; }
constexpr Vec3d to_double(Vec3 a) { return {a.x, a.y, a.z}; }

/// Returns a unit vector perpendicular to the unit vector `n`; continuous except where n.z changes its sign.
/// Source: Duff et al. 2017, Building an orthonormal basis, revisited.
template <class T> constexpr Vec3Of<T> any_perpendicular(Vec3Of<T> n) {
    const T sign = n.z >= 0 ? T(1) : T(-1);
    const T a = T(-1) / (sign + n.z);
    return {T(1) + sign * n.x * n.x * a, sign * n.x * n.y * a, -sign * n.x};
}

}  // namespace fase
