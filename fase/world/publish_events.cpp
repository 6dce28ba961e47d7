/// Stage "events": collects the contact, sensor and hit events of the step.
#include <algorithm>
#include <tuple>

#include "fase/world/detail/state.hpp"

namespace fase {

using dynamics::Contact;

namespace {

ContactEvent ids_of(const WorldState& state, const Contact& c) {
    return {{c.collider_a, c.generation_a, state.collider_ids.owner()},
            {c.collider_b, c.generation_b, state.collider_ids.owner()}};
}

/// Hysteresis: touching begins within the slop and ends beyond twice the slop, so that a resting contact does not
/// flicker.
bool touches(const WorldState& state, const Contact& c, float nearest, bool pushes) {
    if (c.manifolds == 0) return false;
    if (c.sensor) return nearest <= 0;
    return pushes || nearest <= (c.touching ? 2 : 1) * state.settings.linear_slop;
}

/// Publishes what happened at one contact; its constraints begin at number `first`.
void publish_contact(WorldState& state, Contact& c, std::size_t first) {
    float nearest = Aabb::infinity, approach = 0, impulse = 0;
    bool pushes = false;
    std::size_t hardest = first;
    for (std::size_t i = first; i < first + c.manifolds; ++i) {
        const dynamics::ContactResult& result = state.results[i];
        nearest = std::min(nearest, result.nearest);
        if (!result.pushes) continue;
        pushes = true;
        impulse += result.impulse;
        approach = std::max(approach, result.approach);
        if (result.impulse > state.results[hardest].impulse) hardest = i;
    }
    set_touching(state, c, touches(state, c, nearest, pushes));
    if (!pushes || !(approach > state.settings.restitution_threshold)) return;
    const ContactEvent ids = ids_of(state, c);
    const Vec3d place = state.bodies.motion[c.body_a].position + to_double(state.results[hardest].hit_offset_a);
    state.events.hits.push_back(
        {ids.a, ids.b, place, state.manifolds[state.constraints[hardest].index].normal, approach, impulse});
}

template <class E, class F> void sort_by(std::vector<E>& events, const F& key) {
    std::sort(events.begin(), events.end(), [&](const E& x, const E& y) { return key(x) < key(y); });
}

}  // namespace

void publish_events(WorldState& state) {
    Events& events = state.events;
    for (const std::uint32_t index : state.checked)  // one that woke in this step is in the active list now
        if (Contact& c = state.contacts[index]; state.contact_graph.resting_at(index) != no_index)
            set_touching(state, c, touches(state, c, c.nearest, false));
    std::size_t first = 0;
    for (const std::uint32_t index : state.active.values) {
        Contact& c = state.contacts[index];
        if (c.sensor) {
            set_touching(state, c, touches(state, c, c.nearest, false));
        } else {
            publish_contact(state, c, first);
            first += c.manifolds;
        }
    }
    const auto pair_key = [](const ContactEvent& e) { return std::tuple{e.a.index, e.b.index, e.a.generation}; };
    sort_by(events.contacts_begun, pair_key);
    sort_by(events.contacts_ended, pair_key);
    const auto sensor_key = [](const SensorEvent& e) {
        return std::tuple{e.sensor.index, e.visitor.index, e.sensor.generation};
    };
    sort_by(events.sensors_begun, sensor_key);
    sort_by(events.sensors_ended, sensor_key);
    sort_by(events.woke_up, [](BodyId id) { return id.index; });
}

}  // namespace fase
