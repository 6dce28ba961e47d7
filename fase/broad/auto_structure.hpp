#pragma once
/// The automatic choice: which structure suits a set of boxes, and why.
#include <cstdint>
#include <span>
#include <string_view>

#include "fase/broad/any_structure.hpp"

namespace fase::broad {

/// What a set of boxes is for: to find the pairs of all, or to be asked by some others.
enum class BoxUse : std::uint8_t { FindsPairs, IsAsked };

/// What is known of a set of boxes that a structure is chosen by. All but the first and the last are looked at only
/// where they matter: for about a hundred boxes that find pairs.
struct BoxStatistics {
    std::size_t boxes = 0;
    /// The longest side that one box in fifty exceeds, to the one that half of them exceed.
    float size_spread = 1;
    bool flat = false;  ///< the lower corners lie within a slab twice as thick as most boxes
    BoxUse use = BoxUse::FindsPairs;
};
/// Of boxes that are about to be stored, or are.
[[nodiscard]] BoxStatistics statistics_of(std::span<const Move> boxes, BoxUse use);

/// A structure and the reason for it, both words that last.
struct AutoStructure {
    std::string_view structure, reason;
};

/// Which structure answers fastest, by name, from what was measured of all of them (docs/benchmarks.md). `current` is
/// kept where it would win or lose by little, so that a count that goes up and down does not change the structure each
/// time; empty: there is none.
[[nodiscard]] std::string_view auto_structure(const BoxStatistics& statistics, std::string_view current);
/// Why it would be chosen, in words that last; empty for one that never is.
[[nodiscard]] std::string_view reason_for(std::string_view structure);

/// Puts what is stored into the structure that suits it, awake or not as it is; commits when it does. To be called
/// before each commit: O(1), but when the structure changes, and for sets of about a hundred boxes with `looks_closely`
/// (now and then), where sizes and places matter. The pairs that are found do not depend on it.
void suit(AnyStructure& structure, BoxUse use, bool looks_closely = false);

}  // namespace fase::broad
