#pragma once
/// What one step did and how long each of its stages took.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace fase {

/// The stages of a step, in their order.
enum class Stage { Refresh, Pairs, Collide, Islands, Solve, Finish, Events, Sleep, Queries, Count };
inline constexpr std::size_t stage_count = static_cast<std::size_t>(Stage::Count);
inline constexpr std::array<std::string_view, stage_count> stage_names{
    "refresh", "pairs", "collide", "islands", "solve", "finish", "events", "sleep", "queries"};

/// Times in milliseconds of wall clock; counts as of the end of the step.
struct StepReport {
    std::uint64_t step = 0;                ///< 1 for the first
    std::array<double, stage_count> ms{};  ///< by Stage
    double total_ms = 0;
    std::uint32_t bodies = 0;  ///< all
    std::uint32_t awake = 0;   ///< dynamic and kinematic bodies that were stepped
    std::uint32_t asleep = 0;
    std::uint32_t boxes_moved = 0;       ///< boxes that left their grown box
    std::uint64_t candidates = 0;        ///< pairs the broad phase reported for them
    std::uint32_t pairs = 0;             ///< pairs of grown boxes kept, resting ones not counted
    std::uint32_t manifolds = 0;         ///< pairs that touch or are about to
    std::uint32_t manifolds_reused = 0;  ///< of these, kept from an earlier step
    std::uint32_t contact_points = 0;
    std::uint32_t colours = 0;        ///< groups that the solver works through one after the other
    std::uint32_t overflow = 0;       ///< contacts that fit no colour, solved one by one
    std::uint32_t islands = 0;        ///< awake islands
    std::uint64_t bytes = 0;          ///< memory the world holds
    std::uint32_t speed_clamped = 0;  ///< bodies held at a cap
    std::uint32_t pairs_dropped = 0;  ///< beyond Settings::max_pairs
    std::uint32_t quarantined = 0;    ///< bodies taken out of play in this step
    std::string_view structure;       ///< the broad phase in which awake boxes stand
    std::string_view reason;          ///< why it was chosen; empty when the user named it
};

}  // namespace fase
