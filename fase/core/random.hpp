#pragma once
/// Counter-based random numbers: draw n of stream s is a function of (seed, s, n) alone.
#include <cstdint>

#include "fase/core/hash.hpp"

namespace fase {

/// A stream of random numbers; a copy continues from the same position. Equal seeds and streams give equal numbers on
/// every machine. Not cryptographic.
class Random {
public:
    explicit constexpr Random(std::uint64_t seed = 0, std::uint64_t stream = 0)
        : key_(mix_bits(seed + 0x9e3779b97f4a7c15ull) ^ mix_bits(stream * 0xd1342543de82ef95ull + 1)) {}

    /// Returns draw `n` of this stream without advancing it.
    [[nodiscard]] constexpr std::uint64_t at(std::uint64_t n) const {
        return mix_bits(mix_bits(n * 0x9e3779b97f4a7c15ull + key_) + key_);
    }
    constexpr std::uint64_t next() { return at(counter_++); }
    /// Uniform in [0, 1), a multiple of 2^-24.
    constexpr float unit() { return static_cast<float>(next() >> 40) * 0x1p-24f; }
    /// Uniform in [lo, hi); lo when they are equal.
    constexpr float between(float lo, float hi) { return lo + (hi - lo) * unit(); }
    /// Uniform in 0..count-1 (bias below count / 2^64); 0 when count is 0.
    constexpr std::uint64_t below(std::uint64_t count) {
        __extension__ using Product = unsigned __int128;
        return static_cast<std::uint64_t>((static_cast<Product>(next()) * count) >> 64);
    }

private:
    std::uint64_t key_;
    std::uint64_t counter_ = 0;
};

}  // namespace fase
