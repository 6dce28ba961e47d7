/// Bodies between awake and asleep: with their boxes, and the pairs they are in.
#include <algorithm>

#include "fase/geometry/bounds.hpp"
#include "fase/world/detail/state.hpp"

namespace fase {

using broad::Pair;

broad::AnyStructure& boxes_of(WorldState& state, MotionState motion_state) {
    switch (motion_state) {
        case MotionState::Static: return state.static_boxes;
        case MotionState::Asleep: return state.asleep_boxes;
        case MotionState::Awake: break;
    }
    return state.awake_boxes;
}

LocalPose collider_pose(const WorldState& state, const Collider& collider) {
    const Quat body = state.bodies.motion[collider.body].rotation;
    return {rotate(body, collider.in_principal.position), body * collider.in_principal.rotation};
}

Pose world_pose(const WorldState& state, const Collider& collider) {
    const LocalPose local = collider_pose(state, collider);
    return {state.bodies.motion[collider.body].position + to_double(local.position), local.rotation};
}

Aabb reaching_box(const WorldState& state, std::uint32_t index, float seconds, float sweep) {
    const Collider& collider = state.colliders[index];
    const dynamics::BodyMotion& motion = state.bodies.motion[collider.body];
    Aabb box = grown(bounds(state.shapes[collider.shape].shape, world_pose(state, collider)),
                     state.settings.speculative_distance);
    if (sweep > 0) {
        const Vec3 way = motion.linear_velocity * seconds, none;
        box.lo += min(way, none);
        box.hi += max(way, none);
    }
    return box;
}

namespace {

/// Moves the boxes of a body's colliders from one set to another.
void move_boxes(WorldState& state, std::span<const std::uint32_t> bodies, MotionState from, MotionState to) {
    state.query_boxes.clear();
    state.scratch.clear();
    for (const std::uint32_t body : bodies)
        for (std::uint32_t c = state.bodies.traits[body].first_collider; c != no_index; c = state.colliders[c].next) {
            state.query_boxes.push_back({c, state.boxes[c]});
            state.scratch.push_back(c);
            note_box(state, c);
        }
    boxes_of(state, from).erase(state.scratch);
    boxes_of(state, to).insert(state.query_boxes);
}

bool is_awake(const WorldState& state, std::uint32_t contact) {
    const dynamics::Contact& c = state.contacts[contact];
    return state.bodies.traits[c.body_a].motion_state == MotionState::Awake ||
           state.bodies.traits[c.body_b].motion_state == MotionState::Awake;
}

/// Takes the pairs for which `goes(place)` holds out of `from` and merges them into `into`; both stay sorted. Two bytes
/// a pair are read of what stays.
template <class F> void move_pairs(PairList& from, PairList& into, PairList& moved, const F& goes) {
    moved.clear();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < from.size(); ++i) {
        if (goes(i)) {
            moved.add(from.pairs[i], from.contacts[i]);
        } else {
            if (kept != i) {
                from.pairs[kept] = from.pairs[i];
                from.contacts[kept] = from.contacts[i];
            }
            ++kept;
        }
    }
    if (moved.size() == 0) return;
    from.pairs.resize(kept);
    from.contacts.resize(kept);
    // Merged from the back: what comes before the first that moved stays where it is.
    std::size_t i = into.size(), j = moved.size(), at = i + j;
    into.pairs.resize(at);
    into.contacts.resize(at);
    while (j > 0) {
        const bool old = i > 0 && moved.pairs[j - 1] < into.pairs[i - 1];
        const PairList& source = old ? into : moved;
        const std::size_t place = old ? --i : --j;
        --at;
        into.pairs[at] = source.pairs[place];
        into.contacts[at] = source.contacts[place];
    }
}

}  // namespace

void sort_out_pairs(WorldState& state, std::span<const std::uint32_t> bodies) {
    const auto for_each_collider = [&](const auto& f) {
        for (const std::uint32_t body : bodies)
            for (std::uint32_t c = state.bodies.traits[body].first_collider; c != no_index; c = state.colliders[c].next)
                f(state.changes[c]);
    };
    for_each_collider([](std::uint8_t& change) { change |= crossed; });
    const auto touched = [&](Pair pair) { return ((state.changes[pair.a] | state.changes[pair.b]) & crossed) != 0; };
    PairList &active = state.active, &resting = state.resting;
    move_pairs(resting, active, state.spare_list,
               [&](std::size_t i) { return touched(resting.pairs[i]) && is_awake(state, resting.contacts[i]); });
    move_pairs(active, resting, state.spare_list,
               [&](std::size_t i) { return touched(active.pairs[i]) && !is_awake(state, active.contacts[i]); });
    for_each_collider([](std::uint8_t& change) { change = static_cast<std::uint8_t>(change & ~crossed); });
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
    sort_out_pairs(state, bodies);
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
    note_sleepers(state, bodies);
    sort_out_pairs(state, bodies);
}

void want_awake(WorldState& state, std::uint32_t body) {
    if (state.bodies.traits[body].motion_state == MotionState::Asleep && !state.bodies.traits[body].quarantined)
        state.wake_wanted.push_back(body);
}

void wake_wanted_islands(WorldState& state) {
    if (state.wake_wanted.empty()) return;
    std::vector<std::uint32_t> islands, bodies;
    for (const std::uint32_t body : state.wake_wanted)
        if (state.asleep.holds(body)) islands.push_back(state.asleep.island(body));
    state.wake_wanted.clear();
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
    renew_materials(state, index);
    return index;
}

void renew_materials(WorldState& state, std::uint32_t index) {
    dynamics::Contact& contact = state.contacts[index];
    const Material& a = state.colliders[contact.collider_a].material;
    const Material& b = state.colliders[contact.collider_b].material;
    contact.friction = combined(a.friction, a.friction_combine, b.friction, b.friction_combine);
    contact.restitution = combined(a.restitution, a.restitution_combine, b.restitution, b.restitution_combine);
}

}  // namespace fase
