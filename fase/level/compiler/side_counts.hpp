#pragma once
/// How much of a set of pieces lies on either side of a line: the inner loop of choosing partition lines.
#include <cstddef>
#include <span>

namespace fase::level {

/// Pieces of lines, column by column, relative to some centre; `padding` more can be read behind the last, of no
/// weight.
struct PieceView {
    static constexpr std::size_t padding = 16;
    const float *ax = nullptr, *ay = nullptr, *bx = nullptr, *by = nullptr;
    const float* weight = nullptr;  ///< segs: 1 or 2 a piece
    std::size_t count = 0;
};

/// A line as nx * y - ny * x = offset, (nx, ny) its direction of length 1.
struct FloatLine {
    float nx = 0, ny = 0, offset = 0;
};

/// Weight of the pieces that reach to the left and to the right of a line; those that do both count in both, those that
/// stay within near_line of it in neither.
struct SideCounts {
    float left = 0, right = 0;
};

/// Points within this distance count as on the line, in map units; above what floats lose on a map of 2^16 units.
inline constexpr float near_line = 1.0F / 32;

/// Counts for each of the lines, exactly what the rounded numbers say, the same on every processor: whole weights below
/// 2^24 in sum. `counts` has room for as many as there are lines.
void count_sides(const PieceView& pieces, std::span<const FloatLine> lines, SideCounts* counts);

}  // namespace fase::level
