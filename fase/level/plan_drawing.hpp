#pragma once
/// The plan of a compiled level, drawn.
#include <optional>
#include <string>
#include <vector>

#include "fase/level/detail/drawing.hpp"
#include "fase/level/map.hpp"

namespace fase::level {

/// What is shown beside the plan itself.
struct PlanLook {
    std::string title;                      ///< in the upper left corner
    std::string note;                       ///< behind it, smaller
    std::optional<Point> eye;               ///< marked, with the sub-sector that it is in
    std::vector<std::uint32_t> seen;        ///< sub-sectors that are lit
    std::vector<std::vector<Point>> sight;  ///< polygons on the plan that are lit more
};

/// Walls dark, borders between sectors pale, sub-sectors tinted by their sector, partition lines from red (the root) to
/// violet (the deepest) where they part sub-sectors, the first four right across; a legend below.
[[nodiscard]] Drawing draw_plan(const Map& map, const LevelBsp& bsp, const PlanLook& look);

}  // namespace fase::level
