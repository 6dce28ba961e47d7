#pragma once
/// Boxes around rotated shapes, rounded outward from double to float.
#include "fase/geometry/aabb.hpp"

namespace fase::detail {

/// Returns the rotation of q / |q|, exact to a few units in the last place of a double. Without the division, a
/// quaternion whose length is a few float roundings off 1 would also scale, and the scaled shape would exceed its box.
inline Mat3d rotation_matrix(Quat q) {
    const double x = q.x, y = q.y, z = q.z, w = q.w;
    const double s = 2 / (x * x + y * y + z * z + w * w);
    const double sx = s * x, sy = s * y, sz = s * z;
    return {{1 - (sy * y + sz * z), sx * y + sz * w, sx * z - sy * w},
            {sx * y - sz * w, 1 - (sx * x + sz * z), sy * z + sx * w},
            {sx * z + sy * w, sy * z - sx * w, 1 - (sx * x + sy * y)}};
}

/// Returns the y column of rotation_matrix(): the axis direction of a round shape.
inline Vec3d rotated_y(Quat q) {
    const double x = q.x, y = q.y, z = q.z, w = q.w;
    const double s = 2 / (x * x + y * y + z * z + w * w);
    return {s * (x * y - z * w), 1 - s * (x * x + z * z), s * (y * z + x * w)};
}

/// Returns a float at or below v, at most two units in the last place away; the error of v is not included.
/// Proof: rounding to nearest moves a double w by at most |w| 2^-24 (or 2^-150 where floats are denormal). With
/// w = v - |v| k, k = 2^-24 (1 + 2^-20), that is at most |v| (1 + k) 2^-24 < |v| k: never back above v. Where |v| is so
/// small that floats are denormal, the slack of box_at() is far larger and covers the error.
inline float float_below(double v) {
    constexpr double k = 0x1p-24 * (1 + 0x1p-20);
    return static_cast<float>(v - (v < 0 ? -v : v) * k);
}
inline float float_above(double v) { return -float_below(-v); }

/// Returns the float box from position + lo to position + hi, rounded outward. Error bound: an entry of the matrix is
/// off by at most 16 roundings of 2^-53 (12 from its two products, whose sum is at most 2, the rest from the sums), the
/// sums over it by three more, each times the size of the shape, which is at most the sum of the three reaches: 2^-47
/// of that sum is twice the bound. The sum with the position adds 2^-53 of |position| + reach. The box is enlarged by
/// all of it before rounding to float.
inline Aabb box_at(const Vec3d& position, const Vec3d& lo, const Vec3d& hi) {
    const Vec3d reach = max(abs(lo), abs(hi));
    const double slack = (reach.x + reach.y + reach.z) * 0x1p-47;
    const Vec3d out = abs(position) * 0x1p-52 + Vec3d{slack, slack, slack};
    const Vec3d low = position + lo - out, high = position + hi + out;
    return {{float_below(low.x), float_below(low.y), float_below(low.z)},
            {float_above(high.x), float_above(high.y), float_above(high.z)}};
}
/// For point-symmetric shapes.
inline Aabb box_at(const Vec3d& position, const Vec3d& half) { return box_at(position, -half, half); }

}  // namespace fase::detail
