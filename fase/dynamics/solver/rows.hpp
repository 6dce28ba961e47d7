#pragma once
/// Reading and writing of vectors in the solver's rows and blocks.
#include "fase/dynamics/solver/solver_types.hpp"

namespace fase::dynamics {

[[nodiscard]] inline Vec3 read(const float (*rows)[block_lanes], int lane) {
    return {rows[0][lane], rows[1][lane], rows[2][lane]};
}
inline void write(float (*rows)[block_lanes], int lane, Vec3 v) {
    rows[0][lane] = v.x;
    rows[1][lane] = v.y;
    rows[2][lane] = v.z;
}
[[nodiscard]] inline Vec3 read(const float* p) { return {p[0], p[1], p[2]}; }
inline void write(float* p, Vec3 v) {
    p[0] = v.x;
    p[1] = v.y;
    p[2] = v.z;
}
/// Multiplies the symmetric matrix m (xx, xy, xz, yy, yz, zz) by v.
[[nodiscard]] inline Vec3 times(const float* m, Vec3 v) {
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[1] * v.x + m[3] * v.y + m[4] * v.z,
            m[2] * v.x + m[4] * v.y + m[5] * v.z};
}
/// Returns R⁻¹ n - n for a body that rotated by `rotated`; as in the SIMD passes.
[[nodiscard]] inline Vec3 inverse_rotation_delta(Vec3 rotated, float turns, Vec3 n) {
    const Vec3 t = rotated * 0.5f, tn = cross(t, n);
    return (cross(t, tn) * turns - tn) * (2.0f / (1.0f + turns * dot(t, t)));
}

}  // namespace fase::dynamics
