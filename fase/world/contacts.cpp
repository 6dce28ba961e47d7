/// Contacts begin and end; their lists: active pairs sorted, resting pairs in any order.
#include <algorithm>

#include "fase/world/detail/state.hpp"

namespace fase {

using broad::Pair;
using dynamics::Contact;
using dynamics::ContactManifold;

std::uint32_t add_contact(WorldState& state, Pair pair) {
    std::uint32_t index;
    if (state.free_contacts.empty()) {
        index = static_cast<std::uint32_t>(state.contacts.size());
        state.contacts.emplace_back();
    } else {
        index = state.free_contacts.back();
        state.free_contacts.pop_back();
        state.contacts[index] = {};
    }
    Contact& contact = state.contacts[index];
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
    state.manifolds.reserve(contact, 1);
    update_materials(state, index);
    state.contact_graph.add(index, pair.a, pair.b);
    return index;
}

void update_materials(WorldState& state, std::uint32_t index) {
    const Contact& contact = state.contacts[index];
    const Material& a = state.colliders[contact.collider_a].material;
    const Material& b = state.colliders[contact.collider_b].material;
    for (ContactManifold& manifold : state.manifolds.places(contact)) {
        manifold.friction = combined(a.friction, a.friction_combine, b.friction, b.friction_combine);
        manifold.restitution = combined(a.restitution, a.restitution_combine, b.restitution, b.restitution_combine);
    }
}

namespace {

/// Records that two colliders began or ended to touch.
void report_touch(WorldState& state, const Contact& c, bool begins) {
    const ContactEvent ids{{c.collider_a, c.generation_a, state.collider_ids.owner()},
                           {c.collider_b, c.generation_b, state.collider_ids.owner()}};
    if (c.sensor) {
        const SensorEvent event = c.sensor_is_b ? SensorEvent{ids.b, ids.a} : SensorEvent{ids.a, ids.b};
        (begins ? state.events.sensors_begun : state.events.sensors_ended).push_back(event);
    } else {
        (begins ? state.events.contacts_begun : state.events.contacts_ended).push_back(ids);
    }
}

}  // namespace

void set_touching(WorldState& state, Contact& contact, bool touching) {
    if (contact.touching == touching) return;
    report_touch(state, contact, touching);
    contact.touching = touching;
    if (contact.sensor || touching) return;
    // What is no longer held must not fall asleep on the rest it had. It wakes alone, without its island.
    for (const auto& [collider, generation, body] : sides_of(contact)) {
        if (!is_current(state, collider, generation) || state.bodies.traits[body].kind != BodyKind::Dynamic) continue;
        state.bodies.motion[body].sleep_time = 0;
        if (state.bodies.traits[body].motion_state == MotionState::Asleep) state.bodies_let_go.push_back(body);
    }
}

void end_contact(WorldState& state, std::uint32_t index) {
    set_touching(state, state.contacts[index], false);
    if (state.contact_graph.resting_at(index) != no_index) remove_resting(state, index);
    state.contact_graph.remove(index);
    Contact& contact = state.contacts[index];
    for (ContactManifold& manifold : state.manifolds.coloured(contact))
        state.colours.release(manifold.colour, contact.body_a, contact.body_b);
    state.manifolds.release(contact);
    contact = {};
    state.free_contacts.push_back(index);
}

void add_resting(WorldState& state, std::uint32_t index) {
    const Contact& c = state.contacts[index];
    state.contact_graph.set_resting_at(index, static_cast<std::uint32_t>(state.resting.size()));
    state.resting.append({c.collider_a, c.collider_b}, index);
}

void remove_resting(WorldState& state, std::uint32_t index) {
    const std::uint32_t place = state.contact_graph.resting_at(index);
    pairs::PairList& resting = state.resting;
    resting.pairs[place] = resting.pairs.back();
    resting.values[place] = resting.values.back();
    state.contact_graph.set_resting_at(resting.values[place], place);
    state.contact_graph.set_resting_at(index, no_index);
    resting.pairs.pop_back();
    resting.values.pop_back();
}

void rebuild_contact_graph(WorldState& state) {
    state.contact_graph.clear();
    for (const pairs::PairList* list : {&state.active, &state.resting})
        for (std::size_t i = 0; i < list->size(); ++i)
            state.contact_graph.add(list->values[i], list->pairs[i].a, list->pairs[i].b);
    for (std::size_t i = 0; i < state.resting.size(); ++i)
        state.contact_graph.set_resting_at(state.resting.values[i], static_cast<std::uint32_t>(i));
}

void gather_constraints(WorldState& state, std::span<const std::uint32_t> quarantined) {
    constexpr std::uint8_t moves = 1, left_out = 2;
    std::vector<std::uint8_t>& role = state.roles;
    role.assign(state.bodies.traits.size(), 0);
    for (const std::uint32_t body : state.awake)
        role[body] = state.bodies.traits[body].kind == BodyKind::Dynamic ? moves : 0;
    for (const std::uint32_t body : quarantined) role[body] = left_out;
    state.colours.resize(state.bodies.traits.size());
    state.constraints.clear();
    state.results.clear();
    state.sensors.clear();
    for (const std::uint32_t index : state.active.values) {
        Contact& c = state.contacts[index];
        if (c.sensor) {
            state.sensors.push_back(index);
            continue;
        }
        for (std::size_t i = c.manifolds; i < c.coloured; ++i)
            state.colours.release(state.manifolds.coloured(c)[i].colour, c.body_a, c.body_b);
        c.coloured = c.manifolds;
        dynamics::Constraint constraint{c.first_manifold, index, c.body_a, c.body_b};
        if (role[c.body_a] != left_out && role[c.body_b] != left_out)
            constraint.moves = dynamics::moves_of(role[c.body_a] == moves, role[c.body_b] == moves);
        constraint.began = !c.touching;
        constraint.touches = c.touching || c.nearest <= state.settings.linear_slop;
        for (std::size_t i = 0; i < c.manifolds; ++i, ++constraint.index) {
            state.constraints.push_back(constraint);
            state.results.push_back({c.nearest});
        }
    }
}

bool rebuild_colours(WorldState& state) {
    state.colours.clear();
    state.colours.resize(state.bodies.traits.size());
    for (const Contact& c : state.contacts) {
        const std::span<const ContactManifold> places = state.manifolds.places(c);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const dynamics::ConstraintColour colour = places[i].colour;
            if (i >= c.coloured && colour.number != dynamics::ConstraintColour::none) return false;
            if (!state.colours.restore(colour, c.body_a, c.body_b)) return false;
        }
    }
    return true;
}

void sort_by_pair(const WorldState& state, std::vector<std::uint32_t>& contacts) {
    std::sort(contacts.begin(), contacts.end(), [&](std::uint32_t x, std::uint32_t y) {
        const Contact &cx = state.contacts[x], &cy = state.contacts[y];
        return Pair{cx.collider_a, cx.collider_b} < Pair{cy.collider_a, cy.collider_b};
    });
    contacts.erase(std::unique(contacts.begin(), contacts.end()), contacts.end());
}

}  // namespace fase
