#pragma once
/// The reference check of compiled levels: measures how well a tree, from any compiler, fits the geometry of its map.
#include <cstddef>
#include <string>
#include <vector>

#include "fase/level/level_bsp.hpp"
#include "fase/level/map.hpp"

namespace fase::level {

/// The result of a check; lengths in map units. A tree is correct if the figures are no larger than rounding errors.
struct BspCheck {
    double bulge = 0;                ///< largest distance of a seg's end to the left of another seg of its sub-sector
    double outside_node = 0;         ///< largest distance of a seg's end on the wrong side of a partition line above it
    double outside_box = 0;          ///< largest distance of a seg's end outside the box that a node has for it
    double gaps = 0;                 ///< total length of sides that no seg covers
    double overlaps = 0;             ///< total length of sides that several segs cover
    std::size_t open_loops = 0;      ///< sub-sectors whose edges are not a closed chain
    std::size_t wrong_partners = 0;  ///< partners that do not have opposite ends, or do not refer to each other
    std::size_t openings = 0;        ///< minisegs without a partner
    std::size_t mixed = 0;           ///< sub-sectors with walls of several sectors
    std::size_t open_sectors = 0;    ///< sectors whose lines are not closed loops; their area is not measured
    /// |area of the sub-sectors - area by the lines| / area (at least one square unit) of the worst closed sector.
    /// Sub-sectors without edges are measured as cells of the tree. Mixed sectors are measured together: a loop of
    /// lines with the same sector on both sides, as in deep water, has no area by its lines.
    double area_error = 0;
    std::size_t worst_sector = 0;
    double total_area = 0;  ///< of all closed sectors, by their lines
};

/// Measures a tree with valid indices (from compile() or read_bsp()). O(n log n).
[[nodiscard]] BspCheck check_bsp(const Map& map, const LevelBsp& bsp);

/// Returns the area of each sector by its lines, in square units; a negative number if the lines are not closed loops.
[[nodiscard]] std::vector<double> sector_areas(const Map& map);

}  // namespace fase::level
