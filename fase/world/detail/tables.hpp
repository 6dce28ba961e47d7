#pragma once
/// The tables of a world: flat arrays, each of one owner. Members that hash and snapshot cover stand first in each
/// table; those below "Remade" follow from them, or hold nothing between two calls.
#include <cstdint>
#include <string>
#include <unordered_map>
#include <vector>

#include "fase/core/ids.hpp"
#include "fase/dynamics/solver/bodies.hpp"
#include "fase/dynamics/solver/constraint_colours.hpp"
#include "fase/dynamics/solver/contact.hpp"
#include "fase/dynamics/solver/manifold_pool.hpp"
#include "fase/pairs/box_sets.hpp"
#include "fase/pairs/detail/sort_pairs.hpp"
#include "fase/pairs/filter.hpp"
#include "fase/pairs/pair_list.hpp"
#include "fase/world/body.hpp"
#include "fase/world/detail/contact_graph.hpp"
#include "fase/world/detail/sleepers.hpp"
#include "fase/world/events.hpp"

namespace fase {

/// How far a world has come.
struct WorldClock {
    std::uint64_t steps = 0;
    double time = 0;
    float last_sub_step = 0;  ///< seconds; 0 before the first step
};

/// All bodies. Edits add, remove and change them; the solver moves those that are awake.
struct BodyTable : dynamics::Bodies {
    IdPool<BodyTag> ids;
    pairs::PairExclusions exclusions;
    std::vector<std::uint32_t> awake;        ///< body indices, ascending: dynamic ones and moving kinematic ones
    std::vector<std::uint32_t> awake_added;  ///< bodies added since the last step, not yet in `awake`; in any order
    Sleepers asleep;                         ///< its links are remade
    std::vector<std::uint32_t> to_wake;      ///< the next step wakes their islands before it finds pairs
    std::vector<std::uint32_t> let_go;       ///< sleepers whose contact ended: the stage "sleep" wakes them

    // Remade.
    std::vector<std::uint8_t> marks;   ///< by body; all 0 between uses
    std::vector<std::uint8_t> held;    ///< by body, in finish(), valid for awake ones: a contact acted on it
    std::vector<std::uint8_t> faults;  ///< in finish(), by place in `awake`: 1: invalid motion, 2: left the world
};

/// A collider: one shape on a body, in the form that the step reads.
struct Collider {
    std::uint32_t body = no_index;
    std::uint32_t next = no_index;  ///< the body's next collider
    std::uint32_t shape = 0;        ///< index of ColliderTable::shapes
    bool sensor = false;
    bool unused[3] = {};
    LocalPose in_principal;  ///< pose of the shape in the frame of the centre of mass and the principal axes
    LocalPose in_body;       ///< pose of the shape in the body's frame
    Material material;
    float density = 0;
    std::uint16_t unused_tail[2] = {};
    pairs::CollisionFilter filter;
    std::uint64_t user = 0;
};

/// A shape that all colliders with an equal shape share.
struct SharedShape {
    Shape shape;
    std::uint32_t users = 0;
    float outer_radius = 0, inner_radius = 0;
    std::uint64_t key = 0;  ///< hash of the content
};

/// All colliders and their shapes. Edits change them; every stage of a step only reads them.
struct ColliderTable {
    IdPool<ColliderTag> ids;
    std::vector<Collider> all;  ///< by collider index
    std::vector<SharedShape> shapes;
    std::vector<std::uint32_t> free_shapes;

    // Remade.
    std::unordered_multimap<std::uint64_t, std::uint32_t> shape_of_key;  ///< by SharedShape::key
    std::uint32_t meshes = 0;                                            ///< shapes that are meshes

    [[nodiscard]] Collider& operator[](std::uint32_t collider) { return all[collider]; }
    [[nodiscard]] const Collider& operator[](std::uint32_t collider) const { return all[collider]; }
};

/// What happened to a collider since the last step, as bits.
enum ColliderChange : std::uint8_t {
    moved_box = 1,      ///< it left its fat box
    edited = 2,         ///< the user added, moved, changed or removed it
    state_changed = 4,  ///< the motion state of its body changed; set only inside update_pair_lists()
};

/// The fat boxes of all colliders, in sets by motion state, and what changed since the pairs were last updated.
struct BroadPhase {
    std::vector<Aabb> boxes;                      ///< fat boxes, by collider
    std::vector<std::uint8_t> changes;            ///< ColliderChange bits, by collider
    std::vector<std::uint32_t> edited_colliders;  ///< the next step queries their pairs
    bool removed_any = false;                     ///< pairs of removed colliders may be in the lists
    bool query_all_awake = false;                 ///< pairs were dropped: the next step queries every awake box again

    // Remade.
    std::string structure;                 ///< Setup::structure
    pairs::BoxSets sets;                   ///< edits reach them in the next step
    std::vector<std::uint8_t> set_of;      ///< by collider: 0 when its box is in no set, else 1 + the set's MotionState
    std::vector<broad::Move> query_boxes;  ///< in track_pairs() and move_boxes()
    std::vector<std::uint32_t> proxies;    ///< in move_boxes()
    std::vector<broad::Pair> candidates;   ///< in track_pairs()
    pairs::PairSorter sorter;
};

/// A hit after which the surfaces still close.
struct OpenHit : HitEvent {
    std::uint32_t steps = 0;  ///< over which its impulse was summed
};

/// All pairs of colliders whose fat boxes overlap: each is in one of two lists and has a contact.
struct ContactTable {
    pairs::PairList active;              ///< pairs with at least one awake body, ascending; values: contacts
    pairs::PairList resting;             ///< pairs without an awake body, in no order
    std::vector<dynamics::Contact> all;  ///< by contact index
    std::vector<std::uint32_t> free;
    dynamics::ManifoldPool manifolds;  ///< of the contacts; where in the pool they lie is remade
    /// Resting contacts that the next step collides once: new ones, those of edited colliders, and those of sensors
    /// whose visitor fell asleep.
    std::vector<std::uint32_t> to_check;
    std::vector<OpenHit> open_hits;      ///< in the order of pairs: the last step did not end them, the next tells them
    std::vector<EventCollider> removed;  ///< colliders removed since the last step, for the ends of their contacts

    // Remade.
    ContactGraph graph;
    dynamics::ConstraintColours colours;  ///< those that the manifolds have
    std::vector<std::uint32_t> woken;     ///< in update_pair_lists(): those that move to the active list
    std::vector<broad::Pair> woken_pairs;

    [[nodiscard]] dynamics::Contact& operator[](std::uint32_t contact) { return all[contact]; }
    [[nodiscard]] const dynamics::Contact& operator[](std::uint32_t contact) const { return all[contact]; }
};

}  // namespace fase
