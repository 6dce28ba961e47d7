#pragma once
/// Four doubles in two vectors, as Float4 has four floats in one.
#include "fase/math/detail/float4.hpp"
#include "fase/math/quat.hpp"

namespace fase::detail {

/// Four lanes; each operation gives the bits of the same operation on doubles.
struct Double4 {
    using Half = double __attribute__((vector_size(16)));
    using HalfMask = long long __attribute__((vector_size(16)));
    struct Mask {
        HalfMask lo, hi;  ///< -1 where true, else 0
    };
    Half lo, hi;

    constexpr Double4() : Double4(0.0) {}
    constexpr Double4(double value) : lo{value, value}, hi{value, value} {}
    constexpr Double4(Half low, Half high) : lo(low), hi(high) {}
    explicit Double4(Float4 a) : lo{a.v[0], a.v[1]}, hi{a.v[2], a.v[3]} {}

    friend Double4 operator+(Double4 a, Double4 b) { return {a.lo + b.lo, a.hi + b.hi}; }
    friend Double4 operator-(Double4 a, Double4 b) { return {a.lo - b.lo, a.hi - b.hi}; }
    friend Double4 operator*(Double4 a, Double4 b) { return {a.lo * b.lo, a.hi * b.hi}; }
    friend Double4 operator/(Double4 a, Double4 b) { return {a.lo / b.lo, a.hi / b.hi}; }
    friend Double4 operator-(Double4 a) { return {-a.lo, -a.hi}; }
    friend constexpr Mask operator<(Double4 a, Double4 b) { return {a.lo < b.lo, a.hi < b.hi}; }
    friend Double4 select(Mask mask, Double4 yes, Double4 no) {
        return {mask.lo ? yes.lo : no.lo, mask.hi ? yes.hi : no.hi};
    }
    friend Double4 sqrt(Double4 a) {
        return {Half{std::sqrt(a.lo[0]), std::sqrt(a.lo[1])}, Half{std::sqrt(a.hi[0]), std::sqrt(a.hi[1])}};
    }
    friend Float4 to_float(Double4 a) {
        return Float4::Lanes{static_cast<float>(a.lo[0]), static_cast<float>(a.lo[1]), static_cast<float>(a.hi[0]),
                             static_cast<float>(a.hi[1])};
    }
};

inline Vec3Of<Double4> to_double(const Vec3Of<Float4>& a) { return {Double4(a.x), Double4(a.y), Double4(a.z)}; }
inline Vec3Of<Float4> to_float(const Vec3Of<Double4>& a) { return {to_float(a.x), to_float(a.y), to_float(a.z)}; }
inline QuatOf<Double4> to_double(const QuatOf<Float4>& q) {
    return {Double4(q.x), Double4(q.y), Double4(q.z), Double4(q.w)};
}
inline QuatOf<Float4> to_float(const QuatOf<Double4>& q) {
    return {to_float(q.x), to_float(q.y), to_float(q.z), to_float(q.w)};
}
/// Returns q scaled to length 1; the identity where q's length is 0.
inline QuatOf<Double4> normalized(const QuatOf<Double4>& q) {
    const Double4 length = sqrt(length_squared(q)), s = Double4(1.0) / length;
    const Double4::Mask valid = Double4(0.0) < length;
    return {select(valid, q.x * s, 0.0), select(valid, q.y * s, 0.0), select(valid, q.z * s, 0.0),
            select(valid, q.w * s, 1.0)};
}

}  // namespace fase::detail
