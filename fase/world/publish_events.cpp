/// Stage "events": collects the contact, sensor and hit events of the step.
#include <algorithm>
#include <cstddef>
#include <tuple>
#include <utility>

#include "fase/core/detail/prefetch.hpp"
#include "fase/world/detail/stages.hpp"

namespace fase {

using dynamics::Contact;

namespace {

/// What publish_contact() reads and writes.
struct EventTables {
    const Settings& settings;
    const ColliderTable& colliders;
    const Constraints& constraints;
    BodyTable& bodies;
    ContactTable& contacts;
    Events& events;
};

/// Hysteresis: touching begins within the slop and ends beyond twice the slop, so that a resting contact does not
/// flicker.
bool touches(float slop, const Contact& c, float nearest, bool pushes) {
    if (c.manifolds == 0) return false;
    if (c.sensor) return nearest <= 0;
    return pushes || nearest <= (c.touching ? 2 : 1) * slop;
}

/// The speed at which the surfaces still close at a place, m/s.
float closing_speed(const BodyTable& bodies, const Contact& c, const Vec3d& place, Vec3 normal) {
    const auto velocity = [&](std::uint32_t body) {
        const dynamics::BodyMotion& motion = bodies.motion[body];
        return motion.linear_velocity + cross(motion.angular_velocity, to_float(place - motion.position));
    };
    return dot(velocity(c.body_a) - velocity(c.body_b), normal);
}

/// Whether an open hit is one of these two colliders, which are still those that were hit.
bool is_of(const HitEvent& hit, const Contact& c) {
    return hit.a.index == c.collider_a && hit.b.index == c.collider_b && hit.a.generation == c.generation_a &&
           hit.b.generation == c.generation_b;
}

/// Publishes what happened at one contact; its constraints begin at number `first`. `open`: the hit that the last step
/// did not end, if any.
void publish_contact(const EventTables& tables, Contact& c, std::size_t first, const OpenHit* open) {
    const auto& [settings, colliders, constraints, bodies, contacts, events] = tables;
    float nearest = Aabb::infinity, approach = 0, impulse = 0;
    bool pushes = false;
    std::size_t hardest = first;
    for (std::size_t i = first; i < first + c.manifolds; ++i) {
        const dynamics::ContactResult& result = constraints.results[i];
        nearest = std::min(nearest, result.nearest);
        if (!result.pushes) continue;
        pushes = true;
        impulse += result.impulse;
        approach = std::max(approach, result.approach);
        if (result.impulse > constraints.results[hardest].impulse) hardest = i;
    }
    set_touching(bodies, colliders, contacts, events, c, touches(settings.linear_slop, c, nearest, pushes));
    OpenHit hit;
    if (open) {
        hit = *open;
        hit.impulse += impulse;
        hit.speed = std::max(hit.speed, approach);
    } else {
        if (!pushes || !(approach > settings.restitution_threshold)) return;
        const auto [a, b] = event_colliders(bodies, colliders, contacts, c);
        const Vec3d place = bodies.motion[c.body_a].position + to_double(constraints.results[hardest].hit_offset_a);
        const Vec3 normal = contacts.manifolds[constraints.all[hardest].index].normal;
        hit = {{a, b, place, normal, approach, impulse}};
    }
    constexpr std::uint32_t max_steps = 4;  // what presses on and on is told in between
    const float stopped = std::min(0.01f * hit.speed, settings.restitution_threshold);
    const bool goes_on = pushes && ++hit.steps < max_steps && closing_speed(bodies, c, hit.point, hit.normal) > stopped;
    if (goes_on) {
        contacts.open_hits.push_back(hit);
    } else {
        events.hits.push_back(hit);
    }
}

template <class E, class F> void sort_by(std::vector<E>& events, const F& key) {
    std::sort(events.begin(), events.end(), [&](const E& x, const E& y) { return key(x) < key(y); });
}

}  // namespace

void publish_events(const Settings& settings, const ColliderTable& colliders, const Constraints& constraints,
                    BodyTable& bodies, ContactTable& contacts, Events& events) {
    const auto set_touching_now = [&](Contact& c) {
        set_touching(bodies, colliders, contacts, events, c, touches(settings.linear_slop, c, c.nearest, false));
    };
    for (const std::uint32_t index : constraints.checked)  // one that woke in this step is in the active list now
        if (Contact& c = contacts[index]; contacts.graph.resting_at(index) != no_index) set_touching_now(c);
    const EventTables tables{settings, colliders, constraints, bodies, contacts, events};
    // Hits that the last step did not end are told now, in the order of pairs; those of contacts that ended, too.
    const std::vector<OpenHit> open = std::exchange(contacts.open_hits, {});
    std::size_t first = 0, next = 0;
    const std::vector<std::uint32_t>& active = contacts.active.values;
    constexpr std::size_t prefetch_ahead = 6;
    for (std::size_t i = 0; i < active.size(); ++i) {
        if (i + prefetch_ahead < active.size()) detail::prefetch(contacts[active[i + prefetch_ahead]]);
        Contact& c = contacts[active[i]];
        if (c.sensor) {
            set_touching_now(c);
        } else {
            const std::pair pair{c.collider_a, c.collider_b};
            while (next < open.size() && std::pair{open[next].a.index, open[next].b.index} < pair)
                events.hits.push_back(open[next++]);
            const bool goes_on = next < open.size() && is_of(open[next], c);
            publish_contact(tables, c, first, goes_on ? &open[next++] : nullptr);
            first += c.manifolds;
        }
    }
    events.hits.insert(events.hits.end(), open.begin() + static_cast<std::ptrdiff_t>(next), open.end());
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
