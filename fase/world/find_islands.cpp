/// Stage "islands": wakes bodies that are touched, and unites touching bodies into islands.
#include <algorithm>

#include "fase/world/detail/state.hpp"

namespace fase {

using dynamics::BodyTraits;
using dynamics::Contact;

namespace {

bool is_moving(const dynamics::BodyMotion& motion) {
    return length_squared(motion.linear_velocity) > 0 || length_squared(motion.angular_velocity) > 0;
}

/// Whether the bodies touch in this step: now, or because they close their gap within `seconds`.
bool will_touch(const WorldState& state, const Contact& c, float seconds) {
    const float gap = c.nearest;
    if (gap <= state.settings.linear_slop) return true;
    const dynamics::BodyMotion& a = state.bodies.motion[c.body_a];
    const dynamics::BodyMotion& b = state.bodies.motion[c.body_b];
    const Vec3 relative = a.linear_velocity + cross(a.angular_velocity, c.offset_a) - b.linear_velocity -
                          cross(b.angular_velocity, c.offset_b);
    return dot(relative, c.normal) * seconds >= gap;
}

}  // namespace

void find_islands(WorldState& state, float seconds) {
    for (const std::uint32_t index : state.touching) {
        const Contact& c = state.contacts[index];
        const BodyTraits& a = state.bodies.traits[c.body_a];
        const BodyTraits& b = state.bodies.traits[c.body_b];
        if (a.motion_state == b.motion_state || !will_touch(state, c, seconds)) continue;
        // Only a body that is not static wakes another: a moving kinematic one, or a dynamic one.
        if (a.kind != BodyKind::Static && b.kind == BodyKind::Dynamic && b.motion_state == MotionState::Asleep)
            request_wake(state, c.body_b);
        if (b.kind != BodyKind::Static && a.kind == BodyKind::Dynamic && a.motion_state == MotionState::Asleep)
            request_wake(state, c.body_a);
    }
    if (!state.bodies_to_wake.empty()) {
        wake_requested_islands(state);
        // Woken bodies add their resting contacts, which are still valid because nothing has moved since.
        state.touching.clear();
        for (const std::uint32_t index : state.active.values)
            if (state.contacts[index].count > 0 && !state.contacts[index].sensor) state.touching.push_back(index);
    }

    state.sets.reset(state.bodies.traits.size());
    for (const std::uint32_t index : state.touching) {
        const Contact& c = state.contacts[index];
        const BodyTraits& a = state.bodies.traits[c.body_a];
        const BodyTraits& b = state.bodies.traits[c.body_b];
        const bool both = a.kind == BodyKind::Dynamic && b.kind == BodyKind::Dynamic;
        const bool touches = c.touching || c.nearest <= state.settings.linear_slop;
        if (!touches) continue;
        if (both && a.motion_state == MotionState::Awake && b.motion_state == MotionState::Awake) {
            state.sets.unite(c.body_a, c.body_b);
        } else if (a.kind == BodyKind::Kinematic && is_moving(state.bodies.motion[c.body_a])) {
            state.bodies.motion[c.body_b].sleep_time = 0;
        } else if (b.kind == BodyKind::Kinematic && is_moving(state.bodies.motion[c.body_b])) {
            state.bodies.motion[c.body_a].sleep_time = 0;
        }
    }
    for (const std::uint32_t body : state.awake) {
        const std::uint32_t island = state.sets.find(body);
        state.bodies.motion[body].island = island;
        state.report.islands += island == body ? 1 : 0;
    }
}

}  // namespace fase
