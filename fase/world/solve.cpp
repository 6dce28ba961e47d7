/// Stages "solve" and "finish": runs the solver on the awake bodies, then stores their new motion.
#include <algorithm>

#include "fase/world/check_values.hpp"
#include "fase/world/detail/state.hpp"

namespace fase {

using dynamics::BodyMotion;
using dynamics::BodyTraits;

namespace {

dynamics::SolverSettings solver_settings(const WorldState& state, float seconds) {
    const Settings& settings = state.settings;
    const float sub_step = seconds / static_cast<float>(settings.sub_steps);
    return {settings.gravity,           seconds,
            settings.sub_steps,         state.last_sub_step > 0 ? sub_step / state.last_sub_step : 1,
            settings.contact_frequency, settings.contact_damping_ratio,
            settings.push_out_speed,    settings.restitution_threshold,
            settings.linear_slop,       {settings.max_linear_speed, settings.max_angular_speed}};
}

bool is_valid(const BodyMotion& motion) {
    return is_finite(motion.linear_velocity) && is_finite(motion.angular_velocity) && is_finite(motion.rotation) &&
           is_in_world(motion.position);
}

/// Stops a body at its last valid pose and excludes it from the simulation.
void quarantine(WorldState& state, std::uint32_t body) {
    state.bodies.traits[body].quarantined = true;
    state.bodies.motion[body].linear_velocity = {};
    state.bodies.motion[body].angular_velocity = {};
    state.bodies.motion[body].island = body;
    for (std::uint32_t c = state.bodies.traits[body].first_collider; c != no_index; c = state.colliders[c].next) {
        mark_edited(state, c);  // its pairs end in the next step
    }
    ++state.report.quarantined;
}

/// Quarantines bodies whose forces would make their velocity infinite, before the solver spreads it to their
/// neighbours.
void quarantine_invalid_forces(WorldState& state, float seconds) {
    std::vector<std::uint32_t> invalid;
    for (const std::uint32_t body : state.awake) {
        const BodyTraits& traits = state.bodies.traits[body];
        const dynamics::BodyForces& forces = state.bodies.forces[body];
        const BodyMotion& motion = state.bodies.motion[body];
        const Vec3 next = motion.linear_velocity + forces.force * (traits.inverse_mass * seconds);
        const float max_inverse_moment =
            std::max({traits.inverse_moments.x, traits.inverse_moments.y, traits.inverse_moments.z});
        const Vec3 spin = motion.angular_velocity + forces.torque * (max_inverse_moment * seconds);
        if (!std::isfinite(length_squared(next)) || !std::isfinite(length_squared(spin))) invalid.push_back(body);
    }
    if (invalid.empty()) return;
    for (const std::uint32_t body : invalid) {
        state.bodies.forces[body] = {};
        quarantine(state, body);
    }
    move_to_asleep(state, invalid);
    gather_constraints(state, invalid);
}

}  // namespace

void solve(WorldState& state, float seconds) {
    quarantine_invalid_forces(state, seconds);
    const dynamics::SolverSettings settings = solver_settings(state, seconds);
    state.solver.load_bodies(state.bodies, state.awake, settings, *state.tasks);
    state.solver.load_constraints({state.constraints, state.results}, state.colours, state.manifolds, state.bodies,
                                  settings, *state.tasks);
    state.solver.run(settings, *state.tasks);
    state.solver.store_constraints(state.constraints, state.manifolds, state.results, state.bodies, settings,
                                   *state.tasks);
    state.last_sub_step = seconds / static_cast<float>(state.settings.sub_steps);
    const dynamics::SolverCounts counts = state.solver.counts();
    state.report.colours = counts.colours;
    state.report.overflow = counts.overflow;
    state.report.speed_clamped = counts.clamped;
    for (std::size_t i = 0; !state.clamped.empty() && i < state.awake.size(); ++i)
        if (!state.solver.motion(i).clamped &&
            std::binary_search(state.clamped.begin(), state.clamped.end(), state.awake[i]))
            ++state.report.speed_clamped;
}

namespace {

/// Marks the bodies on which a contact acted in this step.
void mark_held(WorldState& state) {
    state.held.resize(state.bodies.traits.size());
    for (const std::uint32_t body : state.awake) state.held[body] = 0;
    for (std::size_t i = 0; i < state.constraints.size(); ++i)
        if (state.results[i].pushes)
            state.held[state.constraints[i].body_a] = state.held[state.constraints[i].body_b] = 1;
}

/// Whether gravity alone acts on a body: it is slow only because it has just begun to fall.
bool falls(const WorldState& state, std::uint32_t body) {
    const BodyTraits& traits = state.bodies.traits[body];
    const Vec3 gravity = state.settings.gravity * (traits.inverse_mass > 0 ? traits.gravity_scale : 0);
    const Vec3 free{traits.locks & 1 ? 0 : gravity.x, traits.locks & 2 ? 0 : gravity.y,
                    traits.locks & 4 ? 0 : gravity.z};
    return state.held[body] == 0 && length_squared(free) > 0;
}

}  // namespace

void finish(WorldState& state, float seconds) {
    mark_held(state);
    const float linear = state.settings.sleep_linear_speed, angular = state.settings.sleep_angular_speed;
    const float distance = state.settings.sleep_distance;
    state.reused.assign(state.awake.size(), 0);  // reused as flags of bodies with invalid motion
    parallel_ranges(*state.tasks, state.awake.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t body = state.awake[i];
            const BodyTraits& traits = state.bodies.traits[body];
            const dynamics::SolverBody& row = state.solver.body(i);
            BodyMotion next = state.bodies.motion[body];
            next.position += Vec3d{row.moved[0], row.moved[1], row.moved[2]};
            const Quat turned = state.solver.motion(i).turned;
            if (!(turned == Quat{})) next.rotation = normalized(turned * next.rotation);
            next.linear_velocity = {row.velocity[0], row.velocity[1], row.velocity[2]};
            next.angular_velocity = {row.spin[0], row.spin[1], row.spin[2]};
            state.bodies.forces[body] = {};
            if (!is_valid(next)) {
                const bool left = is_finite(next.position) && is_finite(next.linear_velocity) &&
                                  is_finite(next.angular_velocity) && is_finite(next.rotation);
                state.reused[i] = left ? 2 : 1;
                continue;
            }
            next.drift += Vec3{row.moved[0], row.moved[1], row.moved[2]};
            // Use the actual displacement, not the velocity: push-out moves bodies without changing their velocity.
            next.turn += turned.vector() * 2.0f;
            // A slow, steady motion is not rest; vibration about one place is.
            const bool stays = length(next.drift) + traits.reach * length(next.turn) < distance;
            const bool slow = length_squared(next.linear_velocity) < linear * linear &&
                              length_squared(next.angular_velocity) < angular * angular;
            const bool rests = traits.kind == BodyKind::Dynamic
                                   ? slow && stays && traits.can_sleep && !falls(state, body)
                                   : !is_moving(next);
            next.sleep_time = rests ? next.sleep_time + seconds : 0;
            // The net motion is measured within each span of time_to_sleep, not since the body came to rest.
            const float span = state.settings.time_to_sleep;
            const bool spans_end =
                span > 0 && std::floor(next.sleep_time / span) > std::floor((next.sleep_time - seconds) / span);
            if (!rests || spans_end) next.drift = next.turn = {};
            state.bodies.motion[body] = next;
        }
    });
    std::vector<std::uint32_t> invalid;
    for (std::size_t i = 0; i < state.awake.size(); ++i)
        if (state.reused[i] != 0) {
            invalid.push_back(state.awake[i]);
            state.report.left_world += state.reused[i] == 2 ? 1 : 0;
        }
    for (const std::uint32_t body : invalid) quarantine(state, body);
    move_to_asleep(state, invalid);
}

}  // namespace fase
