/// Contacts begin and end; their lists: active pairs sorted, resting pairs in any order.
#include <algorithm>

#include "fase/core/detail/prefetch.hpp"
#include "fase/world/detail/contacts.hpp"

namespace fase {

using broad::Pair;
using dynamics::Contact;
using dynamics::ContactManifold;

void reserve_contacts(ContactTable& contacts, std::size_t count) {
    const std::size_t size = contacts.all.size() + count;
    if (contacts.all.capacity() < size) contacts.all.reserve(std::max(size, 2 * contacts.all.capacity()));
    contacts.manifolds.reserve_for(count);
    contacts.graph.reserve(size);
}

std::uint32_t add_contact(const ColliderTable& colliders, ContactTable& contacts, Pair pair) {
    std::uint32_t index;
    if (contacts.free.empty()) {
        index = static_cast<std::uint32_t>(contacts.all.size());
        contacts.all.emplace_back();
    } else {
        index = contacts.free.back();
        contacts.free.pop_back();
        contacts[index] = {};
    }
    Contact& contact = contacts[index];
    const Collider& a = colliders[pair.a];
    const Collider& b = colliders[pair.b];
    contact.collider_a = pair.a;
    contact.collider_b = pair.b;
    contact.body_a = a.body;
    contact.body_b = b.body;
    contact.generation_a = colliders.ids.slots()[pair.a].generation;
    contact.generation_b = colliders.ids.slots()[pair.b].generation;
    contact.sensor = a.sensor || b.sensor;
    contact.sensor_is_b = b.sensor;
    contact.on_mesh = is_mesh(colliders.shapes[a.shape].shape) || is_mesh(colliders.shapes[b.shape].shape);
    contacts.manifolds.reserve(contact, 1);
    update_materials(colliders, contacts, index);
    contacts.graph.add(index, pair.a, pair.b);
    return index;
}

void update_materials(const ColliderTable& colliders, ContactTable& contacts, std::uint32_t index) {
    const Contact& contact = contacts[index];
    const Material& a = colliders[contact.collider_a].material;
    const Material& b = colliders[contact.collider_b].material;
    for (ContactManifold& manifold : contacts.manifolds.places(contact)) {
        manifold.friction = combined(a.friction, a.friction_combine, b.friction, b.friction_combine);
        manifold.restitution = combined(a.restitution, a.restitution_combine, b.restitution, b.restitution_combine);
    }
}

EventCollider event_collider(const BodyTable& bodies, const ColliderTable& colliders, std::uint32_t index) {
    const Collider& collider = colliders[index];
    EventCollider event{*colliders.ids.id_at(index)};
    event.body = *bodies.ids.id_at(collider.body);
    event.user = collider.user;
    event.body_user = bodies.traits[collider.body].user;
    return event;
}

namespace {

std::pair<std::uint32_t, std::uint32_t> index_and_generation(const EventCollider& collider) {
    return {collider.index, collider.generation};
}

}  // namespace

void sort_removed(ContactTable& contacts) { std::ranges::sort(contacts.removed, {}, index_and_generation); }

std::array<EventCollider, 2> event_colliders(const BodyTable& bodies, const ColliderTable& colliders,
                                             const ContactTable& contacts, const Contact& contact) {
    const auto event = [&](const ContactSide& side) {
        if (is_current(colliders, side.collider, side.generation))
            return event_collider(bodies, colliders, side.collider);
        const std::pair<std::uint32_t, std::uint32_t> id{side.collider, side.generation};
        const auto removed = std::ranges::lower_bound(contacts.removed, id, {}, index_and_generation);
        return removed != contacts.removed.end() && index_and_generation(*removed) == id
                   ? *removed
                   : EventCollider{{side.collider, side.generation, colliders.ids.owner()}};
    };
    const auto [a, b] = sides_of(contact);
    return {event(a), event(b)};
}

namespace {

/// Records that two colliders began or ended to touch.
void report_touch(const BodyTable& bodies, const ColliderTable& colliders, const ContactTable& contacts, Events& events,
                  const Contact& c, bool begins) {
    const auto [a, b] = event_colliders(bodies, colliders, contacts, c);
    if (c.sensor) {
        const SensorEvent event = c.sensor_is_b ? SensorEvent{b, a} : SensorEvent{a, b};
        (begins ? events.sensors_begun : events.sensors_ended).push_back(event);
    } else {
        (begins ? events.contacts_begun : events.contacts_ended).push_back({a, b});
    }
}

}  // namespace

void set_touching(BodyTable& bodies, const ColliderTable& colliders, const ContactTable& contacts, Events& events,
                  Contact& contact, bool touching) {
    if (contact.touching == touching) return;
    report_touch(bodies, colliders, contacts, events, contact, touching);
    contact.touching = touching;
    if (contact.sensor || touching) return;
    // What is no longer held must not fall asleep on the rest it had. It wakes alone, without its island.
    for (const auto& [collider, generation, body] : sides_of(contact)) {
        if (!is_current(colliders, collider, generation) || bodies.traits[body].kind != BodyKind::Dynamic) continue;
        restart_rest(bodies, body);
        if (bodies.traits[body].motion_state == MotionState::Asleep) bodies.let_go.push_back(body);
    }
}

void end_contact(BodyTable& bodies, const ColliderTable& colliders, ContactTable& contacts, Events& events,
                 std::uint32_t index) {
    set_touching(bodies, colliders, contacts, events, contacts[index], false);
    if (contacts.graph.resting_at(index) != no_index) remove_resting(contacts, index);
    contacts.graph.remove(index);
    Contact& contact = contacts[index];
    for (ContactManifold& manifold : contacts.manifolds.coloured(contact))
        contacts.colours.release(manifold.colour, contact.body_a, contact.body_b);
    contacts.manifolds.release(contact);
    contact = {};
    contacts.free.push_back(index);
}

void add_resting(ContactTable& contacts, std::uint32_t index) {
    const Contact& c = contacts[index];
    contacts.graph.set_resting_at(index, static_cast<std::uint32_t>(contacts.resting.size()));
    contacts.resting.append({c.collider_a, c.collider_b}, index);
}

void remove_resting(ContactTable& contacts, std::uint32_t index) {
    const std::uint32_t place = contacts.graph.resting_at(index);
    pairs::PairList& resting = contacts.resting;
    resting.pairs[place] = resting.pairs.back();
    resting.values[place] = resting.values.back();
    contacts.graph.set_resting_at(resting.values[place], place);
    contacts.graph.set_resting_at(index, no_index);
    resting.pairs.pop_back();
    resting.values.pop_back();
}

void rebuild_contact_graph(ContactTable& contacts) {
    contacts.graph.clear();
    for (const pairs::PairList* list : {&contacts.active, &contacts.resting})
        for (std::size_t i = 0; i < list->size(); ++i)
            contacts.graph.add(list->values[i], list->pairs[i].a, list->pairs[i].b);
    for (std::size_t i = 0; i < contacts.resting.size(); ++i)
        contacts.graph.set_resting_at(contacts.resting.values[i], static_cast<std::uint32_t>(i));
}

void gather_constraints(const BodyTable& bodies, float slop, ContactTable& contacts, Constraints& constraints,
                        std::span<const std::uint32_t> quarantined) {
    constexpr std::uint8_t moves = 1, left_out = 2;
    constexpr std::size_t prefetch_ahead = 6;
    std::vector<std::uint8_t>& role = constraints.roles;
    role.assign(bodies.traits.size(), 0);
    for (const std::uint32_t body : bodies.awake)
        role[body] = bodies.traits[body].kind == BodyKind::Dynamic ? moves : 0;
    for (const std::uint32_t body : quarantined) role[body] = left_out;
    contacts.colours.resize(bodies.traits.size());
    constraints.all.clear();
    constraints.results.clear();
    constraints.sensors.clear();
    constraints.beside_sleepers = false;
    constraints.points = 0;
    const std::vector<std::uint32_t>& active = contacts.active.values;
    if (constraints.all.capacity() < active.size()) {  // the first time; a manifold each is most often enough
        constraints.all.reserve(2 * active.size());
        constraints.results.reserve(2 * active.size());
    }
    for (std::size_t at = 0; at < active.size(); ++at) {
        if (at + prefetch_ahead < active.size()) detail::prefetch(contacts[active[at + prefetch_ahead]]);
        const std::uint32_t index = active[at];
        Contact& c = contacts[index];
        if (c.sensor) {
            constraints.sensors.push_back(index);
            continue;
        }
        for (std::size_t i = c.manifolds; i < c.coloured; ++i)
            contacts.colours.release(contacts.manifolds.coloured(c)[i].colour, c.body_a, c.body_b);
        c.coloured = c.manifolds;
        if (c.manifolds == 0) continue;
        constraints.points += c.points;
        // Written in place: a copy would wait for the single bytes.
        dynamics::Constraint& constraint = constraints.all.emplace_back();
        constraint.index = c.first_manifold;
        constraint.owner = index;
        constraint.body_a = c.body_a;
        constraint.body_b = c.body_b;
        if (role[c.body_a] != left_out && role[c.body_b] != left_out)
            constraint.moves = dynamics::moves_of(role[c.body_a] == moves, role[c.body_b] == moves);
        if (constraint.moves == dynamics::Moves::A || constraint.moves == dynamics::Moves::B) {
            const std::uint32_t other = constraint.moves == dynamics::Moves::A ? c.body_b : c.body_a;
            constraint.on_sleeper = bodies.traits[other].kind == BodyKind::Dynamic;
        }
        constraints.beside_sleepers |= constraint.on_sleeper || constraint.moves == dynamics::Moves::Neither;
        constraint.began = !c.touching;
        constraint.touches = c.touching || c.nearest <= slop;
        constraints.results.emplace_back().nearest = c.nearest;
        for (std::uint32_t i = 1; i < c.manifolds; ++i) {
            dynamics::Constraint next = constraints.all.back();
            ++next.index;
            constraints.all.push_back(next);
            constraints.results.push_back({c.nearest});
        }
    }
}

bool rebuild_colours(const BodyTable& bodies, ContactTable& contacts) {
    contacts.colours.clear();
    contacts.colours.resize(bodies.traits.size());
    for (const Contact& c : contacts.all) {
        const std::span<const ContactManifold> places = contacts.manifolds.places(c);
        for (std::size_t i = 0; i < places.size(); ++i) {
            const dynamics::ConstraintColour colour = places[i].colour;
            if (i >= c.coloured && colour.number != dynamics::ConstraintColour::none) return false;
            if (!contacts.colours.restore(colour, c.body_a, c.body_b)) return false;
        }
    }
    return true;
}

void sort_by_pair(const ContactTable& contacts, std::vector<std::uint32_t>& list) {
    std::sort(list.begin(), list.end(), [&](std::uint32_t x, std::uint32_t y) {
        const Contact &cx = contacts[x], &cy = contacts[y];
        return Pair{cx.collider_a, cx.collider_b} < Pair{cy.collider_a, cy.collider_b};
    });
    list.erase(std::unique(list.begin(), list.end()), list.end());
}

}  // namespace fase
