#pragma once
/// Where in a level a place lies.
#include <optional>

#include "fase/level/level_bsp.hpp"

namespace fase::level {

/// Twice the surface of the triangle a, b, c: above 0 when c lies to the left of the way from a to b. Turning the way
/// around turns the sign, to the bit.
[[nodiscard]] constexpr double turn(Point a, Point b, Point c) {
    // Differences from c: exact negation when a and b change places.
    return (a.x - c.x) * (b.y - c.y) - (a.y - c.y) * (b.x - c.x);
}

/// The sub-sector whose cell a place lies in; places outside the level are in one too. O(depth).
[[nodiscard]] inline std::uint32_t cell_at(const LevelBsp& bsp, Point p) {
    std::uint32_t at = bsp.root();
    while ((at & Node::leaf_bit) == 0) at = bsp.nodes[at].children[side_of(bsp.nodes[at], p)];
    return at & ~Node::leaf_bit;
}

/// Does the loop of a sub-sector go around the place? Edges belong to it, with 2^-20 map units and more around them.
[[nodiscard]] inline bool is_within(const LevelBsp& bsp, const SubSector& sub_sector, Point p) {
    for (const Seg& seg : bsp.edges(sub_sector)) {
        const Point a = bsp.vertices[seg.from], b = bsp.vertices[seg.to];
        const double along = (b.x > a.x ? b.x - a.x : a.x - b.x) + (b.y > a.y ? b.y - a.y : a.y - b.y);
        if (!(turn(a, b, p) <= along * 0x1p-20)) return false;  // nor what is no number
    }
    return sub_sector.edges > 0;
}

/// The sub-sector that a place lies in; nullopt outside the level.
[[nodiscard]] inline std::optional<std::uint32_t> sub_sector_at(const LevelBsp& bsp, Point p) {
    const std::uint32_t cell = cell_at(bsp, p);
    if (!is_within(bsp, bsp.sub_sectors[cell], p)) return std::nullopt;
    return cell;
}

/// The sector of the map that a place lies in; nullopt outside the level.
[[nodiscard]] inline std::optional<std::uint32_t> sector_at(const LevelBsp& bsp, Point p) {
    const auto place = sub_sector_at(bsp, p);
    if (!place) return std::nullopt;
    return bsp.sub_sectors[*place].sector;
}

/// The middle of a sub-sector's corners, which lies inside; of its walls' ends when it has no inside.
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
