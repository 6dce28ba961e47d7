#pragma once
/// The state of a world: its tables, and what the stages of its step hand to each other.
#include <memory>

#include "fase/core/tasks.hpp"
#include "fase/dynamics/solver/solver.hpp"
#include "fase/world/detail/query_trees.hpp"
#include "fase/world/detail/step_lists.hpp"
#include "fase/world/detail/tables.hpp"
#include "fase/world/events.hpp"
#include "fase/world/settings.hpp"
#include "fase/world/stats.hpp"

namespace fase {

/// The newest generation of each slot that a world issued under a number that it no longer has.
struct IssuedIds {
    std::uint16_t number = 0;
    std::vector<std::uint16_t> bodies, colliders;
};

/// All of a world. Edits, snapshots and queries take it whole; a stage of the step takes the tables that it reads and
/// writes (world/detail/stages.hpp).
struct WorldState {
    // Hashed and saved, except for what a table remakes. The one list of it is describe() in world/snapshot.cpp.
    Settings settings;
    WorldClock clock;
    BodyTable bodies;
    ColliderTable colliders;
    BroadPhase broad_phase;
    ContactTable contacts;

    // What the last step tells the user.
    Events events;
    StepReport report;

    std::vector<BodyId> moved_bodies;  ///< that the last step moved, by index

    // Remade.
    Moved moved;
    Constraints constraints;
    IslandLists islands;
    SleepLists sleep;
    dynamics::Solver solver;
    mutable QueryTrees query;  // mutable: the first query after a change updates it
    std::unique_ptr<TaskRunner> own_tasks;
    TaskRunner* tasks = nullptr;
    std::vector<IssuedIds> issued;  ///< before a snapshot of another world was restored; a number occurs once
    bool stepping = false;
    bool broken = false;  ///< a step ran out of memory half-way: only restore() leads on
};

/// Runs one step: world/step.cpp.
void step(WorldState& state, float seconds);

}  // namespace fase
