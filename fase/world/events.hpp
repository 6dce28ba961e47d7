#pragma once
/// Events of the last step.
#include <span>
#include <vector>

#include "fase/world/body.hpp"

namespace fase {

/// A collider in an event: its id, its body, and the user data of both. All stay readable until the next step, though
/// the collider may be removed by then.
struct EventCollider : ColliderId {
    BodyId body;
    std::uint64_t user = 0, body_user = 0;
};
/// Two colliders began or stopped touching; a has the smaller index. The id of a collider that was removed is stale.
struct ContactEvent {
    EventCollider a, b;
    friend bool operator==(const ContactEvent&, const ContactEvent&) = default;
};
/// Two colliders hit each other faster than Settings::restitution_threshold. Told once: a hit that begins at the end of
/// a step, so that the bodies still close, is told by the next step, with the impulses of both.
struct HitEvent {
    EventCollider a, b;
    Vec3d point;        ///< world, where the surfaces met, at the moment of touch
    Vec3 normal;        ///< unit, from a to b
    float speed = 0;    ///< m/s of approach, before the hit
    float impulse = 0;  ///< N s along the normal, of all points, until the surfaces no longer close
};
/// `visitor` began or stopped overlapping `sensor`.
struct SensorEvent {
    EventCollider sensor, visitor;
    friend bool operator==(const SensorEvent&, const SensorEvent&) = default;
};

/// All events of one step. Each list is in the order of the ids, the same for any thread count and structure. When a
/// body is removed between steps, the next step reports the end of its contacts.
struct Events {
    std::vector<ContactEvent> contacts_begun, contacts_ended;
    std::vector<HitEvent> hits;
    std::vector<SensorEvent> sensors_begun, sensors_ended;
    std::vector<BodyId> fell_asleep, woke_up;
    void clear() {
        contacts_begun.clear();
        contacts_ended.clear();
        hits.clear();
        sensors_begun.clear();
        sensors_ended.clear();
        fell_asleep.clear();
        woke_up.clear();
    }
};

}  // namespace fase
