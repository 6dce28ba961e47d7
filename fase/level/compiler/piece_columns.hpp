#pragma once
/// Pieces of walls as columns of rounded numbers (structure of arrays), for trials of partition lines.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fase/level/compiler/side_counts.hpp"

namespace fase::level {

/// A range of the columns.
struct PieceSet {
    std::size_t first = 0, count = 0;
    [[nodiscard]] std::size_t end() const { return first + count; }
};

/// The data of pieces that the choice of partition lines needs; sets are stored one after another.
struct PieceColumns {
    std::vector<float> ax, ay, bx, by;      ///< ends, relative to the middle of the map
    std::vector<float> weight;              ///< number of segs: 1 or 2; 0 in the padding after a set
    std::vector<std::uint32_t> plane;       ///< of the piece
    std::vector<std::uint8_t> right, left;  ///< number of segs on the right of the plane, and on the left: 0 or 1

    /// Makes the columns at least that long.
    void ensure_length(std::size_t length);
    /// Zeroes the weights of the padding after a set.
    void add_padding(PieceSet set);
    [[nodiscard]] PieceView view(PieceSet set) const;
    /// Splits a set by a plane and stores the two parts after it; ends within near_line of the plane count as on it.
    void split(PieceSet set, std::uint32_t plane_index, const FloatLine& line, PieceSet& on_right, PieceSet& on_left);

private:
    void add(PieceSet& set, std::size_t source, float from_x, float from_y, float to_x, float to_y);
};

}  // namespace fase::level
