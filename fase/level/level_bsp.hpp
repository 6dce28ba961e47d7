#pragma once
/// A level, split into convex pieces by a tree of partition lines.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/core/no_index.hpp"

namespace fase::level {

/// A point of the plan, in map units.
struct Point {
    double x = 0, y = 0;
    friend constexpr bool operator==(Point, Point) = default;
};

/// A rectangle of the plan, edges included; empty if lo > hi.
struct PlanBox {
    Point lo{1e30, 1e30}, hi{-1e30, -1e30};
    [[nodiscard]] constexpr bool contains(Point p) const {
        return lo.x <= p.x && p.x <= hi.x && lo.y <= p.y && p.y <= hi.y;
    }
    constexpr void add(Point p) {
        lo = {p.x < lo.x ? p.x : lo.x, p.y < lo.y ? p.y : lo.y};
        hi = {p.x > hi.x ? p.x : hi.x, p.y > hi.y ? p.y : hi.y};
    }
    constexpr void add(const PlanBox& box) {
        if (box.lo.x > box.hi.x) return;
        add(box.lo);
        add(box.hi);
    }
    friend constexpr bool operator==(const PlanBox&, const PlanBox&) = default;
};

/// One edge of a sub-sector, or a piece of wall inside it. Its sub-sector is on the right of the direction from `from`
/// to `to`.
struct Seg {
    std::uint32_t from = 0, to = 0;  ///< vertices of the LevelBsp; different
    /// Index of the map's line. no_index: a miniseg, a piece of a partition line without a line of the map on it, where
    /// the level is open between two sub-sectors.
    std::uint32_t line = no_index;
    /// The seg on the other side, from `to` to `from`, an edge of the neighbouring sub-sector. no_index: one-sided
    /// walls, outliers, and open edges of sectors that are not closed. Partners can have different lines if lines of
    /// the map overlap.
    std::uint32_t partner = no_index;
    std::uint32_t sub_sector = 0;
    bool left = false;  ///< on the left side of the line, in the opposite direction
    /// Map units from the start of the line's side (the line's `from`; for the left side its `to`); 0 for minisegs.
    double offset = 0;
};

/// A convex piece of the level; no wall crosses its interior.
struct SubSector {
    std::uint32_t first = 0;  ///< index of its first seg
    std::uint32_t edges = 0;  ///< number of segs from `first` on that are a closed loop, clockwise (y to the north);
                              ///< `to` of one is `from` of the next. At least 3, or 0 if the walls enclose no interior
    std::uint32_t outliers = 0;  ///< number of segs after the edges: walls that overlap others and are not in the loop
    std::uint32_t sector = 0;    ///< index of the map's sector
};

/// A partition line and its two children.
struct Node {
    std::int32_t x = 0, y = 0;    ///< a point of the line
    std::int32_t dx = 0, dy = 0;  ///< its direction; not both 0
    /// Right and left side: the index of a node, or leaf_bit | the index of a sub-sector.
    std::uint32_t children[2] = {0, 0};
    PlanBox boxes[2];  ///< around all segs of each child

    static constexpr std::uint32_t leaf_bit = 0x80000000;
};

/// Statistics of a compilation.
struct BspStats {
    std::size_t lines = 0;      ///< of the map, without those of zero length
    std::size_t sides = 0;      ///< of these lines: the segs before any split
    std::size_t wall_segs = 0;  ///< after all splits; as in the classic format, without splits at neighbours' corners
    std::size_t splits = 0;     ///< wall_segs - sides
    std::size_t minisegs = 0;   ///< segs without a line
    double mean_depth = 0;      ///< nodes above a sub-sector, mean of all sub-sectors
    std::size_t worst_depth = 0;
};

/// A map's tree. It has the content of GL nodes; the classic lumps NODES, SEGS and SSECTORS are the same without
/// minisegs.
/// Source of the idea: Fuchs, Kedem, Naylor 1980, On visible surface generation by a priori tree structures; of the
/// form: Apted 2000–2004, GL nodes specification.
struct LevelBsp {
    std::vector<Point> vertices;  ///< the map's vertices with the same indices, then the points where lines were split
    std::size_t map_vertices = 0;
    std::vector<Seg> segs;  ///< sorted by sub-sector
    std::vector<SubSector> sub_sectors;
    std::vector<Node> nodes;  ///< children before parents; the root is the last
    BspStats stats;

    /// Returns the root as a child, as in Node::children. There is always at least one sub-sector.
    [[nodiscard]] std::uint32_t root() const {
        return nodes.empty() ? Node::leaf_bit : static_cast<std::uint32_t>(nodes.size() - 1);
    }
    [[nodiscard]] std::span<const Seg> edges(const SubSector& s) const { return {segs.data() + s.first, s.edges}; }
    [[nodiscard]] std::span<const Seg> outliers(const SubSector& s) const {
        return {segs.data() + s.first + s.edges, s.outliers};
    }
};

/// Returns a positive number if the point is to the left of the node's line, a negative one to its right. Rounds once
/// or twice: within a 2^-19th of a unit around the line, the sign can be either.
[[nodiscard]] constexpr double side_value(const Node& node, Point p) {
    return node.dx * (p.y - node.y) - node.dy * (p.x - node.x);
}
/// Returns the child on whose side a point is: 0 for right, 1 for left and on the line, as in the game.
[[nodiscard]] constexpr int side_of(const Node& node, Point p) { return side_value(node, p) >= 0 ? 1 : 0; }

}  // namespace fase::level
