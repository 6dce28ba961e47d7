#pragma once
/// The stages of a step, in order. A signature names the tables that a stage reads (const), then those that it writes,
/// so a test makes only these.
#include <span>

#include "fase/core/tasks.hpp"
#include "fase/dynamics/solver/solver.hpp"
#include "fase/world/detail/motion_states.hpp"
#include "fase/world/detail/step_lists.hpp"
#include "fase/world/detail/tables.hpp"
#include "fase/world/settings.hpp"
#include "fase/world/stats.hpp"

namespace fase {

/// What a step is given, and the report to which each stage adds.
struct StepContext {
    const Settings& settings;
    float seconds;        ///< 0: pairs and events only
    float last_sub_step;  ///< WorldClock::last_sub_step
    TaskRunner& tasks;
    StepReport& report;
};

// refresh
/// Brings the boxes of all colliders that were edited since the last step into the sets.
void apply_edits(const BodyTable& bodies, const ColliderTable& colliders, BroadPhase& broad_phase);
/// Clamps the speeds of awake bodies and updates their fat boxes.
void refresh_boxes(const StepContext& context, const ColliderTable& colliders, BodyTable& bodies,
                   BroadPhase& broad_phase, QueryTrees& query, Moved& moved);

// pairs
/// Finds pairs whose fat boxes began to overlap, and ends those whose boxes parted. Adds to Moved::colliders when all
/// awake boxes are queried.
void track_pairs(const StepContext& context, const MotionStates& state, Moved& moved);
/// Disturbs the bodies that touch a collider that was removed, moved or changed: a part of track_pairs().
void disturb_around_edits(const Settings& settings, BodyTable& bodies, const ColliderTable& colliders,
                          const BroadPhase& broad_phase, const ContactTable& contacts);
/// Ends the resting pairs of edited colliders whose boxes parted, adds those of `found` that are not in the list, and
/// has all of them collided in this step: a part of track_pairs(). `found`: ascending, none twice. O(pairs of edited
/// colliders).
void update_resting(const MotionStates& state, std::span<const broad::Pair> found);

// collide
/// Updates the manifolds of active contacts, and lists the constraints.
void collide(const StepContext& context, const BodyTable& bodies, const ColliderTable& colliders, const Moved& moved,
             ContactTable& contacts, Constraints& constraints);

// islands
/// Wakes what is touched or struck.
void wake_touched(const StepContext& context, const MotionStates& state, Constraints& constraints, IslandLists& lists);
/// Unites awake bodies that touch: sets BodyMotion::island.
void find_islands(const StepContext& context, const Constraints& constraints, BodyTable& bodies, IslandLists& lists);

// solve, finish
/// Quarantines bodies whose forces would make their velocity infinite, before the solver spreads it to their
/// neighbours.
void quarantine_invalid_forces(const StepContext& context, const MotionStates& state, Constraints& constraints);
/// Runs the solver: manifolds and results get their impulses; the bodies do not move yet.
void solve(const StepContext& context, const BodyTable& bodies, const Moved& moved, ContactTable& contacts,
           Constraints& constraints, IslandLists& islands, dynamics::Solver& solver);
/// Gives the awake bodies the motion that the solver computed. Quarantines those for which it is invalid.
void finish(const StepContext& context, const dynamics::Solver& solver, const Constraints& constraints,
            const MotionStates& state);

/// Keeps the middles of shapes from crossing shapes of static and kinematic bodies: what contacts missed, because a
/// body rotated fast or was pushed. note_middles() is a part of collide(); `seconds`: of the step.
void hold_middles(const StepContext& context, const ColliderTable& colliders, const ContactTable& contacts,
                  const Constraints& constraints, BodyTable& bodies);
void note_middles(float seconds, const BodyTable& bodies, const ColliderTable& colliders, const Moved& moved,
                  const ContactTable& contacts, Constraints& constraints);

// events
/// Collides sensors where the bodies are after they moved, so that events tell the end of the step.
void collide_sensors(const StepContext& context, const BodyTable& bodies, const ColliderTable& colliders,
                     const Moved& moved, const Constraints& constraints, ContactTable& contacts);
/// Reports contacts, sensors and hits. Restarts the rest of bodies whose contact ended.
void publish_events(const Settings& settings, const ColliderTable& colliders, const Constraints& constraints,
                    BodyTable& bodies, ContactTable& contacts, Events& events);

// sleep
/// Puts to sleep what has been at rest for long enough, and wakes what lies next to what moves.
void fall_asleep(const StepContext& context, const Constraints& constraints, const MotionStates& state,
                 SleepLists& lists);

// queries
/// Updates the query trees when they exist, and frees them when they are unused.
void update_query_trees(const BodyTable& bodies, const ColliderTable& colliders, const BroadPhase& broad_phase,
                        QueryTrees& query);

}  // namespace fase
