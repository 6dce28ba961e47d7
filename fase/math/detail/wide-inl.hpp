/// SIMD vectors of floats on Highway. Included once for each target inside its namespace (see
/// dynamics/solver/contact_passes.cpp), so no #pragma once.
#if defined(FASE_MATH_WIDE_INL_HPP) == defined(HWY_TARGET_TOGGLE)
#ifdef FASE_MATH_WIDE_INL_HPP
#undef FASE_MATH_WIDE_INL_HPP
#else
#define FASE_MATH_WIDE_INL_HPP
#endif
#undef FASE_HAS_WIDE_PAIR

#include <hwy/highway.h>

#include <cstddef>
#include <cstdint>

#include "fase/math/detail/lane.hpp"

HWY_BEFORE_NAMESPACE();
namespace fase::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR
/// Transposes four rows of four lanes within each 128-bit block.
template <class D> HWY_INLINE void transpose_blocks(D d, hn::Vec<D>* z) {
    const hn::Repartition<double, D> dd;
    const auto a = hn::BitCast(dd, hn::InterleaveLower(d, z[0], z[1]));
    const auto b = hn::BitCast(dd, hn::InterleaveUpper(d, z[0], z[1]));
    const auto c = hn::BitCast(dd, hn::InterleaveLower(d, z[2], z[3]));
    const auto e = hn::BitCast(dd, hn::InterleaveUpper(d, z[2], z[3]));
    z[0] = hn::BitCast(d, hn::InterleaveLower(dd, a, c));
    z[1] = hn::BitCast(d, hn::InterleaveUpper(dd, a, c));
    z[2] = hn::BitCast(d, hn::InterleaveLower(dd, b, e));
    z[3] = hn::BitCast(d, hn::InterleaveUpper(dd, b, e));
}
#endif

#if HWY_TARGET == HWY_SCALAR
using Wide = fase::Lane;  // no SIMD target for this processor
#else
/// A SIMD vector of four or eight floats. Add, subtract, multiply, divide and sqrt round as scalars do, and no
/// operation is fused, so every width gives the same bits.
struct Wide {
    using Tag = hn::CappedTag<float, 8>;
    static constexpr int lanes = static_cast<int>(hn::MaxLanes(Tag()));
    static_assert(lanes == 4 || lanes == 8);
    hn::Vec<Tag> v;

    static HWY_INLINE Wide load(const float* p) { return {hn::LoadU(Tag(), p)}; }
    static HWY_INLINE Wide set(float value) { return {hn::Set(Tag(), value)}; }
    HWY_INLINE void store(float* p) const { hn::StoreU(v, Tag(), p); }
    friend HWY_INLINE Wide operator+(Wide a, Wide b) { return {hn::Add(a.v, b.v)}; }
    friend HWY_INLINE Wide operator-(Wide a, Wide b) { return {hn::Sub(a.v, b.v)}; }
    friend HWY_INLINE Wide operator*(Wide a, Wide b) { return {hn::Mul(a.v, b.v)}; }
    friend HWY_INLINE Wide operator/(Wide a, Wide b) { return {hn::Div(a.v, b.v)}; }
    friend HWY_INLINE Wide sqrt_of(Wide a) { return {hn::Sqrt(a.v)}; }
    /// a > b ? x : y for each lane; a NaN compares false.
    friend HWY_INLINE Wide select_greater(Wide a, Wide b, Wide x, Wide y) {
        return {hn::IfThenElse(hn::Gt(a.v, b.v), x.v, y.v)};
    }

    /// Loads 8 floats from each of `lanes` rows and transposes them: out[k] holds float k of every row. Rows are
    /// aligned to 16 bytes; `stride` is in floats.
    static HWY_INLINE void gather8(const float* base, const std::uint32_t* rows, std::size_t stride, Wide* out) {
        const Tag d;
        hn::Vec<Tag> z[8];
        if constexpr (lanes == 8) {
            for (int i = 0; i < 8; ++i) z[i] = hn::LoadU(d, base + rows[i] * stride);
            transpose4(z);
            transpose4(z + 4);
            for (int i = 0; i < 4; ++i) {
                out[i].v = hn::ConcatLowerLower(d, z[4 + i], z[i]);
                out[4 + i].v = hn::ConcatUpperUpper(d, z[4 + i], z[i]);
            }
        } else {
            for (int i = 0; i < 4; ++i) {
                z[i] = hn::LoadU(d, base + rows[i] * stride);
                z[4 + i] = hn::LoadU(d, base + rows[i] * stride + 4);
            }
            transpose4(z);
            transpose4(z + 4);
            for (int i = 0; i < 8; ++i) out[i].v = z[i];
        }
    }
    /// The inverse of gather8(). All rows must differ, except rows that are never read.
    static HWY_INLINE void scatter8(float* base, const std::uint32_t* rows, std::size_t stride, const Wide* in) {
        const Tag d;
        hn::Vec<Tag> z[8];
        if constexpr (lanes == 8) {
            for (int i = 0; i < 4; ++i) {
                z[i] = hn::ConcatLowerLower(d, in[4 + i].v, in[i].v);
                z[4 + i] = hn::ConcatUpperUpper(d, in[4 + i].v, in[i].v);
            }
            transpose4(z);
            transpose4(z + 4);
            for (int i = 0; i < 8; ++i) hn::StoreU(z[i], d, base + rows[i] * stride);
        } else {
            for (int i = 0; i < 8; ++i) z[i] = in[i].v;
            transpose4(z);
            transpose4(z + 4);
            for (int i = 0; i < 4; ++i) {
                hn::StoreU(z[i], d, base + rows[i] * stride);
                hn::StoreU(z[4 + i], d, base + rows[i] * stride + 4);
            }
        }
    }

private:
    static HWY_INLINE void transpose4(hn::Vec<Tag>* z) { transpose_blocks(Tag(), z); }
};
#endif

