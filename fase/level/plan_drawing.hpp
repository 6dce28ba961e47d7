#pragma once
/// Draws the plan of a compiled level.
#include <optional>
#include <string>
#include <vector>

#include "fase/level/drawing.hpp"
#include "fase/level/map.hpp"

namespace fase::level {

/// Optional content of a plan.
struct PlanOptions {
    std::string title;                      ///< in the upper left corner
    std::string note;                       ///< after the title, smaller
    std::optional<Point> eye;               ///< marked, together with its sub-sector
    std::vector<std::uint32_t> seen;        ///< highlighted sub-sectors
    std::vector<std::vector<Point>> sight;  ///< polygons on the plan, highlighted more strongly
};

/// Draws walls dark, borders between sectors pale, sub-sectors in a tint of their sector, and partition lines from red
/// (the root) to violet (the deepest) where they separate sub-sectors; the first four over their entire cells. A legend
/// is at the bottom.
[[nodiscard]] Drawing draw_plan(const Map& map, const LevelBsp& bsp, const PlanOptions& options);

}  // namespace fase::level
