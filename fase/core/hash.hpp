#pragma once
/// A stable 64-bit hash: the same bytes give the same number on every machine and in every version.
#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <type_traits>

namespace fase {

/// Mixes 64 bits so that each input bit reaches each output bit. Source: Steele, Lea, Flood 2014, Fast splittable
/// pseudorandom number generators (the SplitMix64 finaliser, variant 13 of Stafford).
constexpr std::uint64_t mix_bits(std::uint64_t x) {
    x ^= x >> 30;
    x *= 0xbf58476d1ce4e5b9ull;
    x ^= x >> 27;
    x *= 0x94d049bb133111ebull;
    x ^= x >> 31;
    return x;
}

/// Hashes a sequence of plain values into one number; order matters. Not cryptographic.
class Hasher {
public:
    /// Adds one integer, enum, bool, float or double by its bits: -0.0 and 0.0 differ, and so do different NaNs.
    template <class T>
    requires(std::is_arithmetic_v<T> || std::is_enum_v<T>) void add(T value) {
        std::uint64_t word = 0;
        if constexpr (std::is_same_v<T, float>) {
            word = std::bit_cast<std::uint32_t>(value);
        } else if constexpr (std::is_same_v<T, double>) {
            word = std::bit_cast<std::uint64_t>(value);
        } else {
            word = static_cast<std::uint64_t>(value);
        }
        state_ = mix_bits(state_ + 0x9e3779b97f4a7c15ull) ^ mix_bits(word + 0x2545f4914f6cdd1dull) * 3;
    }
    /// Adds bytes and their count, as little-endian words, so that all machines agree.
    void add_bytes(std::span<const std::byte> bytes) {
        add(bytes.size());
        std::uint64_t word = 0;
        int filled = 0;
        for (const std::byte b : bytes) {
            word |= std::uint64_t(static_cast<unsigned char>(b)) << (8 * filled);
            if (++filled == 8) {
                add(word);
                word = 0;
                filled = 0;
            }
        }
        if (filled != 0) add(word);
    }
    [[nodiscard]] std::uint64_t value() const { return mix_bits(state_); }

private:
    std::uint64_t state_ = 0;
};

}  // namespace fase
