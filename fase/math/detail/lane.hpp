#pragma once
/// One float with the interface of a SIMD vector: the scalar reference for the SIMD code.
#include <cmath>
#include <cstddef>
#include <cstdint>

namespace fase {

/// A single lane. Each operation gives the same bits as a lane of a SIMD vector.
struct Lane {
    static constexpr int lanes = 1;
    float v;

    static Lane load(const float* p) { return {*p}; }
    static Lane set(float value) { return {value}; }
    void store(float* p) const { *p = v; }
    friend Lane operator+(Lane a, Lane b) { return {a.v + b.v}; }
    friend Lane operator-(Lane a, Lane b) { return {a.v - b.v}; }
    friend Lane operator*(Lane a, Lane b) { return {a.v * b.v}; }
    friend Lane operator/(Lane a, Lane b) { return {a.v / b.v}; }
    friend Lane sqrt_of(Lane a) { return {std::sqrt(a.v)}; }
    friend Lane select_greater(Lane a, Lane b, Lane x, Lane y) { return a.v > b.v ? x : y; }
    static void gather8(const float* base, const std::uint32_t* rows, std::size_t stride, Lane* out) {
        for (int i = 0; i < 8; ++i) out[i].v = base[rows[0] * stride + static_cast<std::size_t>(i)];
    }
    static void scatter8(float* base, const std::uint32_t* rows, std::size_t stride, const Lane* in) {
        for (int i = 0; i < 8; ++i) base[rows[0] * stride + static_cast<std::size_t>(i)] = in[i].v;
    }
};

}  // namespace fase
