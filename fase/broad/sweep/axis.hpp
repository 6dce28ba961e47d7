#pragma once
/// Chooses the sort axis of a sweep.
#include <span>

#include "fase/broad/structure.hpp"

namespace fase::broad {

/// Returns the axis (0 to 2) with the fewest overlaps in a sample of at most 128 boxes; of equal axes the one with the
/// largest variance, then `current`. Keeps `current` unless another axis is clearly better, so that the result does not
/// alternate.
[[nodiscard]] int best_sweep_axis(std::span<const Move> boxes, int current);

}  // namespace fase::broad
