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
bool touches(const WorldState& state, const Contact& c) {
    if (c.count == 0) return false;
    if (c.sensor) return c.nearest <= 0;
    return c.pushes || c.nearest <= (c.touching ? 2 : 1) * state.settings.linear_slop;
}

/// Returns where the surfaces met, in world space.
Vec3d hit_point(const WorldState& state, const Contact& c) {
    return state.bodies.motion[c.body_a].position + to_double(c.hit_offset_a);
}

template <class E, class F> void sort_by(std::vector<E>& events, const F& key) {
    std::sort(events.begin(), events.end(), [&](const E& x, const E& y) { return key(x) < key(y); });
}

}  // namespace

void publish_events(WorldState& state) {
    Events& events = state.events;
    for (const std::uint32_t index : state.checked)  // one that woke in this step is in the active list now
        if (state.contact_graph.resting_at(index) != no_index)
            set_touching(state, state.contacts[index], touches(state, state.contacts[index]));
    for (const std::uint32_t index : state.active.values) {
        Contact& c = state.contacts[index];
        set_touching(state, c, touches(state, c));
        if (c.pushes && c.approach > state.settings.restitution_threshold) {
            HitEvent hit{{}, {}, hit_point(state, c), c.normal, c.approach, 0};
            const ContactEvent ids = ids_of(state, c);
            hit.a = ids.a;
            hit.b = ids.b;
            for (int i = 0; i < c.count; ++i) hit.impulse += c.total_impulse[i];
            events.hits.push_back(hit);
        }
        c.pushes = false;
        c.approach = 0;
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
