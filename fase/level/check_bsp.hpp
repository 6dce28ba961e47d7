#pragma once
/// The judge of compiled levels: does a tree, ours or another compiler's, make sense on the plan?
#include <cstddef>
#include <string>
#include <vector>

#include "fase/level/level_bsp.hpp"
#include "fase/level/map.hpp"

namespace fase::level {

/// What was found; lengths in map units. All is well when the figures are as small as rounding makes them.
struct BspCheck {
    double bulge = 0;                ///< how far an end of a seg lies to the left of another seg of its sub-sector
    double outside_node = 0;         ///< how far an end of a seg lies on the wrong side of a partition line above it
    double outside_box = 0;          ///< how far one lies outside a node's box for it
    double gaps = 0;                 ///< lengths of sides that no seg covers, summed
    double overlaps = 0;             ///< lengths of sides that several segs cover, summed
    std::size_t open_loops = 0;      ///< sub-sectors with edges of which one does not begin where the last one ends
    std::size_t wrong_partners = 0;  ///< partners that do not go the opposite way, or are not each other's
    std::size_t openings = 0;        ///< minisegs without a partner
    std::size_t mixed = 0;           ///< sub-sectors with walls of several sectors
    std::size_t open_sectors = 0;    ///< sectors whose lines are no closed loops: not measured
    /// |area of a sector's sub-sectors - area by its lines| of the closed sector where it is worst, as a share of the
    /// area (of at least one square unit); sub-sectors without edges are measured as cells of the tree. Sectors that
    /// are mixed are measured together: a loop of lines with the same sector on both sides, as in deep water, has no
    /// area by its lines, though it is there.
    double area_error = 0;
    std::size_t worst_sector = 0;
    double whole_area = 0;  ///< of all closed sectors, by their lines
};

/// Measures a tree whose indices are good (LevelBsp of compile() or read_bsp()). Takes time n log n.
[[nodiscard]] BspCheck check_bsp(const Map& map, const LevelBsp& bsp);

/// The area of each sector by its lines, in square units; of sectors that are no closed loops a number below 0.
[[nodiscard]] std::vector<double> sector_areas(const Map& map);

}  // namespace fase::level
