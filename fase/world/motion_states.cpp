/// Changes the motion state of bodies, and moves their boxes and pairs with them.
#include <algorithm>

#include "fase/world/detail/stages.hpp"

namespace fase {

using broad::Pair;

namespace {

std::uint8_t set_number(MotionState state) { return static_cast<std::uint8_t>(1 + static_cast<std::uint8_t>(state)); }

/// Calls f(collider) for all colliders of the bodies.
template <class F>
void for_each_collider(const BodyTable& bodies, const ColliderTable& colliders, std::span<const std::uint32_t> list,
                       const F& f) {
    for (const std::uint32_t body : list)
        for (std::uint32_t c = bodies.traits[body].first_collider; c != no_index; c = colliders[c].next) f(c);
}

/// Moves the boxes of the bodies' colliders from one broad-phase structure to another.
void move_boxes(const MotionStates& state, std::span<const std::uint32_t> bodies, MotionState from, MotionState to) {
    BroadPhase& broad_phase = state.broad_phase;
    broad_phase.query_boxes.clear();
    broad_phase.proxies.clear();
    for_each_collider(state.bodies, state.colliders, bodies, [&](std::uint32_t c) {
        broad_phase.query_boxes.push_back({c, broad_phase.boxes[c]});
        broad_phase.proxies.push_back(c);
        broad_phase.set_of[c] = set_number(to);
        mark_box_changed(state.query, c);
    });
    broad_phase.sets.of(from).erase(broad_phase.proxies);
    broad_phase.sets.of(to).insert(broad_phase.query_boxes);
}

bool is_awake(const BodyTable& bodies, const dynamics::Contact& c) {
    return bodies.traits[c.body_a].motion_state == MotionState::Awake ||
           bodies.traits[c.body_b].motion_state == MotionState::Awake;
}

/// Moves the resting contacts of ContactTable::woken to the active list.
void activate(ContactTable& contacts) {
    std::vector<std::uint32_t>& woken = contacts.woken;
    std::vector<Pair>& found = contacts.woken_pairs;
    sort_by_pair(contacts, woken);
    found.clear();
    for (const std::uint32_t contact : woken) {
        remove_resting(contacts, contact);
        found.push_back({contacts[contact].collider_a, contacts[contact].collider_b});
    }
    std::size_t next = 0;
    contacts.active.update(
        found, [](std::size_t) { return false; }, [](std::uint32_t) {}, [&](Pair) { return woken[next++]; });
}

}  // namespace

void apply_edits(const BodyTable& bodies, const ColliderTable& colliders, BroadPhase& broad_phase) {
    for (const std::uint32_t c : broad_phase.edited_colliders) {
        const std::uint8_t before = broad_phase.set_of[c];
        const bool exists = colliders.ids.alive_at(c);
        const std::uint8_t now = exists ? set_number(bodies.traits[colliders[c].body].motion_state) : 0;
        const auto set = [&](std::uint8_t number) -> broad::AnyStructure& {
            return broad_phase.sets.of(static_cast<MotionState>(number - 1));
        };
        const broad::Move box{c, broad_phase.boxes[c]};
        if (before == now) {
            if (now != 0) set(now).move(std::span(&box, 1));
        } else {
            if (before != 0) set(before).erase(std::span(&c, 1));
            if (now != 0) set(now).insert(std::span(&box, 1));
        }
        broad_phase.set_of[c] = now;
    }
}

void mark_edited(BroadPhase& broad_phase, QueryTrees& query, std::uint32_t collider) {
    mark_box_changed(query, collider);
    if (!(broad_phase.changes[collider] & edited)) broad_phase.edited_colliders.push_back(collider);
    broad_phase.changes[collider] |= edited;
}

void update_pair_lists(const BodyTable& bodies, const ColliderTable& colliders, BroadPhase& broad_phase,
                       ContactTable& contacts, std::span<const std::uint32_t> changed) {
    std::vector<std::uint32_t>& woken = contacts.woken;
    woken.clear();
    bool any_rests = false;
    for_each_collider(bodies, colliders, changed, [&](std::uint32_t collider) {
        contacts.graph.for_each_of(collider, [&](std::uint32_t contact) {
            const bool rests = contacts.graph.resting_at(contact) != no_index;
            const bool awake = is_awake(bodies, contacts[contact]);
            if (rests && awake) woken.push_back(contact);
            any_rests |= !rests && !awake;
        });
    });
    if (!woken.empty()) activate(contacts);
    if (!any_rests) return;
    std::vector<std::uint8_t>& changes = broad_phase.changes;
    for_each_collider(bodies, colliders, changed, [&](std::uint32_t c) { changes[c] |= state_changed; });
    pairs::PairList& active = contacts.active;
    active.update(
        {},
        [&](std::size_t i) {
            return ((changes[active.pairs[i].a] | changes[active.pairs[i].b]) & state_changed) != 0 &&
                   !is_awake(bodies, contacts[active.values[i]]);
        },
        [&](std::uint32_t contact) {
            add_resting(contacts, contact);
            // A sensor looks once more where its visitors stopped.
            if (contacts[contact].sensor) contacts.to_check.push_back(contact);
        },
        [](Pair) { return no_index; });
    for_each_collider(bodies, colliders, changed,
                      [&](std::uint32_t c) { changes[c] = static_cast<std::uint8_t>(changes[c] & ~state_changed); });
}

void merge_awake_added(BodyTable& bodies) {
    std::sort(bodies.awake_added.begin(), bodies.awake_added.end());
    insert_ascending(bodies.awake, bodies.awake_added);
    bodies.awake_added.clear();
}

void remove_awake(BodyTable& bodies, std::uint32_t body) {
    if (std::erase(bodies.awake_added, body) == 0) erase_ascending(bodies.awake, std::span(&body, 1));
}

void move_to_awake(const MotionStates& state, std::span<const std::uint32_t> bodies) {
    if (bodies.empty()) return;
    for (const std::uint32_t body : bodies) {
        state.bodies.traits[body].motion_state = MotionState::Awake;
        if (const auto id = state.bodies.ids.id_at(body)) state.events.woke_up.push_back(*id);
    }
    state.bodies.asleep.remove(bodies);
    insert_ascending(state.bodies.awake, bodies);
    move_boxes(state, bodies, MotionState::Asleep, MotionState::Awake);
    update_pair_lists(state.bodies, state.colliders, state.broad_phase, state.contacts, bodies);
}

void move_to_asleep(const MotionStates& state, std::span<const std::uint32_t> bodies) {
    if (bodies.empty()) return;
    for (const std::uint32_t body : bodies) {
        state.bodies.traits[body].motion_state = MotionState::Asleep;
        state.bodies.motion[body].linear_velocity = {};
        state.bodies.motion[body].angular_velocity = {};
    }
    erase_ascending(state.bodies.awake, bodies);
    state.bodies.asleep.add(bodies, state.bodies.motion);
    move_boxes(state, bodies, MotionState::Awake, MotionState::Asleep);
    measure_asleep_overhang(state.bodies, state.colliders, state.broad_phase, state.query, bodies);
    update_pair_lists(state.bodies, state.colliders, state.broad_phase, state.contacts, bodies);
}

}  // namespace fase
