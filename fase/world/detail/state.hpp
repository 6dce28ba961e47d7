#pragma once
/// Everything a world holds, as flat arrays, and the stages of its step.
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <unordered_map>
#include <vector>

#include "fase/broad/any_structure.hpp"
#include "fase/broad/wide_bvh.hpp"
#include "fase/core/ids.hpp"
#include "fase/core/tasks.hpp"
#include "fase/dynamics/solver/bodies.hpp"
#include "fase/dynamics/solver/contact.hpp"
#include "fase/dynamics/solver/islands.hpp"
#include "fase/dynamics/solver/solver.hpp"
#include "fase/pairs/detail/sort_pairs.hpp"
#include "fase/pairs/filter.hpp"
#include "fase/world/body.hpp"
#include "fase/world/detail/sleepers.hpp"
#include "fase/world/events.hpp"
#include "fase/world/settings.hpp"
#include "fase/world/stats.hpp"

namespace fase {

/// One shape on a body, as the step reads it.
struct Collider {
    std::uint32_t body = no_index;
    std::uint32_t next = no_index;  ///< the body's next collider
    std::uint32_t shape = 0;        ///< index of WorldState::shapes
    bool sensor = false;
    bool unused[3] = {};
    LocalPose in_principal;  ///< of the shape in the frame of centre of mass and principal axes
    LocalPose in_body;
    Material material;
    float density = 0;
    std::uint16_t unused_tail[2] = {};
    pairs::CollisionFilter filter;
    std::uint64_t user = 0;
};

/// A shape shared by all colliders that have an equal one.
struct SharedShape {
    Shape shape;
    std::uint32_t users = 0;
    float outer_radius = 0, inner_radius = 0;
    std::uint64_t key = 0;  ///< hash of the content
};

/// Pairs of colliders whose grown boxes overlap, sorted, each with the index of its contact.
struct PairList {
    std::vector<broad::Pair> pairs;
    std::vector<std::uint32_t> contacts;
    [[nodiscard]] std::size_t size() const { return pairs.size(); }
    void clear() {
        pairs.clear();
        contacts.clear();
    }
    void add(broad::Pair pair, std::uint32_t contact) {
        pairs.push_back(pair);
        contacts.push_back(contact);
    }
};

/// How an island rests.
struct IslandRest {
    std::uint32_t bodies = 0, restless = 0;
    bool forbidden = false;  ///< somebody moves too fast, or may not sleep
};

/// What happened to a collider's box since the last step.
enum ColliderChange : std::uint8_t {
    moved_box = 1,  ///< it left its grown box
    edited = 2,     ///< the user made, moved, changed or removed it
    crossed = 4,    ///< its body is on the way between awake and asleep; set within sort_out_pairs() alone
};

/// The trees that queries between steps go through, and what they know of the boxes beyond the boxes
/// (world/detail/query_trees.hpp). The sets of the broad phase are made for finding pairs; rays want a tree. The trees
/// stand from the first query on: what changes is noted, and taken over at the end of each step, or by the first query
/// after an edit, under the lock. A world that nobody asks for long lets go of them. No part of hash or snapshot, and
/// no stage that moves anything reads it.
struct QueryTrees {
    std::atomic<bool> ready = false;  ///< the trees are committed, and all that follows is current
    std::atomic<bool> asked = false;  ///< since the last step
    std::mutex lock;
    bool kept = false;  ///< the trees stand
    std::uint32_t steps_unasked = 0;
    std::array<broad::WideBvh, 3> trees;  ///< by MotionState
    /// By collider: 0, or 1 + the population in whose tree its box stands; `is_noted` while it is in `noted`.
    std::vector<std::uint8_t> place;
    static constexpr std::uint8_t is_noted = 0x80;
    std::vector<std::uint32_t> noted;  ///< colliders that came, went, moved or changed their population

    bool bodies_moved = true;  ///< a step moved bodies since `strays` and `awake_overhang` were found
    /// Metres by which shapes may stick out of the boxes that stand for them in the tree, on every side.
    float asleep_overhang = 0, awake_overhang = 0;
    /// The few awake colliders that stick out farthest, by index, with their boxes as they are: they count in no
    /// overhang.
    std::vector<broad::Move> outliers;
};

struct WorldState {
    Settings settings;
    std::uint64_t steps = 0;
    double time = 0;

    IdPool<BodyTag> body_ids;
    dynamics::Bodies bodies;
    IdPool<ColliderTag> collider_ids;
    std::vector<Collider> colliders;
    std::vector<Aabb> boxes;            ///< grown, by collider
    std::vector<std::uint8_t> changes;  ///< ColliderChange bits, by collider
    std::vector<SharedShape> shapes;
    std::vector<std::uint32_t> free_shapes;
    pairs::PairExclusions exclusions;

