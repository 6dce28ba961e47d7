#pragma once
/// What the stages of a step hand to each other. Each struct is named for what its stage produces; the next step
/// replaces it. No part of hash or snapshot.
#include <cstdint>
#include <vector>

#include "fase/dynamics/solver/constraint.hpp"
#include "fase/dynamics/solver/contact_lanes.hpp"
#include "fase/dynamics/solver/islands.hpp"
#include "fase/geometry/aabb.hpp"
#include "fase/narrow/seams/seams.hpp"

namespace fase {

/// From "refresh": what will move in this step.
struct Moved {
    std::vector<std::uint32_t> colliders;  ///< those that left their fat box
    std::vector<Aabb> previous_boxes;      ///< by collider, valid for those: the fat box before this step
    std::vector<float> sweep;              ///< by body: metres that a fast body may move; 0 for slow bodies
    std::vector<std::uint32_t> clamped;    ///< bodies whose speed was clamped before the step, ascending
};

/// Where the middle of a shape is before the bodies move.
struct MiddlePath {
    std::uint32_t contact = 0;  ///< with a shape of a static or kinematic body
    Vec3d start;                ///< narrow::middle_of() the dynamic body's shape, in the frame of the other
};

/// A contact that is corrected together with its neighbours, and what it was in the last step.
struct SeamEntry {
    std::uint32_t contact = 0, active = 0;  ///< its index, and its place in ContactTable::active
    bool reused = false;
    dynamics::Contact before;
    dynamics::ContactManifold manifold_before;
};

/// The contacts of one moving collider with what does not move.
struct SeamGroup {
    std::uint32_t mover = 0;  ///< collider
    std::uint32_t first = 0, count = 0;
};

/// Inside "collide": the contacts that are corrected at seams.
struct SeamGroups {
    static constexpr std::uint32_t placed = 1u << 31;
    std::vector<SeamGroup> all;                 ///< in the order of their first contacts
    std::vector<SeamEntry> entries;             ///< of all groups; more than these use
    std::vector<narrow::SeamContact> contacts;  ///< for each entry
    std::vector<std::uint8_t> is_grouped;       ///< by active pair
    std::vector<std::uint32_t> movers;          ///< by active pair, inside find_seam_groups()
    std::vector<std::uint32_t> count_of;        ///< by collider, inside find_seam_groups()
    std::vector<std::uint32_t> place_of;        ///< by collider, inside find_seam_groups()
};

/// From "collide": the constraints of this step. "islands" and "solve" list them again when active contacts were added
/// or bodies were quarantined; the solver fills the results.
struct Constraints {
    std::vector<dynamics::Constraint> all;         ///< manifolds with points, in the order of ContactTable::active
    std::vector<dynamics::ContactResult> results;  ///< one for each constraint
    std::vector<std::uint32_t> sensors;  ///< active contacts of sensors, which are collided after the bodies moved
    std::vector<std::uint32_t> checked;  ///< resting contacts that this step collided
    std::vector<std::uint8_t> reused;    ///< by active pair: the manifolds of the last step were reused
    SeamGroups seams;
    std::vector<MiddlePath> middle_paths;  ///< of fast bodies, on meshes, beside what turns; in the order of pairs
    std::vector<std::uint8_t> roles;       ///< by body, inside gather_constraints(): what contacts do to it
    std::uint32_t points = 0;              ///< of all constraints together
    bool beside_sleepers = false;          ///< a constraint may have a dynamic body that sleeps
};

/// A body that is struck, and the momentum of what strikes it in kg m/s.
struct Blow {
    std::uint32_t body = 0;
    float momentum = 0;
};

/// Inside "islands". Its result is BodyMotion::island.
struct IslandLists {
    std::vector<Blow> blows;
    dynamics::DisjointSets sets;             ///< of bodies
    std::vector<std::uint8_t> near_sleeper;  ///< by body, in wake_touched(): 1: its set holds a sleeper
};

/// Whether an island may fall asleep.
struct IslandActivity {
    std::uint32_t bodies = 0, active_bodies = 0;
    bool must_stay_awake = false;  ///< a body moves too fast, or may not sleep
    bool searched = false;         ///< what its moving bodies keep awake matters
};

/// Inside "sleep".
struct SleepLists {
    std::vector<IslandActivity> activity;   ///< by island
    std::vector<std::uint32_t> kept_awake;  ///< bodies
    std::vector<std::uint32_t> below;       ///< bodies, inside keep_below()
    /// Inside find_kept_awake(): moving bodies that touch one at rest, ascending.
    std::vector<std::uint32_t> beside_rested;
    std::vector<const dynamics::Constraint*> joined;  ///< inside find_searched(): touches that began
};

}  // namespace fase
