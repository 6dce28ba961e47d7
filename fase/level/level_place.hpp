#pragma once
/// Point location in a level.
#include <optional>

#include "fase/level/level_bsp.hpp"

namespace fase::level {

/// Returns the point at `share` of the way from a to b.
[[nodiscard]] constexpr Point between(Point a, Point b, double share) {
    return {a.x + (b.x - a.x) * share, a.y + (b.y - a.y) * share};
}

/// Returns twice the signed area of the triangle a, b, c: positive if c is to the left of the line from a to b.
/// Swapping a and b negates the result exactly.
[[nodiscard]] constexpr double orient2d(Point a, Point b, Point c) {
    // Differences from c: this makes the negation exact.
    return (a.x - c.x) * (b.y - c.y) - (a.y - c.y) * (b.x - c.x);
}

/// Returns the sub-sector whose cell contains a point; cells also cover points outside the level. O(depth).
[[nodiscard]] inline std::uint32_t cell_at(const LevelBsp& bsp, Point p) {
    std::uint32_t child = bsp.root();
    while ((child & Node::leaf_bit) == 0) child = bsp.nodes[child].children[side_of(bsp.nodes[child], p)];
    return child & ~Node::leaf_bit;
}

/// Returns whether a point is inside the loop of a sub-sector. Edges are inside, with a margin of 2^-20 map units or
/// more.
[[nodiscard]] inline bool is_within(const LevelBsp& bsp, const SubSector& sub_sector, Point p) {
    for (const Seg& seg : bsp.edges(sub_sector)) {
        const Point a = bsp.vertices[seg.from], b = bsp.vertices[seg.to];
        const double length = (b.x > a.x ? b.x - a.x : a.x - b.x) + (b.y > a.y ? b.y - a.y : a.y - b.y);
        if (!(orient2d(a, b, p) <= length * 0x1p-20)) return false;  // also for NaN
    }
    return sub_sector.edges > 0;
}

/// Returns the sub-sector that contains a point; nullopt outside the level.
[[nodiscard]] inline std::optional<std::uint32_t> sub_sector_at(const LevelBsp& bsp, Point p) {
    const std::uint32_t cell = cell_at(bsp, p);
    if (!is_within(bsp, bsp.sub_sectors[cell], p)) return std::nullopt;
    return cell;
}

/// Returns the sector of the map that contains a point; nullopt outside the level.
[[nodiscard]] inline std::optional<std::uint32_t> sector_at(const LevelBsp& bsp, Point p) {
    const auto sub_sector = sub_sector_at(bsp, p);
    if (!sub_sector) return std::nullopt;
    return bsp.sub_sectors[*sub_sector].sector;
}

/// Returns the mean of a sub-sector's corners, which is inside it; the mean of the ends of its walls if it has no
/// interior.
[[nodiscard]] inline Point middle_of(const LevelBsp& bsp, const SubSector& sub_sector) {
    Point sum;
    const std::uint32_t count = sub_sector.edges > 0 ? sub_sector.edges : sub_sector.outliers;
    for (std::uint32_t i = sub_sector.first; i < sub_sector.first + count; ++i) {
        sum.x += bsp.vertices[bsp.segs[i].from].x / count;
        sum.y += bsp.vertices[bsp.segs[i].from].y / count;
    }
    return sum;
}

}  // namespace fase::level
