#pragma once
/// The state of a world as flat arrays, and the stages of its step.
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <unordered_map>
#include <vector>

#include "fase/broad/wide_bvh.hpp"
#include "fase/core/ids.hpp"
#include "fase/core/tasks.hpp"
#include "fase/dynamics/solver/bodies.hpp"
#include "fase/dynamics/solver/contact.hpp"
#include "fase/dynamics/solver/islands.hpp"
#include "fase/dynamics/solver/solver.hpp"
#include "fase/pairs/box_sets.hpp"
#include "fase/pairs/detail/sort_pairs.hpp"
#include "fase/pairs/filter.hpp"
#include "fase/pairs/pair_list.hpp"
#include "fase/world/body.hpp"
#include "fase/world/detail/contact_graph.hpp"
#include "fase/world/detail/sleepers.hpp"
#include "fase/world/events.hpp"
#include "fase/world/settings.hpp"
#include "fase/world/stats.hpp"

namespace fase {

/// A collider: one shape on a body, in the form that the step reads.
struct Collider {
    std::uint32_t body = no_index;
    std::uint32_t next = no_index;  ///< the body's next collider
    std::uint32_t shape = 0;        ///< index of WorldState::shapes
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

/// A body that is struck, and the momentum of what strikes it in kg m/s.
struct Blow {
    std::uint32_t body = 0;
    float momentum = 0;
};

/// Whether an island may fall asleep.
struct IslandActivity {
    std::uint32_t bodies = 0, active_bodies = 0;
    bool must_stay_awake = false;  ///< a body moves too fast, or may not sleep
};

/// What happened to a collider since the last step, as bits.
enum ColliderChange : std::uint8_t {
    moved_box = 1,      ///< it left its fat box
    edited = 2,         ///< the user added, moved, changed or removed it
    state_changed = 4,  ///< the motion state of its body changed; set only inside update_pair_lists()
};

/// The trees that queries between steps traverse, one for each motion state (world/detail/query_trees.hpp). The
/// structures of the broad phase are chosen for pair finding; rays need a tree. The first query builds the trees.
/// Later changes are recorded, and applied at the end of each step or by the first query after an edit, under the lock.
/// Query trees are freed after 60 steps without a query. They are no part of hash or snapshot, and no stage of the
/// simulation reads them.
struct QueryTrees {
    std::atomic<bool> ready = false;    ///< the trees are committed, and all members below are current
    std::atomic<bool> queried = false;  ///< a query ran since the last step
    std::mutex lock;
    bool built = false;  ///< the trees exist
    std::uint32_t steps_without_query = 0;
    std::array<broad::WideBvh, 3> trees;  ///< by MotionState
    /// By collider: 0 when it is in no tree, else 1 + the MotionState of its tree. The bit `is_pending` is set while
    /// the collider is in `pending`.
    std::vector<std::uint8_t> tree_of;
    static constexpr std::uint8_t is_pending = 0x80;
    std::vector<std::uint32_t> pending;  ///< colliders that were added, removed or moved, or changed their motion state

    bool bodies_moved = true;  ///< a step moved bodies since `outliers` and `awake_overhang` were computed
    /// Metres by which shapes may stick out of their boxes in the tree, on every side.
    float asleep_overhang = 0, awake_overhang = 0;
    /// The few awake colliders that stick out farthest, by index, with their current boxes. They do not count in the
    /// overhangs.
    std::vector<broad::Move> outliers;
};

struct WorldState {
    Settings settings;
    std::uint64_t steps = 0;
    double time = 0;
    float last_sub_step = 0;  ///< seconds; 0 before the first step

    IdPool<BodyTag> body_ids;
    dynamics::Bodies bodies;
    IdPool<ColliderTag> collider_ids;
    std::vector<Collider> colliders;
    std::vector<Aabb> boxes;            ///< fat boxes, by collider
    std::vector<std::uint8_t> changes;  ///< ColliderChange bits, by collider
    std::vector<SharedShape> shapes;
    std::vector<std::uint32_t> free_shapes;
    pairs::PairExclusions exclusions;

