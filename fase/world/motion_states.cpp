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

/// Moves the resting contacts of `woken_contacts` to the active list.
void activate(WorldState& state) {
    std::vector<std::uint32_t>& contacts = state.woken_contacts;
    std::vector<Pair>& found = state.woken_pairs;
    sort_by_pair(state, contacts);
    found.clear();
    for (const std::uint32_t contact : contacts) {
        remove_resting(state, contact);
        found.push_back({state.contacts[contact].collider_a, state.contacts[contact].collider_b});
    }
    std::size_t next = 0;
    state.active.update(
        found, [](std::size_t) { return false; }, [](std::uint32_t) {}, [&](Pair) { return contacts[next++]; });
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
                f(c);
    };
    std::vector<std::uint32_t>& woken = state.woken_contacts;
    woken.clear();
    bool any_rests = false;
    for_each_collider([&](std::uint32_t collider) {
        state.contact_graph.for_each_of(collider, [&](std::uint32_t contact) {
            const bool rests = state.contact_graph.resting_at(contact) != no_index;
            if (rests && is_awake(state, contact)) woken.push_back(contact);
            any_rests |= !rests && !is_awake(state, contact);
        });
    });
    if (!woken.empty()) activate(state);
    if (!any_rests) return;
    for_each_collider([&](std::uint32_t collider) { state.changes[collider] |= state_changed; });
    pairs::PairList& active = state.active;
    active.update(
        {},
        [&](std::size_t i) {
            return ((state.changes[active.pairs[i].a] | state.changes[active.pairs[i].b]) & state_changed) != 0 &&
                   !is_awake(state, active.values[i]);
        },
        [&](std::uint32_t contact) {
            add_resting(state, contact);
            // A sensor looks once more where its visitors stopped.
            if (state.contacts[contact].sensor) state.contacts_to_check.push_back(contact);
        },
        [](Pair) { return no_index; });
    for_each_collider([&](std::uint32_t collider) {
        state.changes[collider] = static_cast<std::uint8_t>(state.changes[collider] & ~state_changed);
    });
}

void merge_awake_added(WorldState& state) {
    std::sort(state.awake_added.begin(), state.awake_added.end());
    insert_ascending(state.awake, state.awake_added);
    state.awake_added.clear();
}

void remove_awake(WorldState& state, std::uint32_t body) {
    if (std::erase(state.awake_added, body) == 0) erase_ascending(state.awake, std::span(&body, 1));
}

void move_to_awake(WorldState& state, std::span<const std::uint32_t> bodies) {
    if (bodies.empty()) return;
    for (const std::uint32_t body : bodies) {
        state.bodies.traits[body].motion_state = MotionState::Awake;
        if (const auto id = state.body_ids.id_at(body)) state.events.woke_up.push_back(*id);
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

}  // namespace fase
