#pragma once
/// A level cut into convex pieces by a tree of partition lines.
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fase::level {

/// A place on the plan, in map units.
struct Point {
    double x = 0, y = 0;
    friend constexpr bool operator==(Point, Point) = default;
};

/// A rectangle on the plan, its edges belong to it; empty while lo > hi.
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

/// The line of a miniseg.
inline constexpr std::uint32_t no_line = 0xffffffff;
/// The partner of a seg that has nothing behind it.
inline constexpr std::uint32_t no_seg = 0xffffffff;

/// One edge of a sub-sector, or a piece of wall that lies in it. Its sub-sector is on the right of the way from `from`
/// to `to`.
struct Seg {
    std::uint32_t from = 0, to = 0;  ///< vertices of the LevelBsp; they differ
    /// Of the map; no_line: a miniseg, that is a piece of a partition line with no line of the map on it, where one
    /// walks from one sub-sector into the next.
    std::uint32_t line = no_line;
    /// The seg on the other side, from `to` to `from`, an edge of the neighbouring sub-sector. no_seg: one-sided walls,
    /// strays, and openings into nowhere of sectors that are not closed. Partners may have different lines where lines
    /// of the map lie over each other.
    std::uint32_t partner = no_seg;
    std::uint32_t sub_sector = 0;
    bool left = false;  ///< of the line: lies on its left side, and goes against it
    /// Map units from the corner where the line's side begins (its `from`; for the left side its `to`); 0 for minisegs.
    double offset = 0;
};

/// A convex piece of the level, none of whose inside is cut by a wall.
struct SubSector {
    std::uint32_t first = 0;  ///< of its segs
    std::uint32_t edges = 0;  ///< so many from `first` on are a closed loop, clockwise (y to the north), `to` of one is
                              ///< `from` of the next; 0 or at least 3, 0 only where all its walls have no inside
    std::uint32_t outliers = 0;  ///< so many behind them are walls that the loop has no place for: they lie over others
    std::uint32_t sector = 0;    ///< of the map
};

/// A partition line and what lies on either side of it.
struct Node {
    std::int32_t x = 0, y = 0;    ///< a point of the line
    std::int32_t dx = 0, dy = 0;  ///< its direction; not both 0
    /// Right and left side: indices of nodes, or leaf_bit | index of a sub-sector.
    std::uint32_t children[2] = {0, 0};
    PlanBox boxes[2];  ///< around all segs of each child

    static constexpr std::uint32_t leaf_bit = 0x80000000;
};

/// What a compilation came to.
struct BspStats {
    std::size_t lines = 0;      ///< of the map, those of zero length left out
    std::size_t sides = 0;      ///< of these lines: segs before any was cut
    std::size_t wall_segs = 0;  ///< after: as in the classic format, cuts that only neighbours need not counted
    std::size_t splits = 0;     ///< wall_segs - sides
    std::size_t minisegs = 0;   ///< no_line
    double mean_depth = 0;      ///< nodes above a sub-sector, mean of all sub-sectors
    std::size_t worst_depth = 0;
};

/// A map and its tree. GL nodes are this; the classic lumps NODES, SEGS and SSECTORS are this without minisegs.
/// Source of the idea: Fuchs, Kedem, Naylor 1980, On visible surface generation by a priori tree structures; of the
/// form: Apted 2000–2004, GL nodes specification.
struct LevelBsp {
    std::vector<Point> vertices;  ///< the map's own with their indices, then the points where lines were cut
    std::size_t map_vertices = 0;
    std::vector<Seg> segs;  ///< by sub-sector
    std::vector<SubSector> sub_sectors;
    std::vector<Node> nodes;  ///< each behind its children; the root is the last
    BspStats stats;

    /// Where to begin: a child as in Node::children. There is always at least one sub-sector.
    [[nodiscard]] std::uint32_t root() const {
        return nodes.empty() ? Node::leaf_bit : static_cast<std::uint32_t>(nodes.size() - 1);
    }
    [[nodiscard]] std::span<const Seg> edges(const SubSector& s) const { return {segs.data() + s.first, s.edges}; }
    [[nodiscard]] std::span<const Seg> outliers(const SubSector& s) const {
        return {segs.data() + s.first + s.edges, s.outliers};
    }
};

/// Above 0 when the point lies to the left of the node's line, below 0 to its right. Rounds once or twice: for places
/// within a 2^-19th of a unit around the line the sign may be either.
[[nodiscard]] constexpr double side_value(const Node& node, Point p) {
    return node.dx * (p.y - node.y) - node.dy * (p.x - node.x);
}
/// The child on whose side a point lies: 0 right, 1 left and on the line, as in the game.
[[nodiscard]] constexpr int side_of(const Node& node, Point p) { return side_value(node, p) >= 0 ? 1 : 0; }

}  // namespace fase::level
