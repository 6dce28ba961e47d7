#pragma once
/// Counts and times of one step.
#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace fase {

/// The stages of a step, in order.
enum class Stage { Refresh, Pairs, Collide, Islands, Solve, Finish, Events, Sleep, Queries, Count };
inline constexpr std::size_t stage_count = static_cast<std::size_t>(Stage::Count);
inline constexpr std::array<std::string_view, stage_count> stage_names{
    "refresh", "pairs", "collide", "islands", "solve", "finish", "events", "sleep", "queries"};

/// Times are wall-clock milliseconds; counts are those at the end of the step.
struct StepReport {
    std::uint64_t step = 0;                ///< 1 for the first
    std::array<double, stage_count> ms{};  ///< by Stage
    double total_ms = 0;
    std::uint32_t bodies = 0;  ///< all
    std::uint32_t awake = 0;   ///< dynamic and kinematic bodies that were stepped
    std::uint32_t asleep = 0;
    /// Awake dynamic bodies without a mass, which nothing moves: they lack a collider with a density, or BodyDef::mass.
    std::uint32_t without_mass = 0;
    std::uint32_t boxes_moved = 0;       ///< colliders that left their fat box
    std::uint64_t candidates = 0;        ///< pairs that the broad phase reported for them
    std::uint32_t pairs = 0;             ///< active pairs of fat boxes; resting pairs are not counted
    std::uint32_t manifolds = 0;         ///< pairs with contact points: they touch or are about to
    std::uint32_t manifolds_reused = 0;  ///< manifolds reused from an earlier step
    std::uint32_t contact_points = 0;
    std::uint32_t colours = 0;        ///< graph colours, which the solver processes sequentially
    std::uint32_t overflow = 0;       ///< contacts of bodies with more contacts than colours, solved in order
    std::uint32_t islands = 0;        ///< awake islands
    std::uint64_t bytes = 0;          ///< memory that the world has allocated
    std::uint32_t speed_clamped = 0;  ///< bodies whose speed was clamped
    std::uint32_t pairs_dropped = 0;  ///< dropped because of Settings::max_pairs
    std::uint32_t quarantined = 0;    ///< bodies quarantined in this step
    std::uint32_t left_world = 0;     ///< of these: bodies that went beyond 1e7 m; they stay at the border
    std::string_view structure;       ///< the broad-phase structure of the awake boxes
    std::string_view reason;          ///< why it was chosen; empty when the user named it
};

}  // namespace fase
