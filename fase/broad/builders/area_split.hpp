#pragma once
/// The cut of least surface, sought more thoroughly than a moving tree can afford.
#include "fase/broad/builders/binned_split.hpp"

namespace fase::broad {

/// As split_by_binned_area(), but along all three axes, with every cut between sorted centres tried where items are few
/// (up to 32) and 31 evenly spaced cuts an axis where they are many. Two to three times as dear; trees are some 10 %
/// quicker to ask. O(n); the outcome depends on the items and their order alone. Sources: Wald 2007, On fast
/// construction of SAH-based bounding volume hierarchies (bins); MacDonald and Booth 1990, Heuristics for ray tracing
/// using space subdivision (sweep).
Split split_by_area(std::span<BuildItem> items);

}  // namespace fase::broad
