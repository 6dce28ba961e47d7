/// One step, on one screen.
#include <chrono>

#include "fase/core/detail/float_mode.hpp"
#include "fase/world/detail/state.hpp"

namespace fase {
namespace {

/// Runs a stage and notes its time under its name.
template <class F> void timed(WorldState& state, Stage stage, const F& work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    const std::chrono::duration<double, std::milli> taken = std::chrono::steady_clock::now() - begin;
    state.report.ms[static_cast<std::size_t>(stage)] += taken.count();
    state.report.total_ms += taken.count();
}

std::uint64_t bytes_held(const WorldState& s) {
    const auto of = [](const auto& v) { return v.capacity() * sizeof(v[0]); };
    std::uint64_t trees = of(s.query.tree_of) + of(s.query.pending);
    for (const broad::WideBvh& tree : s.query.trees) trees += tree.bytes();
    return trees + of(s.bodies.traits) + of(s.bodies.motion) + of(s.bodies.forces) + of(s.colliders) + of(s.boxes) +
           of(s.contacts) + s.manifolds.bytes() + s.colours.bytes() + of(s.constraints) + of(s.results) +
           s.active.bytes() + s.resting.bytes() + of(s.candidates) + of(s.query_boxes) + of(s.previous_boxes) +
           s.contact_graph.bytes() + s.box_sets.bytes() + s.asleep.bytes() + s.solver.bytes();
}

}  // namespace

void step(WorldState& state, float seconds) {
    const StandardFloats floats;
    state.report = {};
    state.events.clear();
    state.query.bodies_moved = true;
    state.query.ready.store(false, std::memory_order_relaxed);

    timed(state, Stage::Refresh, [&] {
        apply_edits(state);
        refresh_boxes(state, seconds);
    });
    timed(state, Stage::Pairs, [&] { track_pairs(state); });
    timed(state, Stage::Collide, [&] { collide(state, seconds); });
    timed(state, Stage::Islands, [&] { find_islands(state, seconds); });
    if (seconds > 0) {
        timed(state, Stage::Solve, [&] { solve(state, seconds); });
        timed(state, Stage::Finish, [&] { finish(state, seconds); });
    }
    timed(state, Stage::Events, [&] {
        collide_sensors(state);
        publish_events(state);
    });
    if (seconds > 0) timed(state, Stage::Sleep, [&] { fall_asleep(state, seconds); });
    timed(state, Stage::Queries, [&] { update_query_trees(state); });

    ++state.steps;
    state.time += static_cast<double>(seconds);
    state.report.step = state.steps;
    state.report.bodies = state.body_ids.count();
    state.report.awake = static_cast<std::uint32_t>(state.awake.size());
    state.report.asleep = static_cast<std::uint32_t>(state.asleep.bodies.size());
    state.report.pairs = static_cast<std::uint32_t>(state.active.size());
    const broad::StructureChoice choice = state.box_sets.chosen(MotionState::Awake);
    state.report.structure = choice.structure;
    state.report.reason = choice.reason;
    state.report.bytes = bytes_held(state);
}

}  // namespace fase
