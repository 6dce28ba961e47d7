#pragma once
/// The automatic choice: which structure suits a set of boxes, and why.
#include <string_view>

#include "fase/broad/any_structure.hpp"

namespace fase::broad {

/// What is known of a set of boxes that a structure is chosen by.
struct BoxStatistics {
    std::size_t boxes = 0;
    /// The longest side that one box in fifty exceeds, to the one that half of them exceed; looked at only where it
    /// matters (few boxes).
    float size_spread = 1;
};

/// A structure and the reason for it, both words that last.
struct SuitedStructure {
    std::string_view structure, reason;
};

/// Which structure finds pairs fastest, from what was measured of all of them (docs/benchmarks.md). `current` is kept
/// where it would win or lose by little, so that a count that goes up and down does not change the structure each time.
[[nodiscard]] SuitedStructure suited_structure(const BoxStatistics& statistics, std::string_view current);
/// Whether their number alone decides.
[[nodiscard]] bool count_decides(std::size_t boxes);

/// Puts what is stored into the structure that suits it, awake or not as it is; commits when it does. To be called
/// before each commit: O(1), but when the structure changes, and for sets of about a hundred boxes with `looks_closely`
/// (now and then), where sizes matter. The pairs that are found do not depend on it.
void suit(AnyStructure& structure, bool looks_closely);

}  // namespace fase::broad
