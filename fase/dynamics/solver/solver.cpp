/// The soft step over graph colours: load, run, store.
#include "fase/dynamics/solver/solver.hpp"

#include <algorithm>
#include <cmath>

#include "fase/core/detail/prefetch.hpp"
#include "fase/dynamics/solver/rows.hpp"

namespace fase::dynamics {
namespace {

constexpr std::size_t body_grain = 256;
constexpr std::size_t contact_grain = 128;
constexpr std::size_t block_grain = 24;
constexpr std::size_t prefetch_ahead = 6;  // manifolds
constexpr int overflow_two_sided = ConstraintColours::count, overflow_one_sided = ConstraintColours::count + 1;
// The contact frequency as a share of the sub-step rate. One pass per sub-step acts as a spring of about m / h² itself:
// at an eighth, pyramids vibrate.
constexpr float max_frequency_share = 0.1f;
// A sleeper is held, so the effective mass of its contact with an equal body is twice that of two awake ones. This
// share of frequency and damping ratio, the root of 1/2, keeps stiffness and damping of the contact as they were: what
// lies beside a body that falls asleep or wakes does not jump.
constexpr float sleeper_share = 0.70710678f;

/// Computes the world inverse inertia R diag(inverse moments) Rᵀ of a body. A locked axis does not rotate: its angular
/// momentum is left out by a Schur complement, so the other axes respond as if held there.
void world_inertia(SolverMass& mass, const BodyTraits& traits, Quat rotation) {
    const Mat3 r = to_matrix(rotation);
    const Vec3 i = traits.inverse_moments;
    const Vec3 x = r.x * i.x, y = r.y * i.y, z = r.z * i.z;
    float m[6] = {r.x.x * x.x + r.y.x * y.x + r.z.x * z.x, r.x.x * x.y + r.y.x * y.y + r.z.x * z.y,
                  r.x.x * x.z + r.y.x * y.z + r.z.x * z.z, r.x.y * x.y + r.y.y * y.y + r.z.y * z.y,
                  r.x.y * x.z + r.y.y * y.z + r.z.y * z.z, r.x.z * x.z + r.y.z * y.z + r.z.z * z.z};
    constexpr int at[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
    for (int axis = 0; axis < 3; ++axis) {
        if (!(traits.locks & (8u << axis))) continue;
        const float pivot = m[at[axis][axis]];
        const float column[3] = {m[at[axis][0]], m[at[axis][1]], m[at[axis][2]]};
        for (int row = 0; row < 3; ++row)
            for (int col = row; col < 3; ++col) {
                const bool locked = row == axis || col == axis || !(pivot > 0);
                float& entry = m[at[row][col]];
                entry = locked && (row == axis || col == axis) ? 0
                        : pivot > 0                            ? entry - column[row] * column[col] / pivot
                                                               : entry;
            }
    }
    std::copy(m, m + 6, mass.inertia);
}

}  // namespace

Softness make_softness(float frequency, float damping_ratio, float sub_step) {
    if (frequency <= 0) return {0, 1, 0};
    const float omega = 2 * 3.14159265358979f * frequency;
    const float a1 = 2 * damping_ratio + sub_step * omega;
    const float a2 = sub_step * omega * a1;
    const float a3 = 1 / (1 + a2);
    return {omega / a1, a2 * a3, a3};
}

void Solver::load_bodies(const Bodies& bodies, std::span<const std::uint32_t> awake, const SolverSettings& settings,
                         TaskRunner& tasks) {
    for (const std::uint32_t body : loaded_) row_of_body_[body] = 0;
    row_of_body_.resize(bodies.traits.size(), 0);
    loaded_.assign(awake.begin(), awake.end());
    const std::size_t rows = awake.size() + 2;
    rows_.resize(rows);
    masses_.resize(rows);
    motions_.resize(rows);
    for (const std::size_t fixed : {std::size_t{0}, rows - 1}) {
        rows_[fixed] = {};
        masses_[fixed] = {};
        motions_[fixed] = {};
    }
    const float h = settings.sub_step();
    parallel_ranges(tasks, awake.size(), body_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t index = awake[i];
            const BodyTraits& traits = bodies.traits[index];
            const BodyMotion& motion = bodies.motion[index];
            const BodyForces& forces = bodies.forces[index];
            row_of_body_[index] = static_cast<std::uint32_t>(i + 1);
            SolverBody& row = rows_[i + 1];
            SolverMass& mass = masses_[i + 1];
            SolverMotion& extra = motions_[i + 1];
            row = {};
            extra = {};
            write(row.velocity, motion.linear_velocity);
            write(row.spin, motion.angular_velocity);
            extra.rotation = motion.rotation;
            if (traits.kind != BodyKind::Dynamic) {
                mass = {};
                continue;
            }
            const float inverse_mass = traits.inverse_mass;
            mass.inverse_mass_x = traits.locks & 1 ? 0 : inverse_mass;
            mass.inverse_mass_y = traits.locks & 2 ? 0 : inverse_mass;
            row.inverse_mass_z = traits.locks & 4 ? 0 : inverse_mass;
            world_inertia(mass, traits, motion.rotation);
            extra.is_dynamic = true;
            extra.locks = traits.locks;
            if (traits.inverse_mass > 0) extra.velocity_step = settings.gravity * (h * traits.gravity_scale);
            extra.velocity_step += forces.force * (h * traits.inverse_mass);
            extra.spin_step = times(mass.inertia, forces.torque) * h;
            extra.linear_factor = 1 / (1 + h * traits.linear_damping);
            extra.angular_factor = 1 / (1 + h * traits.angular_damping);
            const Vec3 inverse = traits.inverse_moments;
            if (inverse.x > 0 && inverse.y > 0 && inverse.z > 0 && (traits.locks & 0x38) == 0) {
                extra.moments = {1 / inverse.x, 1 / inverse.y, 1 / inverse.z};
                const float max = std::max({inverse.x, inverse.y, inverse.z});
                const float min = std::min({inverse.x, inverse.y, inverse.z});
                extra.gyroscopic = max - min > 1e-5f * max;
            }
        }
    });
}

