#pragma once
/// The SIMD loops of a pair tracker, compiled for every target.
#include <cstddef>
#include <span>
#include <vector>

#include "fase/broad/structure.hpp"

namespace fase::pairs::passes {

/// The bounds of a box in the last frame (index 0) and in this frame (index 1), in one cache line. The fourth number of
/// each corner is 0. The others are NaN in a frame in which the box is absent (Aabb{}), so that it overlaps nothing.
struct alignas(64) BoxHistory {
    float lo[2][4], hi[2][4];
};

/// Sets both frames of a history to a box.
void reset_history(const Aabb& box, BoxHistory& history);

/// Moves the bounds of this frame to the last frame and reads the new ones, for boxes `begin` to `end`. Writes to
/// `changed`, in order, the boxes whose bounds are not the same bits in the last three frames, and returns their
/// number; `changed` needs capacity for all. Sets their `swept` to the bounds of both frames. If a coordinate is NaN in
/// one frame, `swept` contains at least the other; if the box is absent in both, it is Aabb{}.
std::size_t advance_histories(std::span<const Aabb> boxes, std::size_t begin, std::size_t end, BoxHistory* histories,
                              Aabb* swept, broad::Proxy* changed);

/// Classifies pairs. Moves those that overlap in both frames to the front of the list, in order, and returns their
/// number. Appends those that overlap only in this frame to `begun`, only in the last frame to `ended`. Drops the
/// others.
std::size_t classify_pairs(std::span<const BoxHistory> histories, std::span<broad::Pair> pairs,
                           std::vector<broad::Pair>& begun, std::vector<broad::Pair>& ended);

}  // namespace fase::pairs::passes
