#pragma once
/// The automatic choice of the structure for a set of boxes, with the reason.
#include <cstdint>
#include <span>
#include <string_view>

#include "fase/broad/any_structure.hpp"

namespace fase::broad {

/// Use of a set of boxes.
enum class BoxUse : std::uint8_t {
    FindsPairs,      ///< finds the pairs among its boxes
    IsQueried,       ///< finds the pairs of its boxes with other boxes, as the sets of resting bodies do
    AnswersQueries,  ///< answers rays, views, overlaps and nearest neighbours
};

/// Statistics of a set of boxes from which its structure is chosen. `size_spread` and `flat` are computed only where
/// they affect the choice: for sets of about a hundred boxes that find pairs.
struct BoxStatistics {
    std::size_t boxes = 0;
    /// Ratio of the 98th percentile to the median of the longest sides of the boxes.
    float size_spread = 1;
    bool flat = false;  ///< the lower corners are in a slab at most twice as thick as the median box
    BoxUse use = BoxUse::FindsPairs;
};
/// Computes the statistics of boxes, stored or about to be stored.
[[nodiscard]] BoxStatistics statistics_of(std::span<const Move> boxes, BoxUse use);

/// A structure by name, and the reason for the choice; both texts have static lifetime.
struct StructureChoice {
    std::string_view structure, reason;
};

/// Returns the name of the fastest structure, by measurements of all structures (docs/benchmarks.md). Hysteresis: keeps
/// `current` when the difference is small, so that a varying count does not change the structure each time; empty:
/// there is no current structure.
[[nodiscard]] std::string_view choose_structure(const BoxStatistics& statistics, std::string_view current);
/// Returns the reason for choosing a structure, with static lifetime; empty for structures that are never chosen.
[[nodiscard]] std::string_view choice_reason(std::string_view structure);

/// Converts `structure` to the fastest structure for its boxes, keeps the awake flags, and commits when it converts.
/// Call before each commit. O(1), except on a conversion and for sets of about a hundred boxes with `inspect_sizes`,
/// where sizes and positions affect the choice; pass true now and then. The found pairs do not depend on it.
void update_auto_structure(AnyStructure& structure, BoxUse use, bool inspect_sizes = false);

}  // namespace fase::broad