Solver::Slot Solver::place(const Constraint& constraint, ConstraintColour colour, const ConstraintColours& colours) {
    const bool both = constraint.moves == Moves::Both;
    if (colour.number < ConstraintColours::count)
        return {colour.number, !moves_b(constraint.moves), colours_[colour.number].contacts++};
    // A body with more constraints than colours is a hub: side a of blocks in which it may occur several times.
    const std::uint32_t row_a = row_of_body_[constraint.body_a], row_b = row_of_body_[constraint.body_b];
    const int overflow = both ? overflow_two_sided : overflow_one_sided;
    const bool flipped =
        both ? colours.used(constraint.body_b) > colours.used(constraint.body_a) : moves_b(constraint.moves);
    ++colours_[overflow].contacts;
    return {static_cast<std::uint8_t>(overflow), flipped,
            hubs_[both ? 0 : 1].place(flipped ? row_b : row_a, flipped ? row_a : row_b, both)};
}

void Solver::prepare_blocks() {
    counts_ = {};
    const auto unused_row = static_cast<std::uint32_t>(rows_.size() - 1);
    for (int i = 0; i < ConstraintColours::count; ++i) {
        Colour& colour = colours_[i];
        colour.on_static = i >= ConstraintColours::two_sided && i < ConstraintColours::on_sleeper;
        colour.on_sleeper = i >= ConstraintColours::on_sleeper;
        colour.sides = i >= ConstraintColours::two_sided ? Sides::OnlyB : Sides::Both;
        colour.blocks.resize((colour.contacts + block_lanes - 1) / block_lanes);
        if (colour.contacts == 0) continue;
        ++counts_.colours;
        clear_block(colour.blocks.back(), unused_row);
    }
    for (const int i : {overflow_two_sided, overflow_one_sided}) {
        Colour& colour = colours_[i];
        const HubBlocks& hub = hubs_[i - overflow_two_sided];
        colour.on_static = i == overflow_one_sided;
        colour.sides = Sides::Hub;
        colour.blocks.resize(hub.size());
        counts_.overflow += colour.contacts;
        for (std::size_t block = 0; block < hub.size(); ++block) {
            clear_block(colour.blocks[block], unused_row);
            for (int lane = 0; lane < block_lanes; ++lane) colour.blocks[block].split[lane] = hub.split(block, lane);
        }
    }
}

void Solver::load_constraints(const ConstraintInput& in, ConstraintColours& colours, ManifoldPool& manifolds,
                              const Bodies& bodies, const SolverSettings& settings, TaskRunner& tasks) {
    const std::span<const float> loads = known_loads_.find(
        {in, manifolds, bodies, loaded_, row_of_body_, motions_, settings.gravity, settings.resting_gap}, tasks);
    for (Colour& colour : colours_) {
        colour.contacts = 0;
        colour.restitution = false;
    }
    for (HubBlocks& hub : hubs_) hub.clear();
    slots_.resize(in.constraints.size());
    for (std::size_t i = 0; i < in.constraints.size(); ++i) {
        if (i + prefetch_ahead < in.constraints.size())
            detail::prefetch(manifolds[in.constraints[i + prefetch_ahead].index].colour);
        const Constraint& constraint = in.constraints[i];
        ContactManifold& manifold = manifolds[constraint.index];
        colours.update(manifold.colour, constraint);
        slots_[i] = {};
        if (constraint.moves == Moves::Neither) continue;
        slots_[i] = place(constraint, manifold.colour, colours);
        colours_[slots_[i].colour].restitution |= manifold.restitution > 0;
    }
    prepare_blocks();
    const LaneInput lanes{bodies, row_of_body_, rows_, motions_, settings};
    parallel_ranges(tasks, slots_.size(), contact_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (i + prefetch_ahead < end) detail::prefetch(manifolds[in.constraints[i + prefetch_ahead].index]);
            if (slots_[i].colour != ConstraintColour::none)
                fill_lane(lane_of(slots_[i]), in.constraints[i], manifolds[in.constraints[i].index], loads[i], lanes);
        }
    });
}

