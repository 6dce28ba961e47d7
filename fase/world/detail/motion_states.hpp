#pragma once
/// Bodies fall asleep and wake; their boxes, pairs and contacts follow.
#include <cstdint>
#include <span>
#include <vector>

#include "fase/world/detail/contacts.hpp"
#include "fase/world/detail/query_trees.hpp"
#include "fase/world/detail/step_lists.hpp"
#include "fase/world/detail/tables.hpp"
#include "fase/world/events.hpp"
#include "fase/world/settings.hpp"

namespace fase {

/// The tables that change together when bodies wake or fall asleep: their lists, their boxes in the sets and in the
/// query trees, their pairs and contacts, and the events.
struct MotionStates {
    BodyTable& bodies;
    const ColliderTable& colliders;
    BroadPhase& broad_phase;
    ContactTable& contacts;
    QueryTrees& query;
    Events& events;

    [[nodiscard]] BodyContacts touching() const { return {bodies, colliders, contacts}; }
};

/// Whether a body has a velocity.
[[nodiscard]] inline bool is_moving(const dynamics::BodyMotion& motion) {
    return length_squared(motion.linear_velocity) > 0 || length_squared(motion.angular_velocity) > 0;
}

// world/motion_states.cpp
/// Moves the added bodies to the list of awake ones: at the beginning of a step.
void merge_awake_added(BodyTable& bodies);
/// Removes a body from the lists of awake bodies.
void remove_awake(BodyTable& bodies, std::uint32_t body);
/// Change the motion state of bodies to awake or asleep, and move their boxes and pairs. `bodies` ascending.
void move_to_awake(const MotionStates& state, std::span<const std::uint32_t> bodies);
void move_to_asleep(const MotionStates& state, std::span<const std::uint32_t> bodies);
/// Moves the pairs of these bodies, whose motion state has changed, to the right list: active when one of the two
/// bodies is awake, else resting. Waking costs O(own pairs + active pairs), as does falling asleep.
void update_pair_lists(const BodyTable& bodies, const ColliderTable& colliders, BroadPhase& broad_phase,
                       ContactTable& contacts, std::span<const std::uint32_t> changed);
/// Call when a collider is added, removed, moved or changed by the user: the next step checks its pairs. Includes
/// mark_box_changed(). Edits of a new collider call reserve_colliders() before.
void mark_edited(BroadPhase& broad_phase, QueryTrees& query, std::uint32_t collider);

// world/wake.cpp
/// Requests that the next step wakes the body's island before it finds pairs. Does nothing for a body that is awake or
/// quarantined. Edits call reserve_wakes() before.
void request_wake(BodyTable& bodies, std::uint32_t body);
/// Call when something may have changed what moves a body: wakes it, and restarts its rest after
/// Settings::time_to_sleep. Does nothing for static
/// bodies, and for kinematic ones without velocity. Edits call reserve_wakes() before.
void disturb(BodyTable& bodies, const Settings& settings, std::uint32_t body);
/// Wakes the islands of all bodies in BodyTable::to_wake, and what they carry. Restarts the rest of the requested
/// bodies; the others stay awake for at least Settings::time_to_sleep.
void wake_requested_islands(const MotionStates& state, const Settings& settings);
/// Wakes the sleeping bodies behind those that are struck, as far as each blow may move them. Sorts the blows, and
/// keeps the hardest on each body.
void wake_struck(const MotionStates& state, const Settings& settings, std::vector<Blow>& blows);
/// Whether the other body of a contact lies on `lower`.
[[nodiscard]] bool carries(const dynamics::ManifoldPool& manifolds, Vec3 gravity, const dynamics::Contact& contact,
                           std::uint32_t lower);
/// Appends the dynamic bodies that lie on those of the list, and on these, and so on. `marks`: by body, 1 for those in
/// the list.
void add_carried(const BodyContacts& touching, Vec3 gravity, std::vector<std::uint32_t>& list,
                 std::vector<std::uint8_t>& marks);

}  // namespace fase
