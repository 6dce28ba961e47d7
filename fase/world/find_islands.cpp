/// Stage "islands": wakes bodies that are touched, and unites touching bodies into islands.
#include <algorithm>

#include "fase/world/detail/stages.hpp"

namespace fase {

using dynamics::BodyTraits;
using dynamics::Constraint;
using dynamics::Moves;

namespace {

/// The speed at which the bodies close their gap, m/s; negative: they part.
float closing_speed(const BodyTable& bodies, const dynamics::ManifoldPool& manifolds, const Constraint& c) {
    const dynamics::BodyMotion& a = bodies.motion[c.body_a];
    const dynamics::BodyMotion& b = bodies.motion[c.body_b];
    const dynamics::ContactManifold& manifold = manifolds[c.index];
    return dot(a.linear_velocity + cross(a.angular_velocity, manifold.offset_a) - b.linear_velocity -
                   cross(b.angular_velocity, manifold.offset_b),
               manifold.normal);
}

/// Requests what wakes at one constraint: sleepers that a moving kinematic body touches, that a dynamic one begins to
/// touch, and those behind a blow. What a dynamic body already touches wakes in the stage "sleep".
void wake_at(const StepContext& context, const ContactTable& contacts, const Constraint& c, BodyTable& bodies,
             std::vector<Blow>& blows) {
    const auto is_asleep = [&](std::uint32_t body) {
        return bodies.traits[body].motion_state == MotionState::Asleep && bodies.traits[body].kind == BodyKind::Dynamic;
    };
    const float speed = closing_speed(bodies, contacts.manifolds, c);
    const bool near = c.touches || speed * context.seconds >= contacts[c.owner].nearest;
    if (!near) return;
    const bool is_blow = speed > 2 * context.settings.sleep_linear_speed;
    for (const auto& [mover, other] : {std::pair{c.body_a, c.body_b}, std::pair{c.body_b, c.body_a}}) {
        const BodyTraits& traits = bodies.traits[mover];
        if (traits.motion_state != MotionState::Awake || bodies.traits[other].kind != BodyKind::Dynamic) continue;
        if (traits.kind == BodyKind::Kinematic) {
            if (is_moving(bodies.motion[mover]) && is_asleep(other)) request_wake(bodies, other);
        } else if (is_blow) {
            blows.push_back({other, traits.mass.mass * speed});
        } else if (c.began && is_asleep(other)) {
            blows.push_back({other, 0});
        }
    }
}

/// Removes the blows on awake bodies that no touching bodies connect to a sleeper: they wake nothing.
void drop_blows_far_from_sleepers(const BodyTable& bodies, const Constraints& constraints, IslandLists& lists) {
    if (lists.blows.empty()) return;
    const auto is_asleep = [&](std::uint32_t body) { return bodies.traits[body].motion_state == MotionState::Asleep; };
    lists.sets.reset(bodies.traits.size());
    lists.near_sleeper.assign(bodies.traits.size(), 0);
    for (const Constraint& c : constraints.all)
        if (c.touches && bodies.traits[c.body_a].kind == BodyKind::Dynamic &&
            bodies.traits[c.body_b].kind == BodyKind::Dynamic)
            lists.sets.unite(c.body_a, c.body_b);
    for (const Constraint& c : constraints.all)
        for (const std::uint32_t body : {c.body_a, c.body_b})
            if (c.touches && is_asleep(body)) lists.near_sleeper[lists.sets.find(body)] = 1;
    std::erase_if(lists.blows, [&](const Blow& blow) {
        return !is_asleep(blow.body) && !lists.near_sleeper[lists.sets.find(blow.body)];
    });
}

}  // namespace

void wake_touched(const StepContext& context, const MotionStates& state, Constraints& constraints, IslandLists& lists) {
    const Settings& settings = context.settings;
    lists.blows.clear();
    if (!state.bodies.asleep.bodies.empty())
        for (const Constraint& constraint : constraints.all)
            wake_at(context, state.contacts, constraint, state.bodies, lists.blows);
    const std::size_t before = state.bodies.awake.size();
    drop_blows_far_from_sleepers(state.bodies, constraints, lists);
    wake_struck(state, settings, lists.blows);
    wake_requested_islands(state, settings);
    // Woken bodies add their resting contacts, which are still valid because nothing has moved since.
    if (state.bodies.awake.size() != before)
        gather_constraints(state.bodies, settings.linear_slop, state.contacts, constraints);
}

void find_islands(const StepContext& context, const Constraints& constraints, BodyTable& bodies, IslandLists& lists) {
    lists.sets.reset(bodies.traits.size());
    const auto moving_kinematic = [&](std::uint32_t body) {
        return bodies.traits[body].kind == BodyKind::Kinematic && is_moving(bodies.motion[body]);
    };
    for (const Constraint& c : constraints.all) {
        if (!c.touches) continue;
        if (c.moves == Moves::Both) {
            lists.sets.unite(c.body_a, c.body_b);
        } else if (moving_kinematic(c.body_a)) {
            restart_rest(bodies, c.body_b);
        } else if (moving_kinematic(c.body_b)) {
            restart_rest(bodies, c.body_a);
        }
    }
    for (const std::uint32_t body : bodies.awake) {
        const std::uint32_t island = lists.sets.find(body);
        bodies.motion[body].island = island;
        context.report.islands += island == body ? 1 : 0;
    }
}

}  // namespace fase
