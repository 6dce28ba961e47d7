#pragma once
/// The rules of generated traces: initial state and motion of bodies that fly and bounce but do not collide.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/core/random.hpp"
#include "fase/geometry/aabb.hpp"
#include "fase/record/generate_trace.hpp"
#include "fase/record/trace.hpp"

namespace fase::record {

/// One moving box.
struct TraceBody {
    Vec3 centre, half;   ///< m
    Vec3 velocity;       ///< m/s
    Vec3 target;         ///< the point that attracts it, or where it comes to rest
    bool rests = false;  ///< does not move
    std::uint8_t flags = 0;
};

/// The state of a generated trace. Rules use only + - * / and sqrt, so that all compilers give the same bits.
struct TraceState {
    std::vector<TraceBody> bodies;
    Aabb walls;         ///< no body leaves this box; Aabb::everything(): no walls
    float gravity = 0;  ///< m/s², down along y
    float bounce = 1;   ///< the fraction of the velocity that a wall reflects
    Random random;
    std::uint32_t frame = 0;  ///< the current frame
};

/// The rule of a kind of trace.
struct TraceRule {
    TraceKind kind;
    void (*begin)(TraceState& state, std::size_t count);
    void (*move)(TraceState& state);  ///< advances by one frame
};

/// Returns the rules of all kinds.
[[nodiscard]] std::span<const TraceRule> trace_rules();

}  // namespace fase::record
