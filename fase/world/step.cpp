/// One step, on one screen.
#include <chrono>

#include "fase/core/detail/float_mode.hpp"
#include "fase/world/detail/stages.hpp"
#include "fase/world/detail/state.hpp"

namespace fase {
namespace {

/// Runs a stage and notes its time under its name.
template <class F> void timed(StepReport& report, Stage stage, const F& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
    report.ms[static_cast<std::size_t>(stage)] += taken.count();
    report.total_ms += taken.count();
}

std::uint64_t bytes_held(const WorldState& s) {
    const auto of = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
    std::uint64_t trees = of(s.query.tree_of) + of(s.query.pending);
    for (const broad::WideBvh& tree : s.query.trees) trees += tree.bytes();
    return trees + of(s.bodies.traits) + of(s.bodies.motion) + of(s.bodies.forces) + of(s.colliders.all) +
           of(s.broad_phase.boxes) + of(s.contacts.all) + s.contacts.manifolds.bytes() + s.contacts.colours.bytes() +
           of(s.constraints.all) + of(s.constraints.results) + s.contacts.active.bytes() + s.contacts.resting.bytes() +
           of(s.broad_phase.candidates) + of(s.broad_phase.query_boxes) + of(s.moved.previous_boxes) +
           s.contacts.graph.bytes() + s.broad_phase.sets.bytes() + s.bodies.asleep.bytes() + s.solver.bytes();
}

/// Completes the report by the counts at the end of the step.
void complete_report(const WorldState& state, StepReport& report) {
    report.step = state.clock.steps;
    report.bodies = state.bodies.ids.count();
    report.awake = static_cast<std::uint32_t>(state.bodies.awake.size());
    report.asleep = static_cast<std::uint32_t>(state.bodies.asleep.bodies.size());
    report.pairs = static_cast<std::uint32_t>(state.contacts.active.size());
    const broad::StructureChoice choice = state.broad_phase.sets.chosen(MotionState::Awake);
    report.structure = choice.structure;
    report.reason = choice.reason;
    report.bytes = bytes_held(state);
}

/// Lists the bodies that a step moved.
void list_moved(const BodyTable& bodies, std::vector<BodyId>& moved) {
    for (const std::uint32_t body : bodies.awake) moved.push_back(*bodies.ids.id_at(body));
}

void advance(WorldClock& clock, const Settings& settings, float seconds) {
    ++clock.steps;
    clock.time += static_cast<double>(seconds);
    if (seconds > 0) clock.last_sub_step = seconds / static_cast<float>(settings.sub_steps);
}

}  // namespace

void step(WorldState& state, float seconds) {
    const StandardFloats floats;
    const Settings& settings = state.settings;
    const ColliderTable& colliders = state.colliders;
    BodyTable& bodies = state.bodies;
    BroadPhase& broad_phase = state.broad_phase;
    ContactTable& contacts = state.contacts;
    QueryTrees& query = state.query;
    Moved& moved = state.moved;
    Constraints& constraints = state.constraints;
    StepReport& report = state.report;
    const StepContext context{settings, seconds, state.clock.last_sub_step, *state.tasks, report};
    const MotionStates motion_states{bodies, colliders, broad_phase, contacts, query, state.events};

    report = {};
    state.events.clear();
    state.moved_bodies.clear();
    begin_step(query);
    timed(report, Stage::Refresh, [&] {
        apply_edits(bodies, colliders, broad_phase);
        merge_awake_added(bodies);
        wake_requested_islands(motion_states, settings);
        refresh_boxes(context, colliders, bodies, broad_phase, query, moved);
    });
    timed(report, Stage::Pairs, [&] { track_pairs(context, motion_states, moved); });
    timed(report, Stage::Collide, [&] { collide(context, bodies, colliders, moved, contacts, constraints); });
    timed(report, Stage::Islands, [&] {
        wake_touched(context, motion_states, constraints, state.islands);
        find_islands(context, constraints, bodies, state.islands);
    });
    if (seconds > 0) {
        timed(report, Stage::Solve, [&] {
            quarantine_invalid_forces(context, motion_states, constraints);
            solve(context, bodies, moved, contacts, constraints, state.islands, state.solver);
        });
        timed(report, Stage::Finish, [&] {
            finish(context, state.solver, constraints, motion_states);
            hold_middles(context, colliders, contacts, constraints, bodies);
        });
        list_moved(bodies, state.moved_bodies);
    }
    timed(report, Stage::Events, [&] {
        collide_sensors(context, bodies, colliders, moved, constraints, contacts);
        publish_events(settings, colliders, constraints, bodies, contacts, state.events);
    });
    if (seconds > 0)
        timed(report, Stage::Sleep, [&] { fall_asleep(context, constraints, motion_states, state.sleep); });
    timed(report, Stage::Queries, [&] { update_query_trees(bodies, colliders, broad_phase, query); });
    advance(state.clock, settings, seconds);
    complete_report(state, report);
}

}  // namespace fase
