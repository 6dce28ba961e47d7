#pragma once
/// Pieces of walls in columns of rounded numbers, set behind set, on which partition lines are tried out.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fase/level/compiler/side_counts.hpp"

namespace fase::level {

/// A set of pieces in the columns.
struct PieceSet {
    std::size_t first = 0, count = 0;
    [[nodiscard]] std::size_t end() const { return first + count; }
};

/// What the choice of partition lines needs of a piece.
struct PieceColumns {
    std::vector<float> ax, ay, bx, by;      ///< its ends, relative to the middle of the map
    std::vector<float> weight;              ///< segs: 1 or 2; 0 in the padding behind a set
    std::vector<std::uint32_t> plane;       ///< on which it lies
    std::vector<std::uint8_t> right, left;  ///< segs that look to the right of the plane, and to the left: 0 or 1

    /// Makes the columns at least that long.
    void make_room(std::size_t length);
    /// Takes what stands behind a set for padding.
    void end_set(PieceSet set);
    [[nodiscard]] PieceView view(PieceSet set) const;
    /// The parts of a set on both sides of a plane, placed behind it one after the other; ends within near_line of the
    /// plane count as on it.
    void split(PieceSet set, std::uint32_t plane_index, const FloatLine& line, PieceSet& on_right, PieceSet& on_left);

private:
    void add(PieceSet& set, std::size_t like, float from_x, float from_y, float to_x, float to_y);
};

}  // namespace fase::level
