#pragma once
/// What `fase level` tells of maps.
#include <optional>
#include <string>
#include <vector>

#include "cli/level/sight.hpp"
#include "fase/level/check_bsp.hpp"

namespace fase::cli {

/// Where a point of the plan is.
struct PlanPlace {
    level::Point point;
    std::uint32_t sub_sector = 0, sector = 0;
    int floor = 0, ceiling = 0;
    bool inside = false;  ///< of the sub-sector, not beyond its walls
};
[[nodiscard]] PlanPlace place_of(const level::Map& map, const level::LevelBsp& bsp, level::Point point);

/// One map.
struct LevelRow {
    std::string map, note;  ///< note: why it was left out
    level::BspStats stats;
    std::size_t nodes = 0, sub_sectors = 0;
    double ms = 0;
    std::optional<level::BspCheck> check;
    std::optional<PlanPlace> place;
    std::optional<SightReport> sight;
};

/// Splits as a share of the sides.
[[nodiscard]] double share_of_splits(const level::BspStats& stats);
/// Whether a tree is right: what is measured stays within what its lumps round (one unit), areas within 1e-4 when its
/// cut points are not rounded to whole units.
[[nodiscard]] bool is_good(const LevelRow& row);
[[nodiscard]] bool all_good(const std::vector<LevelRow>& rows);

/// An object of one map, a list of all.
[[nodiscard]] std::string to_json(const std::vector<LevelRow>& rows, bool all);
/// Lines of one map, a table of all with their sum. @param ms time of all together
[[nodiscard]] std::string to_text(const std::vector<LevelRow>& rows, bool all, double ms);

}  // namespace fase::cli