    std::vector<std::uint32_t> awake;  ///< body indices, ascending: dynamic ones and moving kinematic ones
    Sleepers asleep;
    PairList active;   ///< an awake body in each
    PairList resting;  ///< none
    std::vector<dynamics::Contact> contacts;
    std::vector<std::uint32_t> free_contacts;
    std::vector<std::uint32_t> edited_colliders;  ///< to ask for pairs in the next step
    std::vector<std::uint32_t> wake_wanted;       ///< bodies to wake before the next pairs
    bool removed_any = false;                     ///< pairs of removed colliders may be in the lists
    bool ask_all = false;                         ///< pairs were dropped: every awake box asks again

    Events events;
    StepReport report;

    // What follows is made anew when needed: no part of hash or snapshot.
    std::unique_ptr<TaskRunner> own_tasks;
    TaskRunner* tasks = nullptr;
    std::unordered_multimap<std::uint64_t, std::uint32_t> shape_of_key;  ///< by SharedShape::key
    broad::AnyStructure static_boxes, asleep_boxes, awake_boxes;
    bool picks_structures = false;  ///< each set stands in the structure that suits it
    mutable QueryTrees query;       // mutable: the first query after a change brings it up to date
    dynamics::Solver solver;
    dynamics::DisjointSets sets;
    pairs::PairSorter sorter;
    std::vector<float> sweep;  ///< by body: metres a fast body may move in this step, else 0
    std::vector<broad::Move> query_boxes;
    std::vector<broad::Pair> candidates;
    std::vector<Aabb> previous_boxes;     ///< by collider: of those in `moved`, the box before this step
    PairList spare_list;                  ///< what a pair list grows into
    std::vector<std::uint32_t> moved;     ///< colliders whose box left its grown box in this step
    std::vector<std::uint32_t> touching;  ///< contacts to solve in this step
    std::vector<std::uint8_t> reused;     ///< by active pair: the manifold was kept
    std::vector<std::uint32_t> scratch;
    std::vector<IslandRest> island_rest;  ///< by island, for the stage "sleep"
    bool stepping = false;
};

/// The broad-phase set in which a population's boxes stand, to be changed.
[[nodiscard]] broad::AnyStructure& boxes_of(WorldState& state, MotionState motion_state);
/// To be told whenever a collider comes, goes, gets another box or its body another population: for the queries' trees.
void note_box(const WorldState& state, std::uint32_t collider);
/// To be told whenever the user made, moved, changed or removed a collider: its pairs are looked at in the next step.
/// Notes its box, too.
void note_edit(WorldState& state, std::uint32_t collider);

// Lists and populations (world/populations.cpp).
/// The pose of a collider's shape: rotation in the world, and its place relative to the body's centre of mass.
[[nodiscard]] LocalPose collider_pose(const WorldState& state, const Collider& collider);
/// The place of a collider's shape in the world.
[[nodiscard]] Pose world_pose(const WorldState& state, const Collider& collider);
/// World box of a collider as it stands, grown by the speculative distance and by `sweep` along the body's velocity.
[[nodiscard]] Aabb reaching_box(const WorldState& state, std::uint32_t collider, float seconds, float sweep);
/// Puts bodies from asleep to awake or back, with their boxes and pairs. `bodies` ascending.
void move_to_awake(WorldState& state, std::span<const std::uint32_t> bodies);
void move_to_asleep(WorldState& state, std::span<const std::uint32_t> bodies);
/// Notes how far the colliders of these bodies, which have just come to the asleep set, stick out of their boxes there.
void note_sleepers(const WorldState& state, std::span<const std::uint32_t> bodies);
/// The pairs of these bodies, whose population is another now, go to the list where they belong: active when a body of
/// theirs is awake. Costs a glance at each pair.
void sort_out_pairs(WorldState& state, std::span<const std::uint32_t> bodies);
/// Asks that the body's island be awake before pairs are sought in the next step.
void want_awake(WorldState& state, std::uint32_t body);
/// Wakes the islands of all wanted bodies.
void wake_wanted_islands(WorldState& state);
/// A free contact for a pair.
[[nodiscard]] std::uint32_t add_contact(WorldState& state, broad::Pair pair);

/// Friction and restitution of a contact from the materials of its colliders.
void renew_materials(WorldState& state, std::uint32_t contact);

// The stages of a step, in order; each can be called alone by a test.
void refresh_boxes(WorldState& state, float seconds);
void track_pairs(WorldState& state);
void collide(WorldState& state, float seconds);
void find_islands(WorldState& state, float seconds);
void solve(WorldState& state, float seconds);
void finish(WorldState& state, float seconds);
void publish_events(WorldState& state);
void fall_asleep(WorldState& state, float seconds);
/// Brings the trees of queries up to date, where anybody asks.
void update_query_trees(WorldState& state);

/// One whole step: world/step.cpp.
void step(WorldState& state, float seconds);

}  // namespace fase
