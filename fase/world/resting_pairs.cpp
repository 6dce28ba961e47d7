/// Pairs of colliders that both rest: they are looked at when they begin, and when either collider is edited.
#include <algorithm>

#include "fase/world/detail/stages.hpp"

namespace fase {

using broad::Pair;
using dynamics::Contact;

void disturb_around_edits(const Settings& settings, BodyTable& bodies, const ColliderTable& colliders,
                          const BroadPhase& broad_phase, const ContactTable& contacts) {
    for (const std::uint32_t edit : broad_phase.edited_colliders)
        contacts.graph.for_each_of(edit, [&](std::uint32_t index) {
            const Contact& c = contacts[index];
            if (c.sensor || c.manifolds == 0) return;
            for (const auto& [collider, generation, body] : sides_of(c))
                if (is_current(colliders, collider, generation)) disturb(bodies, settings, body);
        });
}

void update_resting(const MotionStates& state, std::span<const Pair> found) {
    ContactTable& contacts = state.contacts;
    std::vector<std::uint32_t> checked;
    for (const std::uint32_t edit : state.broad_phase.edited_colliders)
        contacts.graph.for_each_of(edit, [&](std::uint32_t contact) {
            if (contacts.graph.resting_at(contact) != no_index) checked.push_back(contact);
        });
    sort_by_pair(contacts, checked);
    std::vector<Pair> kept;
    for (const std::uint32_t contact : checked) {
        const Pair pair{contacts[contact].collider_a, contacts[contact].collider_b};
        if (has_ended(state.bodies, state.colliders, state.broad_phase, pair, contacts[contact])) {
            end_contact(state.bodies, state.colliders, contacts, state.events, contact);
            continue;
        }
        kept.push_back(pair);
        compute_anew(contacts[contact]);
        contacts.to_check.push_back(contact);
    }
    for (const Pair pair : found) {
        if (std::binary_search(kept.begin(), kept.end(), pair)) continue;
        const std::uint32_t contact = add_contact(state.colliders, contacts, pair);
        add_resting(contacts, contact);
        contacts.to_check.push_back(contact);
    }
}

}  // namespace fase
