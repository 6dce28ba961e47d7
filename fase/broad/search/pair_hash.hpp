#pragma once
/// An order-independent fingerprint of a set of pairs.
#include <cstdint>
#include <span>

#include "fase/broad/structure.hpp"
#include "fase/core/hash.hpp"

namespace fase::broad {

/// Identifies a set of pairs. Equal sets have equal fingerprints; different sets, also those with duplicated or swapped
/// pairs, have different ones except with probability 2^-128.
struct PairSetFingerprint {
    std::uint64_t count = 0;
    std::uint64_t sum = 0;    ///< sum of one hash per pair
    std::uint64_t other = 0;  ///< sum of a second hash per pair
    friend bool operator==(const PairSetFingerprint&, const PairSetFingerprint&) = default;
    /// Gives the fingerprint of the union with a disjoint set.
    PairSetFingerprint& operator+=(const PairSetFingerprint& more) {
        count += more.count;
        sum += more.sum;
        other += more.other;
        return *this;
    }
    /// Gives the fingerprint of the difference from a subset.
    PairSetFingerprint& operator-=(const PairSetFingerprint& less) {
        count -= less.count;
        sum -= less.sum;
        other -= less.other;
        return *this;
    }
};

/// Returns the fingerprint of the pairs, in any order. O(pairs).
inline PairSetFingerprint fingerprint_of(std::span<const Pair> pairs) {
    PairSetFingerprint fingerprint{.count = pairs.size()};
    for (const Pair pair : pairs) {
        const std::uint64_t key = std::uint64_t(pair.a) << 32 | pair.b;
        const std::uint64_t mixed = mix_bits(key + 0x9e3779b97f4a7c15ull);
        fingerprint.sum += mixed;
        fingerprint.other += mix_bits(mixed ^ 0xd1342543de82ef95ull);
    }
    return fingerprint;
}

}  // namespace fase::broad
