#pragma once
/// Pairs and their contacts, which begin, touch and end, and the list of constraints.
#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/world/detail/step_lists.hpp"
#include "fase/world/detail/tables.hpp"
#include "fase/world/events.hpp"

namespace fase {

/// One side of a contact.
struct ContactSide {
    std::uint32_t collider;
    std::uint16_t generation;
    std::uint32_t body;
};
[[nodiscard]] inline std::array<ContactSide, 2> sides_of(const dynamics::Contact& c) {
    return {{{c.collider_a, c.generation_a, c.body_a}, {c.collider_b, c.generation_b, c.body_b}}};
}
/// Whether a collider was not removed since `generation` was read; its slot may have a new owner by now.
[[nodiscard]] inline bool is_current(const ColliderTable& colliders, std::uint32_t collider, std::uint16_t generation) {
    return colliders.ids.alive_at(collider) && colliders.ids.slots()[collider].generation == generation;
}

/// What tells which bodies touch: read only.
struct BodyContacts {
    const BodyTable& bodies;
    const ColliderTable& colliders;
    const ContactTable& contacts;
};

/// Calls f(contact, other) for each dynamic body that touches a body, in unspecified order, once a contact. Leaves out
/// contacts of removed colliders, which the next step ends.
template <class F> void for_each_touched(const BodyContacts& of, std::uint32_t body, const F& f) {
    for (std::uint32_t c = of.bodies.traits[body].first_collider; c != no_index; c = of.colliders[c].next)
        of.contacts.graph.for_each_of(c, [&](std::uint32_t index) {
            const dynamics::Contact& contact = of.contacts[index];
            if (!contact.touching || contact.sensor) return;
            for (const auto& [collider, generation, side_body] : sides_of(contact))
                if (!is_current(of.colliders, collider, generation)) return;
            const std::uint32_t other = contact.body_a == body ? contact.body_b : contact.body_a;
            if (of.bodies.traits[other].kind == BodyKind::Dynamic) f(contact, other);
        });
}

// Contacts and their lists (world/contacts.cpp).
/// Initialises a free contact for a pair and returns its index; the caller adds it to a list.
[[nodiscard]] std::uint32_t add_contact(const ColliderTable& colliders, ContactTable& contacts, broad::Pair pair);
/// Allocates for `count` more contacts, so that a scene that begins does not grow its tables in many turns.
void reserve_contacts(ContactTable& contacts, std::size_t count);
/// Frees a contact and reports the end of the touch. Removes it from the resting list, but not from the active one.
void end_contact(BodyTable& bodies, const ColliderTable& colliders, ContactTable& contacts, Events& events,
                 std::uint32_t contact);
/// Returns what events tell of a collider that exists.
[[nodiscard]] EventCollider event_collider(const BodyTable& bodies, const ColliderTable& colliders,
                                           std::uint32_t collider);
/// Returns what events tell of the two colliders of a contact; either may have been removed since the last step. Call
/// sort_removed() before, when there are removed ones. O(log removed).
[[nodiscard]] std::array<EventCollider, 2> event_colliders(const BodyTable& bodies, const ColliderTable& colliders,
                                                           const ContactTable& contacts,
                                                           const dynamics::Contact& contact);
/// Sorts ContactTable::removed, which event_colliders() searches: at the beginning of track_pairs().
void sort_removed(ContactTable& contacts);
/// Lets the next step compute the manifolds of a contact from its shapes, as if it had just begun.
inline void compute_anew(dynamics::Contact& contact) {
    contact.reusable = false;
    contact.reuse_distance = 0;
}
/// Restarts the time that a body has rested; a time that is still negative after an edit stays.
inline void restart_rest(BodyTable& bodies, std::uint32_t body) {
    float& rest = bodies.motion[body].sleep_time;
    rest = std::min(rest, 0.0f);
}
/// Sets whether two colliders touch, and reports the change. Restarts the rest of bodies whose contact ends.
void set_touching(BodyTable& bodies, const ColliderTable& colliders, const ContactTable& contacts, Events& events,
                  dynamics::Contact& contact, bool touching);
void add_resting(ContactTable& contacts, std::uint32_t contact);
void remove_resting(ContactTable& contacts, std::uint32_t contact);
/// Sorts contacts by their pairs and removes duplicates.
void sort_by_pair(const ContactTable& contacts, std::vector<std::uint32_t>& list);
/// Call after the pair lists were replaced.
void rebuild_contact_graph(ContactTable& contacts);
/// Sets friction and restitution of a contact's manifolds from the materials of its colliders.
void update_materials(const ColliderTable& colliders, ContactTable& contacts, std::uint32_t contact);
/// Lists the constraints of the active contacts, and the sensors among these. Frees the colours of manifolds that
/// ended. `slop`: Settings::linear_slop. `quarantined`: bodies whose contacts move nothing, because they end in the
/// next step.
void gather_constraints(const BodyTable& bodies, float slop, ContactTable& contacts, Constraints& constraints,
                        std::span<const std::uint32_t> quarantined = {});
/// Takes the colours of all manifolds after a restore. Returns false when they contradict each other.
[[nodiscard]] bool rebuild_colours(const BodyTable& bodies, ContactTable& contacts);

// Which pairs there are (world/track_pairs.cpp).
/// Whether two colliders may make a contact: by kinds, sensors, filters and exclusions.
[[nodiscard]] bool may_make_contact(const BodyTable& bodies, const ColliderTable& colliders, broad::Pair pair);
/// Whether a pair of a list ends: its boxes parted, or a collider was removed or changed. Reads two bytes of pairs that
/// did not change.
[[nodiscard]] bool has_ended(const BodyTable& bodies, const ColliderTable& colliders, const BroadPhase& broad_phase,
                             broad::Pair pair, const dynamics::Contact& contact);

}  // namespace fase
