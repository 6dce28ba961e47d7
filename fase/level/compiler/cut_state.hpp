#pragma once
/// What the steps of the compiler share: the lines of a plan, their pieces, and the tree while it is rough.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fase/level/bsp_compiler.hpp"
#include "fase/level/compiler/exact_plan.hpp"
#include "fase/level/compiler/plan_points.hpp"

namespace fase::level {

/// Bits of Piece::sides.
inline constexpr std::uint8_t right_side = 1, left_side = 2;

/// A piece of a line of the map, with those of its sides that lie in a cell.
struct Piece {
    std::uint32_t a = 0, b = 0;  ///< points, in the line's direction
    std::uint32_t line = 0;
    std::uint8_t sides = 0;
};

/// The endless lines on which a map's lines lie, and its points. Lines over each other share a plane.
struct Plan {
    static constexpr std::uint32_t no_plane = 0xffffffff;
    PlanPoints points;
    std::vector<std::uint32_t> point_of_vertex;
    std::vector<ExactLine> planes;             ///< each in the direction of the longest line on it
    std::vector<std::uint32_t> plane_of_line;  ///< no_plane: of zero length
    std::vector<std::uint8_t> against_plane;   ///< by line: goes against the direction of its plane
    std::uint32_t box_planes = 0;              ///< the first of four planes around the map, clockwise: west, north …

    /// The sides of a piece that its line's plane has on the right.
    [[nodiscard]] std::uint8_t sides_right(const Piece& piece) const {
        return piece.sides & (against_plane[piece.line] != 0 ? left_side : right_side);
    }
    [[nodiscard]] std::uint8_t sides_left(const Piece& piece) const {
        return piece.sides & (against_plane[piece.line] != 0 ? right_side : left_side);
    }
};

/// The plan of a map, and a piece for each of its lines.
Plan make_plan(const Map& map, std::vector<Piece>& pieces);

/// A corner of a cell and the edge that begins there, clockwise.
struct CellCorner {
    std::uint32_t point = 0, plane = 0;
    std::uint32_t node = none;  ///< the node that made the edge; none: the box around the map, or a wall of the leaf
    static constexpr std::uint32_t none = 0xffffffff;
};

/// A leaf while it is rough: its walls, and the convex cell that they and the partition lines leave.
struct RawLeaf {
    std::uint32_t first_piece = 0, pieces = 0, first_corner = 0, corners = 0;
    std::uint32_t depth = 0;
};

/// A node while it is rough; children as in Node, but nodes are numbered from the root on.
struct RawNode {
    std::uint32_t plane = 0;
    std::uint32_t children[2] = {0, 0};
};

/// The tree before edges are laid out.
struct RawTree {
    Plan plan;
    std::vector<RawNode> nodes;
    std::vector<RawLeaf> leaves;
    std::vector<Piece> pieces;        ///< by leaf
    std::vector<CellCorner> corners;  ///< by leaf
};

/// Lays the walls on the edges of the cells, closes gaps with minisegs, and finds who is whose neighbour.
LevelBsp lay_out(const Map& map, RawTree&& tree);

}  // namespace fase::level
