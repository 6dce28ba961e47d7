#pragma once
/// What happened in the last step, read after it.
#include <span>
#include <vector>

#include "fase/world/body.hpp"

namespace fase {

/// Two colliders began or ceased to touch; a is the one with the smaller index. When one of them was removed, its id is
/// stale.
struct ContactEvent {
    ColliderId a, b;
    friend bool operator==(const ContactEvent&, const ContactEvent&) = default;
};
/// Two colliders met with at least the restitution threshold's speed.
struct HitEvent {
    ColliderId a, b;
    Vec3d point;        ///< world, the deepest point of the contact
    Vec3 normal;        ///< unit, from a to b
    float speed = 0;    ///< m/s of approach, before the hit
    float impulse = 0;  ///< N s along the normal, summed over the contact's points and the step
};
/// A body came into a sensor or left it: `visitor` began or ceased to overlap `sensor`.
struct SensorEvent {
    ColliderId sensor, visitor;
    friend bool operator==(const SensorEvent&, const SensorEvent&) = default;
};

/// All that happened in one step, each list in the order of the ids, the same for any thread count and structure.
/// Contacts that end because a body was removed between steps are told by the next step.
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