    std::vector<std::uint32_t> awake;        ///< body indices, ascending: dynamic ones and moving kinematic ones
    std::vector<std::uint32_t> awake_added;  ///< bodies added since the last step, not yet in `awake`; in any order
    Sleepers asleep;
    pairs::PairList active;   ///< pairs with at least one awake body, ascending
    pairs::PairList resting;  ///< pairs without an awake body, in no order
    std::vector<dynamics::Contact> contacts;
    std::vector<std::uint32_t> free_contacts;
    dynamics::ManifoldPool manifolds;             ///< of `contacts`
    std::vector<std::uint32_t> edited_colliders;  ///< the next step queries their pairs
    std::vector<std::uint32_t> bodies_to_wake;    ///< the next step wakes their islands before it finds pairs
    std::vector<std::uint32_t> bodies_let_go;     ///< sleepers whose contact ended: the stage "sleep" wakes them
    /// Resting contacts that the next step collides once: new ones, those of edited colliders, and those of sensors
    /// whose visitor fell asleep.
    std::vector<std::uint32_t> contacts_to_check;
    bool removed_any = false;      ///< pairs of removed colliders may be in the lists
    bool query_all_awake = false;  ///< pairs were dropped: the next step queries every awake box again

    Events events;
    StepReport report;

    // The members below are rebuilt when needed. They are no part of hash or snapshot.
    std::unique_ptr<TaskRunner> own_tasks;
    TaskRunner* tasks = nullptr;
    std::unordered_multimap<std::uint64_t, std::uint32_t> shape_of_key;  ///< by SharedShape::key
    ContactGraph contact_graph;
    dynamics::ConstraintColours colours;  ///< those that the manifolds have
    pairs::BoxSets box_sets;              ///< fat boxes of colliders by motion state; edits reach them in the next step
    std::vector<std::uint8_t>
        set_of;                ///< by collider: 0 when its box is in no set, else 1 + the MotionState of the set
    std::string structure;     ///< Setup::structure
    mutable QueryTrees query;  // mutable: the first query after a change updates it
    dynamics::Solver solver;
    dynamics::DisjointSets sets;
    pairs::PairSorter sorter;
    std::vector<float> sweep;         ///< by body: metres that a fast body may move in this step; 0 for slow bodies
    std::vector<std::uint8_t> marks;  ///< by body; all 0 between uses
    std::vector<std::uint8_t> roles;  ///< by body, inside gather_constraints(): what contacts do to it
    std::vector<std::uint8_t> held;   ///< by body, valid for awake ones: a contact acted on it in this step
    std::vector<broad::Move> query_boxes;
    std::vector<broad::Pair> candidates;
    std::vector<Aabb> previous_boxes;  ///< by collider, valid for those in `moved`: the fat box before this step
    std::vector<std::uint32_t> moved;  ///< colliders that left their fat box in this step
    std::vector<dynamics::Constraint> constraints;  ///< of this step: manifolds with points, in the order of `active`
    std::vector<dynamics::ContactResult> results;   ///< of `constraints`
    std::vector<std::uint32_t> sensors;  ///< active contacts of sensors, which are collided after the bodies moved
    std::vector<std::uint32_t> checked;  ///< resting contacts that this step collided
    std::vector<std::uint8_t> reused;    ///< by active pair: the manifold of the last step was reused
    std::vector<std::uint32_t> clamped;  ///< bodies whose speed was clamped before the step, ascending
    std::vector<std::uint32_t> scratch;
    std::vector<std::uint32_t> woken_contacts;    ///< in update_pair_lists(): those that move to the active list
    std::vector<broad::Pair> woken_pairs;         ///< their pairs
    std::vector<IslandActivity> island_activity;  ///< by island, for the stage "sleep"
    std::vector<Blow> blows;                      ///< of this step
    std::vector<std::uint32_t> kept_awake;        ///< bodies, for the stage "sleep"
    bool stepping = false;
    bool broken = false;  ///< a step ran out of memory half-way: only restore() leads on
};

/// Call when a collider is added or removed, or when its box or the motion state of its body changes. Records the
/// change for the query trees.
void mark_box_changed(const WorldState& state, std::uint32_t collider) noexcept;
/// Call when a collider is added, removed, moved or changed by the user: the next step checks its pairs. Includes
/// mark_box_changed().
void mark_edited(WorldState& state, std::uint32_t collider);

// Motion states and pair lists (world/motion_states.cpp).
/// Returns the pose of a collider's shape in world axes, with its position relative to the body's centre of mass.
[[nodiscard]] LocalPose collider_pose(const WorldState& state, const Collider& collider);
/// Returns the world pose of a collider's shape.
[[nodiscard]] Pose world_pose(const WorldState& state, const Collider& collider);
/// Returns the world box of a collider at its current pose, enlarged by the speculative distance and, when `sweep` is
/// above 0, by the path of `seconds` at the body's velocity.
[[nodiscard]] Aabb speculative_box(const WorldState& state, std::uint32_t collider, float seconds, float sweep);
/// Moves the added bodies to the list of awake ones: at the beginning of a step.
void merge_awake_added(WorldState& state);
/// Removes a body from the lists of awake bodies.
void remove_awake(WorldState& state, std::uint32_t body);
/// Change the motion state of bodies to awake or asleep, and move their boxes and pairs. `bodies` ascending.
void move_to_awake(WorldState& state, std::span<const std::uint32_t> bodies);
void move_to_asleep(WorldState& state, std::span<const std::uint32_t> bodies);
/// Updates the asleep overhang with the colliders of these bodies, which have just fallen asleep.
void measure_asleep_overhang(const WorldState& state, std::span<const std::uint32_t> bodies);
/// Moves the pairs of these bodies, whose motion state has changed, to the right list: active when one of the two
/// bodies is awake, else resting. Waking costs O(own pairs + active pairs), as does falling asleep.
void update_pair_lists(WorldState& state, std::span<const std::uint32_t> bodies);
/// Whether a body has a velocity.
[[nodiscard]] inline bool is_moving(const dynamics::BodyMotion& motion) {
    return length_squared(motion.linear_velocity) > 0 || length_squared(motion.angular_velocity) > 0;
}
/// Requests that the next step wakes the body's island before it finds pairs. Does nothing for a body that is awake or
/// quarantined. Edits call reserve_wakes() before.
void request_wake(WorldState& state, std::uint32_t body);
/// Call when something may have changed what moves a body: its rest begins anew, and it wakes. Does nothing for static
/// bodies, and for kinematic ones without velocity. Edits call reserve_wakes() before.
void disturb(WorldState& state, std::uint32_t body);
/// Wakes the islands of all bodies in `bodies_to_wake`, and what they carry. Their rest begins anew.
void wake_requested_islands(WorldState& state);
/// Wakes the sleeping bodies behind one that is struck with `momentum` (kg m/s), as far as the blow may move them.
void wake_struck(WorldState& state, std::uint32_t body, float momentum);
/// Whether the other body of a contact lies on `lower`.
[[nodiscard]] bool carries(const WorldState& state, const dynamics::Contact& contact, std::uint32_t lower);
/// Appends the dynamic bodies that lie on those of the list, and on these, and so on. `marks`: by body, 1 for those in
/// the list.
void add_carried(const WorldState& state, std::vector<std::uint32_t>& bodies, std::vector<std::uint8_t>& marks);

// Contacts and their lists (world/contacts.cpp).
/// Initialises a free contact for a pair and returns its index; the caller adds it to a list.
[[nodiscard]] std::uint32_t add_contact(WorldState& state, broad::Pair pair);
/// Frees a contact and reports the end of the touch. Removes it from the resting list, but not from the active one.
void end_contact(WorldState& state, std::uint32_t contact);
/// Sets whether two colliders touch, and reports the change. Bodies whose contact ends begin their rest
/// anew.
void set_touching(WorldState& state, dynamics::Contact& contact, bool touching);
void add_resting(WorldState& state, std::uint32_t contact);
void remove_resting(WorldState& state, std::uint32_t contact);
/// Sorts contacts by their pairs and removes duplicates.
void sort_by_pair(const WorldState& state, std::vector<std::uint32_t>& contacts);
/// Call after the pair lists were replaced.
void rebuild_contact_graph(WorldState& state);
/// Sets friction and restitution of a contact's manifolds from the materials of its colliders.
void update_materials(WorldState& state, std::uint32_t contact);
/// Lists the constraints of the active contacts, and the sensors among these. Frees the colours of manifolds that
/// ended. `quarantined`: bodies whose contacts move nothing, because they end in the next step.
void gather_constraints(WorldState& state, std::span<const std::uint32_t> quarantined = {});
/// Takes the colours of all manifolds after a restore. Returns false when they contradict each other.
[[nodiscard]] bool rebuild_colours(WorldState& state);

/// Brings the boxes of all colliders that were edited since the last step into the sets. The first act of a step.
void apply_edits(WorldState& state);

/// One side of a contact.
struct ContactSide {
    std::uint32_t collider;
    std::uint16_t generation;
    std::uint32_t body;
};
[[nodiscard]] inline std::array<ContactSide, 2> sides_of(const dynamics::Contact& c) {
    return {{{c.collider_a, c.generation_a, c.body_a}, {c.collider_b, c.generation_b, c.body_b}}};
}
/// Whether a collider was not removed since `generation` was read; its slot may have a new owner by now.
[[nodiscard]] inline bool is_current(const WorldState& state, std::uint32_t collider, std::uint16_t generation) {
    return state.collider_ids.alive_at(collider) && state.collider_ids.slots()[collider].generation == generation;
}

/// Calls f(contact, other) for each dynamic body that touches a body, in unspecified order, once a contact. Leaves out
/// contacts of removed colliders, which the next step ends.
template <class F> void for_each_touched(const WorldState& state, std::uint32_t body, const F& f) {
    for (std::uint32_t c = state.bodies.traits[body].first_collider; c != no_index; c = state.colliders[c].next)
        state.contact_graph.for_each_of(c, [&](std::uint32_t index) {
            const dynamics::Contact& contact = state.contacts[index];
            if (!contact.touching || contact.sensor) return;
            const auto [a, b] = sides_of(contact);
            if (!is_current(state, a.collider, a.generation) || !is_current(state, b.collider, b.generation)) return;
            const std::uint32_t other = a.body == body ? b.body : a.body;
            if (state.bodies.traits[other].kind == BodyKind::Dynamic) f(contact, other);
        });
}

// Pairs of colliders that rest (world/resting_pairs.cpp).
/// Disturbs the bodies that touch a collider that was removed, moved or changed.
void disturb_around_edits(WorldState& state);
/// Whether two colliders may make a contact: by kinds, sensors, filters and exclusions.
[[nodiscard]] bool may_make_contact(const WorldState& state, broad::Pair pair);
/// Whether a pair of a list ends: its boxes parted, or a collider was removed or changed. Reads two bytes of pairs that
/// did not change.
[[nodiscard]] bool has_ended(const WorldState& state, broad::Pair pair, std::uint32_t contact);
/// Ends the resting pairs of edited colliders whose boxes parted, adds those of `found` that are not in the list, and
/// has all of them collided in this step. `found`: ascending, none twice. O(pairs of edited colliders).
void update_resting(WorldState& state, std::span<const broad::Pair> found);

// The stages of a step, in order. Tests can call each alone.
void refresh_boxes(WorldState& state, float seconds);
void track_pairs(WorldState& state);
void collide(WorldState& state, float seconds);
void find_islands(WorldState& state, float seconds);
void solve(WorldState& state, float seconds);
void finish(WorldState& state, float seconds);
/// Collides sensors where the bodies are after they moved, so that events tell the end of the step.
void collide_sensors(WorldState& state);
void publish_events(WorldState& state);
void fall_asleep(WorldState& state, float seconds);
/// Updates the query trees when they exist, and frees them when they are unused.
void update_query_trees(WorldState& state);

/// Runs one step: world/step.cpp.
void step(WorldState& state, float seconds);

}  // namespace fase
