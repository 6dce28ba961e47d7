#pragma once
/// Visibility in a level: from a point, and between sub-sectors.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fase/core/tasks.hpp"
#include "fase/level/find_visible.hpp"
#include "fase/level/seen_from.hpp"

namespace fase::cli {

/// What to compute.
struct SightOptions {
    std::optional<level::Point> point;
    bool sets = false;  ///< the visible set of each sub-sector
    level::Heights heights = level::Heights::Ignored;
    std::uint64_t rays = 0;  ///< sight rays that check the sets
};

/// The results.
struct SightReport {
    std::optional<level::SeenFrom> from_point;  ///< empty if the point is outside the level
    std::optional<level::VisibleStats> sets;
    std::vector<std::uint32_t> from_cell;  ///< with a point and sets: the visible set of its sub-sector
    double ms = 0;                         ///< time to compute the sets
    std::uint64_t rays = 0, passages = 0;  ///< rays cast, and sub-sectors they passed through
    std::uint64_t falsely_hidden = 0;      ///< passages into sub-sectors that the sets call hidden
};

/// Computes the visibility from the point, at eye height above the floor, and the sets. Errors of find_visible().
Result<SightReport> look_around(const level::Map& map, const level::LevelBsp& bsp, const SightOptions& options,
                                TaskRunner& tasks);

/// Members of a JSON object, each after a comma.
[[nodiscard]] std::string to_json(const SightReport& report);
/// Indented lines.
[[nodiscard]] std::string to_text(const SightReport& report);

}  // namespace fase::cli
