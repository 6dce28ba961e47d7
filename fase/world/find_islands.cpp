/// Stage "islands": wakes bodies that are touched, and unites touching bodies into islands.
#include <algorithm>

#include "fase/world/detail/state.hpp"

namespace fase {

using dynamics::BodyTraits;
using dynamics::Constraint;
using dynamics::Moves;

namespace {

/// The speed at which the bodies close their gap, m/s; negative: they part.
float closing_speed(const WorldState& state, const Constraint& c) {
    const dynamics::BodyMotion& a = state.bodies.motion[c.body_a];
    const dynamics::BodyMotion& b = state.bodies.motion[c.body_b];
    const dynamics::ContactManifold& manifold = state.manifolds[c.index];
    return dot(a.linear_velocity + cross(a.angular_velocity, manifold.offset_a) - b.linear_velocity -
                   cross(b.angular_velocity, manifold.offset_b),
               manifold.normal);
}

/// Wakes sleepers that a moving kinematic body touches, that a dynamic one begins to touch, and those behind a blow.
/// What a dynamic body already touches wakes in the stage "sleep".
void wake_touched(WorldState& state, const Constraint& c, float seconds) {
    const auto is_asleep = [&](std::uint32_t body) {
        return state.bodies.traits[body].motion_state == MotionState::Asleep &&
               state.bodies.traits[body].kind == BodyKind::Dynamic;
    };
    const float speed = closing_speed(state, c);
    const bool near = c.touches || speed * seconds >= state.contacts[c.owner].nearest;
    if (!near) return;
    const bool is_blow = speed > 2 * state.settings.sleep_linear_speed;
    for (const auto& [mover, other] : {std::pair{c.body_a, c.body_b}, std::pair{c.body_b, c.body_a}}) {
        const BodyTraits& traits = state.bodies.traits[mover];
        if (traits.motion_state != MotionState::Awake || state.bodies.traits[other].kind != BodyKind::Dynamic) continue;
        if (traits.kind == BodyKind::Kinematic) {
            if (is_moving(state.bodies.motion[mover]) && is_asleep(other)) request_wake(state, other);
        } else if (is_blow) {
            state.blows.push_back({other, traits.mass.mass * speed});
        } else if (c.began && is_asleep(other)) {
            state.blows.push_back({other, 0});
        }
    }
}

}  // namespace

void find_islands(WorldState& state, float seconds) {
    state.blows.clear();
    if (!state.asleep.bodies.empty())
        for (const Constraint& constraint : state.constraints) wake_touched(state, constraint, seconds);
    const std::size_t before = state.awake.size();
    for (const Blow& blow : state.blows) wake_struck(state, blow.body, blow.momentum);
    wake_requested_islands(state);
    // Woken bodies add their resting contacts, which are still valid because nothing has moved since.
    if (state.awake.size() != before) gather_constraints(state);

    state.sets.reset(state.bodies.traits.size());
    const auto moving_kinematic = [&](std::uint32_t body) {
        return state.bodies.traits[body].kind == BodyKind::Kinematic && is_moving(state.bodies.motion[body]);
    };
    for (const Constraint& c : state.constraints) {
        if (!c.touches) continue;
        if (c.moves == Moves::Both) {
            state.sets.unite(c.body_a, c.body_b);
        } else if (moving_kinematic(c.body_a)) {
            state.bodies.motion[c.body_b].sleep_time = 0;
        } else if (moving_kinematic(c.body_b)) {
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
