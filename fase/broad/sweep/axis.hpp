#pragma once
/// Along which axis boxes are best sorted.
#include <span>

#include "fase/broad/structure.hpp"

namespace fase::broad {

/// The axis (0 to 2) on which the fewest boxes overlap each other, judged by a sample of at most 128 of the boxes; of
/// equals the one whose boxes lie farthest apart, and then `now`. Keeps `now` when the others are not clearly better,
/// so that the answer does not flutter.
[[nodiscard]] int best_sweep_axis(std::span<const Move> boxes, int now);

}  // namespace fase::broad