// Sixteen lanes need 64-byte vectors with their 32 registers.
#if HWY_TARGET <= HWY_AVX3 && HWY_TARGET != HWY_SCALAR && HWY_ARCH_X86
#define FASE_HAS_WIDE_PAIR 1
/// The floats of two arrays that are `apart` floats apart, in one vector of sixteen lanes. Where the operations of one
/// array wait for each other, both take as long as one.
template <std::size_t apart> struct WidePair {
    using Tag = hn::FixedTag<float, 16>;
    using Half = hn::FixedTag<float, 8>;
    static constexpr int lanes = 8;  ///< of each array
    hn::Vec<Tag> v;

    static HWY_INLINE WidePair load(const float* p) { return joined(p, p + apart); }
    static HWY_INLINE WidePair set(float value) { return {hn::Set(Tag(), value)}; }
    HWY_INLINE void store(float* p) const { split(v, p, p + apart); }
    friend HWY_INLINE WidePair operator+(WidePair a, WidePair b) { return {hn::Add(a.v, b.v)}; }
    friend HWY_INLINE WidePair operator-(WidePair a, WidePair b) { return {hn::Sub(a.v, b.v)}; }
    friend HWY_INLINE WidePair operator*(WidePair a, WidePair b) { return {hn::Mul(a.v, b.v)}; }
    friend HWY_INLINE WidePair operator/(WidePair a, WidePair b) { return {hn::Div(a.v, b.v)}; }
    friend HWY_INLINE WidePair sqrt_of(WidePair a) { return {hn::Sqrt(a.v)}; }
    friend HWY_INLINE WidePair select_greater(WidePair a, WidePair b, WidePair x, WidePair y) {
        return {hn::IfThenElse(hn::Gt(a.v, b.v), x.v, y.v)};
    }

    /// As Wide::gather8(), for the rows of both arrays.
    static HWY_INLINE void gather8(const float* base, const std::uint32_t* rows, std::size_t stride, WidePair* out) {
        hn::Vec<Tag> z[8];
        for (int i = 0; i < 8; ++i) z[i] = joined(base + rows[i] * stride, base + rows[apart + i] * stride).v;
        transpose4(z);
        transpose4(z + 4);
        for (int i = 0; i < 4; ++i) exchange_blocks(z[i], z[4 + i], out[i].v, out[4 + i].v);
    }
    /// The inverse of gather8(). All rows of both arrays must differ, except rows that are never read.
    static HWY_INLINE void scatter8(float* base, const std::uint32_t* rows, std::size_t stride, const WidePair* in) {
        hn::Vec<Tag> z[8];
        for (int i = 0; i < 4; ++i) exchange_blocks(in[i].v, in[4 + i].v, z[i], z[4 + i]);
        transpose4(z);
        transpose4(z + 4);
        for (int i = 0; i < 8; ++i) split(z[i], base + rows[i] * stride, base + rows[apart + i] * stride);
    }

private:
    static HWY_INLINE WidePair joined(const float* low, const float* high) {
        return {hn::Combine(Tag(), hn::LoadU(Half(), high), hn::LoadU(Half(), low))};
    }
    static HWY_INLINE void split(hn::Vec<Tag> z, float* low, float* high) {
        hn::StoreU(hn::LowerHalf(Half(), z), Half(), low);
        hn::StoreU(hn::UpperHalf(Half(), z), Half(), high);
    }
    /// Sets `even` to the 128-bit blocks a0 b0 a2 b2, and `odd` to a1 b1 a3 b3.
    static HWY_INLINE void exchange_blocks(hn::Vec<Tag> a, hn::Vec<Tag> b, hn::Vec<Tag>& even, hn::Vec<Tag>& odd) {
        even = hn::OddEvenBlocks(hn::SwapAdjacentBlocks(b), a);
        odd = hn::OddEvenBlocks(b, hn::SwapAdjacentBlocks(a));
    }
    static HWY_INLINE void transpose4(hn::Vec<Tag>* z) { transpose_blocks(Tag(), z); }
};
#endif

}  // namespace fase::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
