#pragma once
/// Internal access to the state of a World, for queries, tests and benchmarks.
#include "fase/world/detail/state.hpp"
#include "fase/world/world.hpp"

namespace fase {

/// Returns the state of a world; the reference is valid until the world is moved, restored or destroyed.
struct WorldStateAccess {
    [[nodiscard]] static WorldState& of(World& world) { return *world.state_; }
    [[nodiscard]] static const WorldState& of(const World& world) { return *world.state_; }
};

}  // namespace fase
