#pragma once
/// Data shared by the stages of the compiler: the lines of a plan, their pieces, and the unfinished tree.
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fase/level/bsp_compiler.hpp"
#include "fase/level/compiler/exact_plan.hpp"
#include "fase/level/compiler/plan_points.hpp"

namespace fase::level {

/// Bits of Piece::sides.
inline constexpr std::uint8_t right_side = 1, left_side = 2;

/// A piece of a line of the map, with those of its sides that are in a cell.
struct Piece {
    std::uint32_t a = 0, b = 0;  ///< points, in the line's direction
    std::uint32_t line = 0;
    std::uint8_t sides = 0;
};

/// The infinite lines ("planes") through a map's lines, and all points. Collinear lines share a plane.
struct Plan {
    PlanPoints points;
    std::vector<std::uint32_t> point_of_vertex;
    std::vector<ExactLine> planes;             ///< by plane, in the direction of its longest line
    std::vector<std::uint32_t> plane_of_line;  ///< no_index: the line has zero length
    std::vector<std::uint8_t> against_plane;   ///< by line: opposite to the direction of its plane
    std::uint32_t box_planes = 0;              ///< the first of four planes around the map: west, north, east, south

    /// Returns the sides of a piece that are on the right of its plane.
    [[nodiscard]] std::uint8_t sides_right(const Piece& piece) const {
        return piece.sides & (against_plane[piece.line] != 0 ? left_side : right_side);
    }
    [[nodiscard]] std::uint8_t sides_left(const Piece& piece) const {
        return piece.sides & (against_plane[piece.line] != 0 ? right_side : left_side);
    }
};

/// Returns the plan of a map, and appends a piece for each of its lines.
Plan make_plan(const Map& map, std::vector<Piece>& pieces);

/// A corner of a cell, and the edge from it to the next corner, clockwise.
struct CellCorner {
    std::uint32_t point = 0, plane = 0;
    /// The node that produced the edge; no_index: the box around the map, or a wall of the leaf.
    std::uint32_t node = no_index;
};

/// An unfinished leaf: its walls, and the convex cell inside them and the partition lines.
struct RawLeaf {
    std::uint32_t first_piece = 0, pieces = 0, first_corner = 0, corners = 0;
    std::uint32_t depth = 0;
};

/// An unfinished node; children as in Node, but with parents before children.
struct RawNode {
    std::uint32_t plane = 0;
    std::uint32_t children[2] = {0, 0};
};

/// The tree before its segs are made.
struct RawTree {
    Plan plan;
    std::vector<RawNode> nodes;
    std::vector<RawLeaf> leaves;
    std::vector<Piece> pieces;        ///< grouped by leaf
    std::vector<CellCorner> corners;  ///< grouped by leaf
};

/// Places the walls on the edges of the cells, fills gaps with minisegs, and links partners.
LevelBsp lay_out(const Map& map, RawTree&& tree);

}  // namespace fase::level
