/// Pairs of colliders that both rest: they are looked at when they begin, and when either collider is edited.
#include <algorithm>

#include "fase/world/detail/state.hpp"

namespace fase {

using broad::Pair;
using dynamics::Contact;

void disturb_around_edits(WorldState& state) {
    for (const std::uint32_t edit : state.edited_colliders)
        state.contact_graph.for_each_of(edit, [&](std::uint32_t index) {
            const Contact& c = state.contacts[index];
            if (c.sensor || c.manifolds == 0) return;
            for (const auto& [collider, generation, body] : sides_of(c))
                if (is_current(state, collider, generation)) disturb(state, body);
        });
}

void update_resting(WorldState& state, std::span<const Pair> found) {
    std::vector<std::uint32_t> contacts;
    for (const std::uint32_t edit : state.edited_colliders)
        state.contact_graph.for_each_of(edit, [&](std::uint32_t contact) {
            if (state.contact_graph.resting_at(contact) != no_index) contacts.push_back(contact);
        });
    sort_by_pair(state, contacts);
    std::vector<Pair> kept;
    for (const std::uint32_t contact : contacts) {
        const Pair pair{state.contacts[contact].collider_a, state.contacts[contact].collider_b};
        if (has_ended(state, pair, contact)) {
            end_contact(state, contact);
            continue;
        }
        kept.push_back(pair);
        state.contacts[contact].reusable = false;
        state.contacts_to_check.push_back(contact);
    }
    for (const Pair pair : found) {
        if (std::binary_search(kept.begin(), kept.end(), pair)) continue;
        const std::uint32_t contact = add_contact(state, pair);
        add_resting(state, contact);
        state.contacts_to_check.push_back(contact);
    }
}

}  // namespace fase
