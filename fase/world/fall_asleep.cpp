/// Stage "sleep": puts islands to sleep that have been at rest for long enough.
#include "fase/world/detail/state.hpp"

namespace fase {

void fall_asleep(WorldState& state, float) {
    const Settings& settings = state.settings;
    const float linear = 2 * settings.sleep_linear_speed, angular = 2 * settings.sleep_angular_speed;
    state.island_activity.resize(state.bodies.traits.size());
    for (const std::uint32_t body : state.awake) state.island_activity[state.bodies.motion[body].island] = {};
    for (const std::uint32_t body : state.awake) {
        const dynamics::BodyTraits& traits = state.bodies.traits[body];
        const dynamics::BodyMotion& motion = state.bodies.motion[body];
        IslandActivity& activity = state.island_activity[motion.island];
        ++activity.bodies;
        if (motion.sleep_time >= settings.time_to_sleep) continue;
        const bool slow = length_squared(motion.linear_velocity) < linear * linear &&
                          length_squared(motion.angular_velocity) < angular * angular;
        ++activity.active_bodies;
        activity.must_stay_awake |= !slow || !traits.can_sleep || traits.kind != BodyKind::Dynamic;
    }
    const auto may_sleep = [&](std::uint32_t island) {
        const IslandActivity& activity = state.island_activity[island];
        return activity.active_bodies == 0 ||
               (!activity.must_stay_awake && static_cast<float>(activity.active_bodies) <=
                                                 settings.sleep_tolerance * static_cast<float>(activity.bodies));
    };
    std::vector<std::uint32_t> sleepers;
    for (const std::uint32_t body : state.awake) {
        // Kinematic bodies without velocity need no step, so they sleep even when Settings::sleep is false.
        if (state.bodies.traits[body].kind == BodyKind::Dynamic && !settings.sleep) continue;
        if (may_sleep(state.bodies.motion[body].island)) sleepers.push_back(body);
    }
    if (sleepers.empty()) return;
    for (const std::uint32_t body : sleepers)
        if (const auto id = state.body_ids.id_at(body)) state.events.fell_asleep.push_back(*id);
    move_to_asleep(state, sleepers);
}

}  // namespace fase
