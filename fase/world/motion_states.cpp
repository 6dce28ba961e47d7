/// Changes the motion state of bodies, and moves their boxes and pairs with them.
#include <algorithm>

#include "fase/geometry/bounds.hpp"
#include "fase/world/detail/state.hpp"

namespace fase {

using broad::Pair;

LocalPose collider_pose(const WorldState& state, const Collider& collider) {
    const Quat body = state.bodies.motion[collider.body].rotation;
    return {rotate(body, collider.in_principal.position), body * collider.in_principal.rotation};
}

Pose world_pose(const WorldState& state, const Collider& collider) {
    const LocalPose local = collider_pose(state, collider);
    return {state.bodies.motion[collider.body].position + to_double(local.position), local.rotation};
}

Aabb speculative_box(const WorldState& state, std::uint32_t index, float seconds, float sweep) {
    const Collider& collider = state.colliders[index];
    const dynamics::BodyMotion& motion = state.bodies.motion[collider.body];
    Aabb box = enlarged(bounds(state.shapes[collider.shape].shape, world_pose(state, collider)),
                        state.settings.speculative_distance);
    if (sweep > 0) {
        const Vec3 path = motion.linear_velocity * seconds, zero;
        box.lo += min(path, zero);
        box.hi += max(path, zero);
    }
    return box;
}

namespace {

std::uint8_t set_number(MotionState state) { return static_cast<std::uint8_t>(1 + static_cast<std::uint8_t>(state)); }

/// Moves the boxes of the bodies' colliders from one broad-phase structure to another.
void move_boxes(WorldState& state, std::span<const std::uint32_t> bodies, MotionState from, MotionState to) {
    state.query_boxes.clear();
    state.scratch.clear();
    for (const std::uint32_t body : bodies)
        for (std::uint32_t c = state.bodies.traits[body].first_collider; c != no_index; c = state.colliders[c].next) {
            state.query_boxes.push_back({c, state.boxes[c]});
            state.scratch.push_back(c);
            state.set_of[c] = set_number(to);
            mark_box_changed(state, c);
        }
    state.box_sets.of(from).erase(state.scratch);
    state.box_sets.of(to).insert(state.query_boxes);
}

bool is_awake(const WorldState& state, std::uint32_t contact) {
    const dynamics::Contact& c = state.contacts[contact];
    return state.bodies.traits[c.body_a].motion_state == MotionState::Awake ||
           state.bodies.traits[c.body_b].motion_state == MotionState::Awake;
}

}  // namespace

void apply_edits(WorldState& state) {
    for (const std::uint32_t c : state.edited_colliders) {
        const std::uint8_t before = state.set_of[c];
        const bool exists = state.collider_ids.alive_at(c);
        const std::uint8_t now = exists ? set_number(state.bodies.traits[state.colliders[c].body].motion_state) : 0;
        const auto set = [&](std::uint8_t number) -> broad::AnyStructure& {
            return state.box_sets.of(static_cast<MotionState>(number - 1));
        };
        const broad::Move box{c, state.boxes[c]};
        if (before == now) {
            if (now != 0) set(now).move(std::span(&box, 1));
        } else {
            if (before != 0) set(before).erase(std::span(&c, 1));
            if (now != 0) set(now).insert(std::span(&box, 1));
        }
        state.set_of[c] = now;
    }
}

void update_pair_lists(WorldState& state, std::span<const std::uint32_t> bodies) {
    const auto for_each_collider = [&](const auto& f) {
        for (const std::uint32_t body : bodies)
            for (std::uint32_t c = state.bodies.traits[body].first_collider; c != no_index; c = state.colliders[c].next)
                f(state.changes[c]);
    };
    for_each_collider([](std::uint8_t& change) { change |= state_changed; });
    const auto is_affected = [&](Pair pair) {
        return ((state.changes[pair.a] | state.changes[pair.b]) & state_changed) != 0;
    };
    pairs::PairList &active = state.active, &resting = state.resting;
    resting.move_to(active,
                    [&](std::size_t i) { return is_affected(resting.pairs[i]) && is_awake(state, resting.values[i]); });
    active.move_to(resting,
                   [&](std::size_t i) { return is_affected(active.pairs[i]) && !is_awake(state, active.values[i]); });
    for_each_collider([](std::uint8_t& change) { change = static_cast<std::uint8_t>(change & ~state_changed); });
}

void move_to_awake(WorldState& state, std::span<const std::uint32_t> bodies) {
    if (bodies.empty()) return;
    for (const std::uint32_t body : bodies) {
        state.bodies.traits[body].motion_state = MotionState::Awake;
        state.bodies.motion[body].sleep_time = 0;
    }
    state.asleep.remove(bodies);
    insert_ascending(state.awake, bodies);
    move_boxes(state, bodies, MotionState::Asleep, MotionState::Awake);
    update_pair_lists(state, bodies);
}

void move_to_asleep(WorldState& state, std::span<const std::uint32_t> bodies) {
    if (bodies.empty()) return;
    for (const std::uint32_t body : bodies) {
        state.bodies.traits[body].motion_state = MotionState::Asleep;
        state.bodies.motion[body].linear_velocity = {};
        state.bodies.motion[body].angular_velocity = {};
    }
    erase_ascending(state.awake, bodies);
    state.asleep.add(bodies, state.bodies.motion);
    move_boxes(state, bodies, MotionState::Awake, MotionState::Asleep);
    measure_asleep_overhang(state, bodies);
    update_pair_lists(state, bodies);
}

void request_wake(WorldState& state, std::uint32_t body) {
    if (state.bodies.traits[body].motion_state == MotionState::Asleep && !state.bodies.traits[body].quarantined)
        state.bodies_to_wake.push_back(body);
}

void wake_requested_islands(WorldState& state) {
    if (state.bodies_to_wake.empty()) return;
    std::vector<std::uint32_t> islands, bodies;
    for (const std::uint32_t body : state.bodies_to_wake)
        if (state.asleep.holds(body)) islands.push_back(state.asleep.island(body));
    state.bodies_to_wake.clear();
    std::sort(islands.begin(), islands.end());
    islands.erase(std::unique(islands.begin(), islands.end()), islands.end());
    for (const std::uint32_t island : islands)
        state.asleep.for_each_of(island, [&](std::uint32_t body) {
            if (!state.bodies.traits[body].quarantined) bodies.push_back(body);
        });
    if (bodies.empty()) return;
    std::sort(bodies.begin(), bodies.end());
    for (const std::uint32_t body : bodies)
        if (const auto id = state.body_ids.id_at(body)) state.events.woke_up.push_back(*id);
    move_to_awake(state, bodies);
}

std::uint32_t add_contact(WorldState& state, broad::Pair pair) {
    std::uint32_t index;
    if (state.free_contacts.empty()) {
        index = static_cast<std::uint32_t>(state.contacts.size());
        state.contacts.emplace_back();
    } else {
        index = state.free_contacts.back();
        state.free_contacts.pop_back();
        state.contacts[index] = {};
    }
    dynamics::Contact& contact = state.contacts[index];
    const Collider& a = state.colliders[pair.a];
    const Collider& b = state.colliders[pair.b];
    contact.collider_a = pair.a;
    contact.collider_b = pair.b;
    contact.body_a = a.body;
    contact.body_b = b.body;
    contact.generation_a = state.collider_ids.slots()[pair.a].generation;
    contact.generation_b = state.collider_ids.slots()[pair.b].generation;
    contact.sensor = a.sensor || b.sensor;
    contact.sensor_is_b = b.sensor;
    update_materials(state, index);
    return index;
}

void update_materials(WorldState& state, std::uint32_t index) {
    dynamics::Contact& contact = state.contacts[index];
    const Material& a = state.colliders[contact.collider_a].material;
    const Material& b = state.colliders[contact.collider_b].material;
    contact.friction = combined(a.friction, a.friction_combine, b.friction, b.friction_combine);
    contact.restitution = combined(a.restitution, a.restitution_combine, b.restitution, b.restitution_combine);
}

}  // namespace fase
