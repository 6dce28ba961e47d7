/// Stages "solve" and "finish": runs the solver on the awake bodies, then stores their new motion.
#include <algorithm>

#include "fase/world/check_values.hpp"
#include "fase/world/detail/stages.hpp"

namespace fase {

using dynamics::BodyMotion;
using dynamics::BodyTraits;

namespace {

dynamics::SolverSettings solver_settings(const StepContext& context) {
    const Settings& settings = context.settings;
    const float sub_step = context.seconds / static_cast<float>(settings.sub_steps);
    return {settings.gravity,           context.seconds,
            settings.sub_steps,         context.last_sub_step > 0 ? sub_step / context.last_sub_step : 1,
            settings.contact_frequency, settings.contact_damping_ratio,
            settings.push_out_speed,    settings.restitution_threshold,
            settings.linear_slop,       {settings.max_linear_speed, settings.max_angular_speed}};
}

bool is_valid(const BodyMotion& motion) {
    return is_finite(motion.linear_velocity) && is_finite(motion.angular_velocity) && is_finite(motion.rotation) &&
           is_in_world(motion.position);
}

/// Stops a body at its last valid pose and excludes it from the simulation.
void quarantine(const StepContext& context, const MotionStates& state, std::uint32_t body) {
    state.bodies.traits[body].quarantined = true;
    state.bodies.motion[body].linear_velocity = {};
    state.bodies.motion[body].angular_velocity = {};
    state.bodies.motion[body].island = body;
    for (std::uint32_t c = state.bodies.traits[body].first_collider; c != no_index; c = state.colliders[c].next) {
        mark_edited(state.broad_phase, state.query, c);  // its pairs end in the next step
    }
    ++context.report.quarantined;
}

}  // namespace

void quarantine_invalid_forces(const StepContext& context, const MotionStates& state, Constraints& constraints) {
    const float seconds = context.seconds;
    std::vector<std::uint32_t> invalid;
    for (const std::uint32_t body : state.bodies.awake) {
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
        quarantine(context, state, body);
    }
    move_to_asleep(state, invalid);
    gather_constraints(state.bodies, context.settings.linear_slop, state.contacts, constraints, invalid);
}

void solve(const StepContext& context, const BodyTable& bodies, const Moved& moved, ContactTable& contacts,
           Constraints& constraints, IslandLists& islands, dynamics::Solver& solver) {
    solver.solve({bodies, bodies.awake, constraints.all, constraints.results, islands.sets, contacts.colours,
                  contacts.manifolds, solver_settings(context), context.tasks});
    const dynamics::SolverCounts counts = solver.counts();
    context.report.colours = counts.colours;
    context.report.overflow = counts.overflow;
    context.report.speed_clamped = counts.clamped;
    for (const std::uint32_t body : moved.clamped)
        if (std::binary_search(bodies.awake.begin(), bodies.awake.end(), body) && !solver.motion(body).clamped)
            ++context.report.speed_clamped;
}

namespace {

/// Marks the bodies on which a contact acted in this step.
void mark_held(const Constraints& constraints, BodyTable& bodies) {
    bodies.held.resize(bodies.traits.size());
    for (const std::uint32_t body : bodies.awake) bodies.held[body] = 0;
    for (std::size_t i = 0; i < constraints.all.size(); ++i)
        if (constraints.results[i].pushes)
            bodies.held[constraints.all[i].body_a] = bodies.held[constraints.all[i].body_b] = 1;
}

/// Whether gravity alone acts on a body: it is slow only because it has just begun to fall.
bool falls(const BodyTable& bodies, Vec3 world_gravity, std::uint32_t body) {
    const BodyTraits& traits = bodies.traits[body];
    const Vec3 gravity = world_gravity * (traits.inverse_mass > 0 ? traits.gravity_scale : 0);
    const Vec3 free{traits.locks & 1 ? 0 : gravity.x, traits.locks & 2 ? 0 : gravity.y,
                    traits.locks & 4 ? 0 : gravity.z};
    return bodies.held[body] == 0 && length_squared(free) > 0;
}

}  // namespace

void finish(const StepContext& context, const dynamics::Solver& solver, const Constraints& constraints,
            const MotionStates& state) {
    const Settings& settings = context.settings;
    const float seconds = context.seconds;
    BodyTable& bodies = state.bodies;
    mark_held(constraints, bodies);
    const float linear = settings.sleep_linear_speed * seconds, angular = settings.sleep_angular_speed * seconds;
    const float distance = settings.sleep_distance;
    bodies.faults.assign(bodies.awake.size(), 0);
    parallel_ranges(context.tasks, bodies.awake.size(), 256, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t body = bodies.awake[i];
            const BodyTraits& traits = bodies.traits[body];
            const dynamics::SolverBody& row = solver.row(body);
            BodyMotion next = bodies.motion[body];
            next.position += Vec3d{row.moved[0], row.moved[1], row.moved[2]};
            const Quat turned = solver.motion(body).turned;
            if (!(turned == Quat{})) next.rotation = normalized(turned * next.rotation);
            next.linear_velocity = {row.velocity[0], row.velocity[1], row.velocity[2]};
            next.angular_velocity = {row.spin[0], row.spin[1], row.spin[2]};
            bodies.forces[body] = {};
            if (!is_valid(next)) {
                const bool left = is_finite(next.position) && is_finite(next.linear_velocity) &&
                                  is_finite(next.angular_velocity) && is_finite(next.rotation);
                bodies.faults[i] = left ? 2 : 1;
                continue;
            }
            const Vec3 path{row.moved[0], row.moved[1], row.moved[2]};
            const Vec3 angle{row.rotated[0], row.rotated[1], row.rotated[2]};
            next.drift += path;
            // Use the actual displacement, not the velocity: push-out moves bodies without changing their velocity.
            next.turn += turned.vector() * 2.0f;
            // A slow, steady motion is not rest; vibration about one place is.
            const bool stays = length(next.drift) + traits.reach * length(next.turn) < distance;
            // Mean speeds: that of a wedged stone at the end of a step is not how fast it moves.
            const bool slow = length_squared(path) < linear * linear && length_squared(angle) < angular * angular;
            const bool rests = traits.kind == BodyKind::Dynamic
                                   ? slow && stays && traits.can_sleep && !falls(bodies, settings.gravity, body)
                                   : !is_moving(next);
            next.sleep_time = rests || next.sleep_time < 0 ? next.sleep_time + seconds : 0;
            // The net motion is measured within each span of time_to_sleep, not since the body came to rest.
            const float span = settings.time_to_sleep;
            const bool spans_end =
                span > 0 && std::floor(next.sleep_time / span) > std::floor((next.sleep_time - seconds) / span);
            if (!rests || spans_end) next.drift = next.turn = {};
            bodies.motion[body] = next;
        }
    });
    std::vector<std::uint32_t> invalid;
    for (std::size_t i = 0; i < bodies.awake.size(); ++i)
        if (bodies.faults[i] != 0) {
            invalid.push_back(bodies.awake[i]);
            context.report.left_world += bodies.faults[i] == 2 ? 1 : 0;
        }
    for (const std::uint32_t body : invalid) quarantine(context, state, body);
    move_to_asleep(state, invalid);
}

}  // namespace fase
