/// One step of the solver: divides the bodies into batches, and solves these.
#include "fase/dynamics/solver/solver.hpp"

#include <algorithm>
#include <atomic>
#include <bit>

#include "fase/core/detail/float_mode.hpp"
#include "fase/core/detail/prefetch.hpp"
#include "fase/dynamics/solver/rows.hpp"

namespace fase::dynamics {
namespace {

constexpr std::size_t body_grain = 256;
constexpr std::size_t prefetch_ahead = 6;  // manifolds

/// Computes the world inverse inertia of a body. A locked axis does not rotate: its angular
/// momentum is left out by a Schur complement, so the other axes respond as if held there.
void world_inertia(SolverMass& mass, const BodyTraits& traits, Quat rotation) {
    set_inertia(mass, traits.inverse_moments, rotation);
    float(&m)[6] = mass.inertia;
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
}

}  // namespace

Solver::Solver() : serial_(make_serial_runner()) {}

void Solver::update_colours(const SolverInput& in) {
    for (const std::uint32_t body : loaded_) row_of_body_[body] = 0;
    row_of_body_.resize(in.bodies.traits.size(), 0);
    loaded_.assign(in.awake.begin(), in.awake.end());
    for (const std::uint32_t body : in.awake) row_of_body_[body] = 1;  // which one, load_bodies() knows
    in_hub_.resize(in.constraints.size());
    for (std::size_t i = 0; i < in.constraints.size(); ++i) {
        if (i + prefetch_ahead < in.constraints.size())
            detail::prefetch(in.manifolds[in.constraints[i + prefetch_ahead].index].colour);
        ConstraintColour& colour = in.manifolds[in.constraints[i].index].colour;
        in.colours.update(colour, in.constraints[i]);
        in_hub_[i] = colour.number == ConstraintColour::overflow ? 1 : 0;
    }
}

void Solver::load_bodies(const SolverInput& in) {
    const Bodies& bodies = in.bodies;
    const SolverSettings& settings = in.settings;
    rows_.resize(batches_.rows());
    masses_.resize(rows_.size());
    motions_.resize(rows_.size());
    const auto clear_row = [&](std::size_t row) {
        rows_[row] = {};
        masses_[row] = {};
        motions_[row] = {};
    };
    clear_row(0);
    for (const Batch& batch : batches_.all()) {
        clear_row(batch.unused_row());
        std::uint32_t row = batch.first_row;
        for (const std::uint32_t body : batches_.bodies_of(batch)) row_of_body_[body] = row++;
    }
    const float h = settings.sub_step();
    parallel_ranges(in.tasks, in.awake.size(), body_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const std::uint32_t index = in.awake[i];
            const BodyTraits& traits = bodies.traits[index];
            const BodyMotion& motion = bodies.motion[index];
            const BodyForces& forces = bodies.forces[index];
            const std::uint32_t at = row_of_body_[index];
            SolverBody& row = rows_[at];
            SolverMass& mass = masses_[at];
            SolverMotion& extra = motions_[at];
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

void Solver::solve(const SolverInput& in) {
    update_colours(in);
    batches_.divide({in.awake, in.constraints, row_of_body_, in_hub_}, in.groups);
    load_bodies(in);
    const ConstraintInput list{in.constraints, in.results};
    const std::span<const float> loads = known_loads_.find(
        {list, in.manifolds, in.bodies, in.awake, row_of_body_, motions_, in.settings.gravity, in.settings.resting_gap},
        in.tasks);
    const LaneInput lanes{in.bodies, row_of_body_, rows_, motions_, in.settings};
    const auto solve_batch = [&](const Batch& batch, BatchSolver& solver, TaskRunner& tasks) {
        solver.solve({batch, batches_.constraints_of(batch), in.constraints, loads, in.manifolds, in.results,
                      in.colours, row_of_body_, rows_, masses_, motions_, lanes, reference},
                     tasks);
    };
    // The first batch is large: its loops run in parallel. The others run in parallel to each other.
    const std::span<const Batch> small = batches_.all().subspan(1);
    const std::size_t workers = std::clamp<std::size_t>(static_cast<std::size_t>(in.tasks.threads()), 1,
                                                        std::max<std::size_t>(small.size(), 1));
    if (workers_.size() < workers) workers_.resize(workers);
    std::vector<BatchCounts> counts(batches_.all().size());
    solve_batch(batches_.all().front(), workers_.front(), in.tasks);
    counts[0] = workers_.front().counts();
    std::atomic<std::size_t> next = 0;
    run_chunks(in.tasks, small.empty() ? 0 : workers, [&](std::size_t worker) {
        const StandardFloats floats;
        for (std::size_t i = next++; i < small.size(); i = next++) {
            solve_batch(small[i], workers_[worker], *serial_);
            counts[i + 1] = workers_[worker].counts();
        }
    });
    counts_ = {};
    std::uint64_t colours = 0;
    for (const BatchCounts& count : counts) {
        colours |= count.colours;
        counts_.overflow += count.overflow;
    }
    counts_.colours = static_cast<std::uint32_t>(std::popcount(colours));
    for (const SolverMotion& motion : motions_) counts_.clamped += motion.clamped ? 1 : 0;
}

std::size_t Solver::bytes() const {
    std::size_t sum = rows_.capacity() * sizeof(SolverBody) + masses_.capacity() * sizeof(SolverMass) +
                      motions_.capacity() * sizeof(SolverMotion);
    for (const BatchSolver& worker : workers_) sum += worker.bytes();
    return sum;
}

}  // namespace fase::dynamics
