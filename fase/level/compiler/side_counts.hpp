#pragma once
/// Counts the pieces on either side of a line: the inner loop of the choice of partition lines.
#include <cstddef>
#include <span>

namespace fase::level {

/// Pieces of lines as columns, relative to some centre; `padding` more of weight 0 are readable after the last one.
struct PieceView {
    static constexpr std::size_t padding = 16;
    const float *ax = nullptr, *ay = nullptr, *bx = nullptr, *by = nullptr;
    const float* weight = nullptr;  ///< number of segs: 1 or 2 a piece
    std::size_t count = 0;
};

/// The line nx * y - ny * x = offset with the unit direction (nx, ny).
struct FloatLine {
    float nx = 0, ny = 0, offset = 0;
};

/// Weight of the pieces that are at least partly to the left and to the right of a line. Crossing pieces count in both,
/// pieces within near_line of it in neither.
struct SideCounts {
    float left = 0, right = 0;
};

/// Points within this distance count as on the line, in map units; larger than the float error on a map of 2^16 units.
inline constexpr float near_line = 1.0F / 32;

/// Counts for each of the lines. The same result on every processor: sums of integers below 2^24 are exact. `counts`
/// has as many elements as there are lines.
void count_sides(const PieceView& pieces, std::span<const FloatLine> lines, SideCounts* counts);

}  // namespace fase::level
