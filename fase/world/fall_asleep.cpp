/// Stage "sleep": islands in which all have rested long enough leave the step.
#include "fase/world/detail/state.hpp"

namespace fase {

void fall_asleep(WorldState& state, float) {
    const Settings& settings = state.settings;
    const float linear = 2 * settings.sleep_linear_speed, angular = 2 * settings.sleep_angular_speed;
    state.island_rest.resize(state.bodies.traits.size());
    for (const std::uint32_t body : state.awake) state.island_rest[state.bodies.motion[body].island] = {};
    for (const std::uint32_t body : state.awake) {
        const dynamics::BodyTraits& traits = state.bodies.traits[body];
        const dynamics::BodyMotion& motion = state.bodies.motion[body];
        IslandRest& rest = state.island_rest[motion.island];
        ++rest.bodies;
        if (motion.sleep_time >= settings.time_to_sleep) continue;
        const bool slow = length_squared(motion.linear_velocity) < linear * linear &&
                          length_squared(motion.angular_velocity) < angular * angular;
        ++rest.restless;
        rest.forbidden |= !slow || !traits.can_sleep || traits.kind != BodyKind::Dynamic;
    }
    const auto rests = [&](std::uint32_t island) {
        const IslandRest& rest = state.island_rest[island];
        return rest.restless == 0 ||
               (!rest.forbidden &&
                static_cast<float>(rest.restless) <= settings.sleep_tolerance * static_cast<float>(rest.bodies));
    };
    std::vector<std::uint32_t> sleepers;
    for (const std::uint32_t body : state.awake) {
        // Kinematic bodies that stand still need no stepping, whatever the settings say.
        if (state.bodies.traits[body].kind == BodyKind::Dynamic && !settings.sleep) continue;
        if (rests(state.bodies.motion[body].island)) sleepers.push_back(body);
    }
    if (sleepers.empty()) return;
    for (const std::uint32_t body : sleepers)
        if (const auto id = state.body_ids.id_at(body)) state.events.fell_asleep.push_back(*id);
    move_to_asleep(state, sleepers);
}

}  // namespace fase
