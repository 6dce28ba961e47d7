#pragma once
/// How much of a set of pieces lies on either side of a line: the inner loop of choosing partition lines.
#include <cstddef>
#include <vector>

namespace fase::level {

/// Pieces of lines, column by column, relative to some centre. Behind the last there is room for a full vector of
/// pieces of no weight.
struct PieceColumns {
    static constexpr std::size_t padding = 16;
    std::vector<float> ax, ay, bx, by;
    std::vector<float> weight;  ///< segs: 1 or 2 a piece
    std::size_t count = 0;

    /// Makes room for `pieces`; the columns are then to be filled, with weight 0 in the padding.
    void resize(std::size_t pieces);
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

/// Counts exactly what the rounded numbers say, the same on every processor: whole weights below 2^24 in sum.
[[nodiscard]] SideCounts count_sides(const PieceColumns& pieces, const FloatLine& line);

}  // namespace fase::level
