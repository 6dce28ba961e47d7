#pragma once
/// What is seen in a level: from a point, and from anywhere in each sub-sector.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fase/core/tasks.hpp"
#include "fase/level/find_visible.hpp"
#include "fase/level/seen_from.hpp"

namespace fase::cli {

/// What to look for.
struct SightWish {
    std::optional<level::Point> point;
    bool sets = false;
    level::Heights heights = level::Heights::Ignored;
    std::uint64_t rays = 0;  ///< sight rays that sets are held against
};

/// What was found.
struct SightReport {
    std::optional<level::SeenFrom> from_point;  ///< nothing when the point lies outside
    std::optional<level::VisibleStats> sets;
    std::vector<std::uint32_t> from_cell;  ///< with a point and sets: what its sub-sector sees
    double ms = 0;                         ///< that finding the sets took
    std::uint64_t rays = 0, passages = 0;  ///< rays cast, and sub-sectors that they passed through
    std::uint64_t falsely_hidden = 0;      ///< of the passages: into what the sets hide
};

/// Looks from the point, at the height of eyes over the floor, and finds the sets; errors of find_visible().
Result<SightReport> look_around(const level::Map& map, const level::LevelBsp& bsp, const SightWish& wish,
                                TaskRunner& tasks);

/// Members of a JSON object, each behind a comma.
[[nodiscard]] std::string to_json(const SightReport& report);
/// Lines, indented.
[[nodiscard]] std::string to_text(const SightReport& report);

}  // namespace fase::cli
