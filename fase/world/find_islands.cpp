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

/// Marks the sets of bodies that touching bodies connect to a sleeper.
void find_sets_near_sleepers(const BodyTable& bodies, const Constraints& constraints, IslandLists& lists) {
    lists.sets.reset(bodies.traits.size());
    lists.near_sleeper.assign(bodies.traits.size(), 0);
    const auto touches_sleeper = [](const Constraint& c) { return c.touches && c.on_sleeper; };
    if (std::ranges::none_of(constraints.all, touches_sleeper)) return;
    for (const Constraint& c : constraints.all)
        if (c.touches && (c.on_sleeper || c.moves == Moves::Both)) lists.sets.unite(c.body_a, c.body_b);
    for (const Constraint& c : constraints.all)
        if (touches_sleeper(c)) lists.near_sleeper[lists.sets.find(c.body_a)] = 1;
}

/// Lists the blows that may wake a sleeper: on a sleeper, or on a body that touching bodies connect to one.
void find_blows(const StepContext& context, const ContactTable& contacts, const Constraints& constraints,
                BodyTable& bodies, IslandLists& lists) {
    const auto is_asleep = [&](std::uint32_t body) { return bodies.traits[body].motion_state == MotionState::Asleep; };
    const auto is_near = [&](std::uint32_t body) { return lists.near_sleeper[lists.sets.find(body)] != 0; };
    find_sets_near_sleepers(bodies, constraints, lists);
    for (const Constraint& c : constraints.all)
        if (c.on_sleeper || c.moves == Moves::Neither || is_near(c.body_a) || is_near(c.body_b))
            wake_at(context, contacts, c, bodies, lists.blows);
    std::erase_if(lists.blows, [&](const Blow& blow) { return !is_asleep(blow.body) && !is_near(blow.body); });
}

}  // namespace

void wake_touched(const StepContext& context, const MotionStates& state, Constraints& constraints, IslandLists& lists) {
    const Settings& settings = context.settings;
    lists.blows.clear();
    if (constraints.beside_sleepers) find_blows(context, state.contacts, constraints, state.bodies, lists);
    const std::size_t before = state.bodies.awake.size();
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