void Solver::run_passes(Pass pass, const SolverSettings& settings, TaskRunner& tasks) {
    const float h = settings.sub_step();
    const float frequency = std::min(settings.contact_frequency, max_frequency_share / h);
    PassInput input{rows_.data(),
                    masses_.data(),
                    h,
                    make_softness(frequency, settings.contact_damping_ratio, h),
                    settings.push_out_speed,
                    settings.restitution_threshold};
    PassInput on_static = input;  // contacts with static and kinematic bodies are twice as stiff
    on_static.softness = make_softness(2 * frequency, 0.5f * settings.contact_damping_ratio, h);
    PassInput on_sleeper = input;
    on_sleeper.softness = make_softness(sleeper_share * frequency, sleeper_share * settings.contact_damping_ratio, h);
    const auto run = reference ? run_pass_reference : run_pass;
    for (const int overflow : {overflow_two_sided, overflow_one_sided}) {
        Colour& colour = colours_[overflow];
        if (pass == Pass::FindImpacts && !colour.restitution) continue;
        run(pass, colour.blocks.data(), colour.blocks.size(), colour.sides, colour.on_static ? on_static : input);
    }
    for (int i = 0; i < ConstraintColours::count; ++i) {
        Colour& colour = colours_[i];
        if (pass == Pass::FindImpacts && !colour.restitution) continue;
        const PassInput& pass_input = colour.on_static ? on_static : colour.on_sleeper ? on_sleeper : input;
        parallel_ranges(tasks, colour.blocks.size(), block_grain, [&](std::size_t begin, std::size_t end) {
            run(pass, colour.blocks.data() + begin, end - begin, colour.sides, pass_input);
        });
    }
}

void Solver::run(const SolverSettings& settings, TaskRunner& tasks) {
    const float h = settings.sub_step();
    const std::size_t bodies = rows_.size() - 2;
    run_passes(Pass::Prepare, settings, tasks);
    const auto each_body = [&](auto&& work) {
        parallel_ranges(tasks, bodies, body_grain, [&](std::size_t begin, std::size_t end) {
            work(std::span(rows_).subspan(begin + 1, end - begin), std::span(motions_).subspan(begin + 1, end - begin));
        });
    };
    for (int step = 0; step < settings.sub_steps; ++step) {
        each_body(
            [&](auto rows, auto motions) { integrate_velocities(rows, motions, step > 0, settings.speed_limits); });
        solve_impacts(settings, h, tasks);
        if (step == 0) run_passes(Pass::WarmStart, settings, tasks);
        run_passes(Pass::Biased, settings, tasks);
        each_body([&](auto rows, auto motions) { integrate_poses(rows, motions, h); });
        impacts_.correct_paths(rows_, motions_);
        run_passes(Pass::Relax, settings, tasks);
    }
    for (const SolverMotion& motion : motions_) counts_.clamped += motion.clamped ? 1 : 0;
}

void Solver::solve_impacts(const SolverSettings& settings, float sub_step, TaskRunner& tasks) {
    const bool any = std::any_of(colours_.begin(), colours_.end(), [](const Colour& c) { return c.restitution; });
    if (!any) return;
    const ImpactInput input{rows_, masses_, motions_, sub_step, settings.restitution_threshold};
    for (int round = 0; round < Impacts::max_rounds; ++round) {
        run_passes(Pass::FindImpacts, settings, tasks);
        if (!impacts_.solve_round(colours_, input)) return;
    }
}

void Solver::store_constraints(std::span<const Constraint> constraints, ManifoldPool& manifolds,
                               std::span<ContactResult> results, const Bodies& bodies, const SolverSettings& settings,
                               TaskRunner& tasks) {
    const LaneInput lanes{bodies, row_of_body_, rows_, motions_, settings};
    parallel_ranges(tasks, slots_.size(), contact_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (i + prefetch_ahead < end) detail::prefetch(manifolds[constraints[i + prefetch_ahead].index]);
            if (slots_[i].colour == ConstraintColour::none) continue;
            const Constraint& constraint = constraints[i];
            results[i] = store_lane(lane_of(slots_[i]), constraint, manifolds[constraint.index],
                                    rows_[row_of_body_[constraint.body_a]], lanes);
        }
    });
}

std::size_t Solver::bytes() const {
    std::size_t sum = rows_.capacity() * sizeof(SolverBody) + masses_.capacity() * sizeof(SolverMass) +
                      motions_.capacity() * sizeof(SolverMotion) + slots_.capacity() * sizeof(Slot);
    for (const Colour& colour : colours_) sum += colour.blocks.capacity() * sizeof(ContactBlock);
    return sum;
}

}  // namespace fase::dynamics
