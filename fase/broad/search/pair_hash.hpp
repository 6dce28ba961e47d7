#pragma once
/// A number for a set of pairs, whatever their order.
#include <cstdint>
#include <span>

#include "fase/broad/structure.hpp"
#include "fase/core/hash.hpp"

namespace fase::broad {

/// Tells sets of pairs apart: equal sets have equal prints; others, duplicates and swapped pairs included, have not but
/// for one chance in 2^128.
struct PairSetFingerprint {
    std::uint64_t count = 0;
    std::uint64_t sum = 0;    ///< of a number a pair
    std::uint64_t other = 0;  ///< of another one
    friend bool operator==(const PairSetFingerprint&, const PairSetFingerprint&) = default;
    /// The print of a set with the pairs of another, of which it has none, added.
    PairSetFingerprint& operator+=(const PairSetFingerprint& more) {
        count += more.count;
        sum += more.sum;
        other += more.other;
        return *this;
    }
    /// The print of a set without the pairs of another, all of which it has.
    PairSetFingerprint& operator-=(const PairSetFingerprint& less) {
        count -= less.count;
        sum -= less.sum;
        other -= less.other;
        return *this;
    }
};

/// O(pairs); the order does not count.
inline PairSetFingerprint print_of(std::span<const Pair> pairs) {
    PairSetFingerprint print{.count = pairs.size()};
    for (const Pair pair : pairs) {
        const std::uint64_t key = std::uint64_t(pair.a) << 32 | pair.b;
        const std::uint64_t mixed = mix_bits(key + 0x9e3779b97f4a7c15ull);
        print.sum += mixed;
        print.other += mix_bits(mixed ^ 0xd1342543de82ef95ull);
    }
    return print;
}

}  // namespace fase::broad
