#pragma once
/// The output of `fase level` for maps.
#include <optional>
#include <string>
#include <vector>

#include "cli/level/sight.hpp"
#include "fase/level/check_bsp.hpp"

namespace fase::cli {

/// The sub-sector and the sector at a point of the plan.
struct PlanPlace {
    level::Point point;
    std::uint32_t sub_sector = 0, sector = 0;
    int floor = 0, ceiling = 0;
    bool inside = false;  ///< whether the point is inside the sub-sector, not behind its walls
};
[[nodiscard]] PlanPlace place_of(const level::Map& map, const level::LevelBsp& bsp, level::Point point);

/// The figures of one map.
struct LevelRow {
    std::string map, note;  ///< note: why the map was skipped
    level::BspStats stats;
    std::size_t nodes = 0, sub_sectors = 0;
    double ms = 0;
    std::optional<level::BspCheck> check;
    std::optional<PlanPlace> place;
    std::optional<SightReport> sight;
};

/// Splits divided by sides.
[[nodiscard]] double share_of_splits(const level::BspStats& stats);
/// Whether a tree is correct: the measured errors are within the rounding of its lumps (one unit), and areas within
/// 1e-4 unless its split points are rounded to whole units.
[[nodiscard]] bool is_good(const LevelRow& row);
[[nodiscard]] bool all_good(const std::vector<LevelRow>& rows);

/// One JSON object, or with `all` a list of the objects of all maps.
[[nodiscard]] std::string to_json(const std::vector<LevelRow>& rows, bool all);
/// Lines for one map, or with `all` a table of all maps and their sum. @param ms total time
[[nodiscard]] std::string to_text(const std::vector<LevelRow>& rows, bool all, double ms);

}  // namespace fase::cli
