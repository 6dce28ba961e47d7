#pragma once
/// How the boxes of made traces begin and how they move: bodies that fly and bounce, without meeting each other.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/core/random.hpp"
#include "fase/geometry/aabb.hpp"
#include "fase/record/generate_trace.hpp"
#include "fase/record/trace.hpp"

namespace fase::record {

/// One box on its way.
struct TraceBody {
    Vec3 at, half;       ///< middle, half sizes; m
    Vec3 velocity;       ///< m/s
    Vec3 goal;           ///< where it is drawn to, or comes to rest
    bool rests = false;  ///< does not move
    std::uint8_t flags = 0;
};

/// All boxes, and what moves them. Only + - * / and sqrt, so that all compilers agree.
struct TraceStage {
    std::vector<TraceBody> bodies;
    Aabb room;          ///< that none leaves; everything: no walls
    float gravity = 0;  ///< m/s², down along y
    float bounce = 1;   ///< how much of a velocity comes back from a wall
    Random random;
    std::uint32_t frame = 0;  ///< that is being made
};

/// A kind with its rule.
struct TraceRule {
    TraceKind kind;
    void (*begin)(TraceStage& stage, std::size_t count);
    void (*move)(TraceStage& stage);  ///< on by a frame
};

[[nodiscard]] std::span<const TraceRule> trace_rules();

}  // namespace fase::record
