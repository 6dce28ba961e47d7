#pragma once
/// Four floats in one vector, with the vector types of GCC and Clang: they need no instruction set beyond the one that
/// all processors of the target have. Vectors, quaternions and matrices of Float4 do the same for four objects.
#include <array>
#include <cmath>

#include "fase/math/quat.hpp"

namespace fase::detail {

/// Four lanes; each operation gives the bits of the same operation on floats.
struct Float4 {
    using Lanes = float __attribute__((vector_size(16)));
    using Mask = int __attribute__((vector_size(16)));  ///< -1 where true, else 0
    Lanes v;

    constexpr Float4() : Float4(0.0f) {}
    constexpr Float4(float value) : v{value, value, value, value} {}
    constexpr Float4(Lanes value) : v(value) {}
    static Float4 load(const float* p) {
        Float4 loaded;
        __builtin_memcpy(&loaded.v, p, sizeof loaded.v);
        return loaded;
    }
    void store(float* p) const { __builtin_memcpy(p, &v, sizeof v); }

    friend Float4 operator+(Float4 a, Float4 b) { return a.v + b.v; }
    friend Float4 operator-(Float4 a, Float4 b) { return a.v - b.v; }
    friend Float4 operator*(Float4 a, Float4 b) { return a.v * b.v; }
    friend Float4 operator/(Float4 a, Float4 b) { return a.v / b.v; }
    friend Float4 operator-(Float4 a) { return -a.v; }
    friend constexpr Mask operator<(Float4 a, Float4 b) { return a.v < b.v; }
    friend constexpr Mask operator==(Float4 a, Float4 b) { return a.v == b.v; }
    friend Float4 select(Mask mask, Float4 yes, Float4 no) { return mask ? yes.v : no.v; }
    friend Float4 sqrt(Float4 a) {
        return Lanes{std::sqrt(a.v[0]), std::sqrt(a.v[1]), std::sqrt(a.v[2]), std::sqrt(a.v[3])};
    }
};

inline Vec3Of<Float4> select(Float4::Mask mask, const Vec3Of<Float4>& yes, const Vec3Of<Float4>& no) {
    return {select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z)};
}
/// Returns q scaled to length 1; the identity where q's length is 0.
inline QuatOf<Float4> normalized(const QuatOf<Float4>& q) {
    const Float4 length = sqrt(length_squared(q)), s = Float4(1.0f) / length;
    const Float4::Mask valid = Float4(0.0f) < length;
    return {select(valid, q.x * s, 0.0f), select(valid, q.y * s, 0.0f), select(valid, q.z * s, 0.0f),
            select(valid, q.w * s, 1.0f)};
}
/// Whether any lane of a mask is true.
inline bool any(Float4::Mask mask) {
    using Halves = long long __attribute__((vector_size(16)));
    const auto halves = reinterpret_cast<Halves>(mask);
    return (halves[0] | halves[1]) != 0;
}

/// Transposes four rows of four lanes.
inline void transpose(Float4 (&rows)[4]) {
    const Float4::Lanes a = __builtin_shufflevector(rows[0].v, rows[1].v, 0, 4, 1, 5);
    const Float4::Lanes b = __builtin_shufflevector(rows[0].v, rows[1].v, 2, 6, 3, 7);
    const Float4::Lanes c = __builtin_shufflevector(rows[2].v, rows[3].v, 0, 4, 1, 5);
    const Float4::Lanes d = __builtin_shufflevector(rows[2].v, rows[3].v, 2, 6, 3, 7);
    rows[0] = __builtin_shufflevector(a, c, 0, 1, 4, 5);
    rows[1] = __builtin_shufflevector(a, c, 2, 3, 6, 7);
    rows[2] = __builtin_shufflevector(b, d, 0, 1, 4, 5);
    rows[3] = __builtin_shufflevector(b, d, 2, 3, 6, 7);
}

/// Loads four floats of each of four objects: from(k) points to those of object k. Number i of the result holds float i
/// of every object.
template <class F> std::array<Float4, 4> load_four(const F& from) {
    Float4 rows[4] = {Float4::load(from(0)), Float4::load(from(1)), Float4::load(from(2)), Float4::load(from(3))};
    transpose(rows);
    return {rows[0], rows[1], rows[2], rows[3]};
}
/// The inverse of load_four().
template <class F> void store_four(Float4 x, Float4 y, Float4 z, Float4 w, const F& to) {
    Float4 rows[4] = {x, y, z, w};
    transpose(rows);
    for (int k = 0; k < 4; ++k) rows[k].store(to(k));
}

}  // namespace fase::detail
