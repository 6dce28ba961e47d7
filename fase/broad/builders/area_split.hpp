#pragma once
/// Splits by the surface area heuristic, slower and better than split_by_binned_area(); for trees that are built once.
#include "fase/broad/builders/binned_split.hpp"

namespace fase::broad {

/// As split_by_binned_area(), but on all three axes: tries every split between sorted centres for up to 32 items, and
/// 31 evenly spaced splits per axis for more. Takes two to three times as long; queries in the tree are about 10 %
/// faster. O(n). The result depends only on the items and their order. Sources: Wald 2007, On fast construction of
/// SAH-based bounding volume hierarchies (bins); MacDonald and Booth 1990, Heuristics for ray tracing using space
/// subdivision (sweep).
Split split_by_area(std::span<BuildItem> items);

}  // namespace fase::broad
