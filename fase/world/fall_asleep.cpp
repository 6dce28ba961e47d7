/// Stage "sleep": islands in which all have rested long enough leave the step.
#include <algorithm>

#include "fase/world/state.hpp"

namespace fase {

void fall_asleep(WorldState& state, float) {
    // Kinematic bodies that stand still need no stepping, whatever the settings say.
    state.least_sleep.resize(state.bodies.traits.size());
    const auto& traits = state.bodies.traits;
    for (const std::uint32_t body : state.awake) state.least_sleep[state.bodies.motion[body].island] = Aabb::infinity;
    for (const std::uint32_t body : state.awake) {
        float& least = state.least_sleep[state.bodies.motion[body].island];
        least = std::min(least, state.bodies.motion[body].sleep_time);
    }
    std::vector<std::uint32_t> sleepers;
    for (const std::uint32_t body : state.awake) {
        const bool dynamic = traits[body].kind == BodyKind::Dynamic;
        if (dynamic && !state.settings.sleep) continue;
        if (state.least_sleep[state.bodies.motion[body].island] >= state.settings.time_to_sleep) sleepers.push_back(body);
    }
    if (sleepers.empty()) return;
    for (const std::uint32_t body : sleepers)
        if (const auto id = state.body_ids.id_at(body)) state.events.fell_asleep.push_back(*id);
    move_to_asleep(state, sleepers);
}

}  // namespace fase
