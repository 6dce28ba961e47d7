/// The soft step over graph colours.
#include "fase/dynamics/solver/batch_solver.hpp"

#include <algorithm>

#include "fase/core/detail/prefetch.hpp"
#include "fase/dynamics/solver/rows.hpp"

namespace fase::dynamics {
namespace {

constexpr std::size_t body_grain = 256;
constexpr std::size_t four_grain = 32;
constexpr std::size_t block_grain = 24;
constexpr std::size_t prefetch_ahead = 6, fours_ahead = 2;  // manifolds
// Lanes are filled four at a time, in the order of the blocks. When so many manifolds do not fit the cache, that order
// costs more than it saves: then one at a time, in the order of the constraints.
constexpr std::size_t max_for_fours = 24'000, contact_grain = 128;
constexpr int overflow_two_sided = ConstraintColours::count, overflow_one_sided = ConstraintColours::count + 1;
// The contact frequency as a share of the sub-step rate. One pass per sub-step acts as a spring of about m / h² itself:
// at an eighth, pyramids vibrate.
constexpr float max_frequency_share = 0.1f;
// A sleeper is held, so the effective mass of its contact with an equal body is twice that of two awake ones. This
// share of frequency and damping ratio, the root of 1/2, keeps stiffness and damping of the contact as they were: what
// lies beside a body that falls asleep or wakes does not jump.
constexpr float sleeper_share = 0.70710678f;
// Slower bodies, in radians per sub-step, keep the inertia tensor of the beginning of the step.
constexpr float slow_turn = 1e-3f;
// The change of an inverse inertia tensor per sub-step above which it is computed in each sub-step, with what depends
// on it: InertiaTurn::change. With that of the beginning of the step, contacts give thin bodies that spin energy
// without bound.
constexpr float fast_change = 0.2f;
// The same between the two passes of a sub-step, above this angle in radians. The relax pass then keeps the velocity of
// push-out, so only where the contact of before is meaningless.
constexpr float whirling_turn = 0.6f;
// Radians per step above which the same is done for any rotation, also for one about an axis of symmetry.
constexpr float max_turn_per_step = 4;

}  // namespace

Softness make_softness(float frequency, float damping_ratio, float sub_step) {
    if (frequency <= 0) return {0, 1, 0};
    const float omega = 2 * 3.14159265358979f * frequency;
    const float a1 = 2 * damping_ratio + sub_step * omega;
    const float a2 = sub_step * omega * a1;
    const float a3 = 1 / (1 + a2);
    return {omega / a1, a2 * a3, a3};
}

void BatchSolver::solve(const BatchInput& in, TaskRunner& tasks) {
    load(in, tasks);
    run(in, tasks);
    store(in, tasks);
}

BatchSolver::Slot BatchSolver::place(const BatchInput& in, const Constraint& constraint, ConstraintColour colour) {
    const bool both = constraint.moves == Moves::Both;
    if (colour.number < ConstraintColours::count)
        return {colour.number, !moves_b(constraint.moves), colours_[colour.number].contacts++};
    // A body with more constraints than colours is a hub: side a of blocks in which it may occur several times.
    const std::uint32_t row_a = in.row_of_body[constraint.body_a], row_b = in.row_of_body[constraint.body_b];
    const int overflow = both ? overflow_two_sided : overflow_one_sided;
    const bool flipped =
        both ? in.colours.used(constraint.body_b) > in.colours.used(constraint.body_a) : moves_b(constraint.moves);
    ++colours_[overflow].contacts;
    return {static_cast<std::uint8_t>(overflow), flipped,
            hubs_[both ? 0 : 1].place(flipped ? row_b : row_a, flipped ? row_a : row_b, both)};
}

void BatchSolver::prepare_blocks(std::uint32_t unused_row) {
    counts_ = {};
    for (int i = 0; i < ConstraintColours::count; ++i) {
        Colour& colour = colours_[i];
        colour.on_static = i >= ConstraintColours::two_sided && i < ConstraintColours::on_sleeper;
        colour.on_sleeper = i >= ConstraintColours::on_sleeper;
        colour.sides = i >= ConstraintColours::two_sided ? Sides::OnlyB : Sides::Both;
        colour.blocks.resize((colour.contacts + block_lanes - 1) / block_lanes);
        if (colour.contacts == 0) continue;
        counts_.colours |= std::uint64_t{1} << i;
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

void BatchSolver::load(const BatchInput& in, TaskRunner& tasks) {
    for (Colour& colour : colours_) {
        colour.contacts = 0;
        colour.restitution = false;
    }
    for (HubBlocks& hub : hubs_) hub.clear();
    slots_.resize(in.numbers.size());
    const auto manifold = [&](std::size_t i) -> ContactManifold& {
        return in.manifolds[in.constraints[in.numbers[i]].index];
    };
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        if (i + prefetch_ahead < slots_.size()) detail::prefetch(manifold(i + prefetch_ahead).colour);
        slots_[i] = place(in, in.constraints[in.numbers[i]], manifold(i).colour);
        colours_[slots_[i].colour].restitution |= manifold(i).restitution > 0;
    }
    prepare_blocks(in.batch.unused_row());
    if (slots_.size() > max_for_fours) {
        for_each_slot(in, tasks, [&](const Lane& lane, std::uint32_t number, ContactManifold& m) {
            fill_lane(lane, in.constraints[number], m, in.loads[number], in.lanes);
        });
        return;
    }
    list_lanes(in);
    for_each_four(in, tasks, [&](FourLanes& four, const Four& of) {
        const ContactManifold* manifolds[4];
        for (int k = 0; k < 4; ++k) manifolds[k] = of.manifolds[k];
        float loads[4];
        for (int k = 0; k < 4; ++k) loads[k] = of.constraints[k] ? in.loads[of.numbers[k]] : 0;
        if (of.all && fill_four(*four.block, four.lane, of.constraints, manifolds, of.flipped, loads, in.lanes)) return;
        for (int k = 0; k < 4; ++k)
            if (of.constraints[k])
                fill_lane({four.block, four.lane + k, of.flipped[k]}, *of.constraints[k], *manifolds[k], loads[k],
                          in.lanes);
    });
}

void BatchSolver::list_lanes(const BatchInput& in) {
    fours_.clear();
    std::array<std::uint32_t, ConstraintColours::count + 2> first;
    for (std::size_t c = 0; c < colours_.size(); ++c) {
        first[c] = static_cast<std::uint32_t>(4 * fours_.size());
        for (ContactBlock& block : colours_[c].blocks)
            for (int lane = 0; lane < block_lanes; lane += 4) fours_.push_back({&block, lane});
    }
    users_.assign(4 * fours_.size(), {});
    for (std::size_t i = 0; i < slots_.size(); ++i) {
        const std::uint32_t number = in.numbers[i];
        users_[first[slots_[i].colour] + slots_[i].index] = {number, in.constraints[number].index, slots_[i].flipped};
    }
}

template <class F> void BatchSolver::for_each_slot(const BatchInput& in, TaskRunner& tasks, const F& f) {
    parallel_ranges(tasks, slots_.size(), contact_grain, [&](std::size_t begin, std::size_t end) {
        const auto manifold = [&](std::size_t i) -> ContactManifold& {
            return in.manifolds[in.constraints[in.numbers[i]].index];
        };
        for (std::size_t i = begin; i < end; ++i) {
            if (i + prefetch_ahead < end) detail::prefetch(manifold(i + prefetch_ahead));
            const Slot& slot = slots_[i];
            f({&colours_[slot.colour].blocks[slot.index / block_lanes], static_cast<int>(slot.index % block_lanes),
               slot.flipped},
              in.numbers[i], manifold(i));
        }
    });
}

template <class F> void BatchSolver::for_each_four(const BatchInput& in, TaskRunner& tasks, const F& f) {
    parallel_ranges(tasks, fours_.size(), four_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            if (i + fours_ahead < end)
                for (const LaneUser& user : std::span(users_).subspan(4 * (i + fours_ahead), 4))
                    if (user.number != no_index) {
                        detail::prefetch(in.manifolds[user.manifold]);
                        detail::prefetch(in.constraints[user.number]);
                    }
            Four of;
            for (std::size_t k = 0; k < 4; ++k) {
                const LaneUser& user = users_[4 * i + k];
                if (user.number == no_index) {
                    of.all = false;
                    continue;
                }
                of.numbers[k] = user.number;
                of.constraints[k] = &in.constraints[user.number];
                of.manifolds[k] = &in.manifolds[user.manifold];
                of.flipped[k] = user.flipped;
            }
            f(fours_[i], of);
        }
    });
}

void BatchSolver::run_passes(Pass pass, const BatchInput& in, TaskRunner& tasks) {
    const SolverSettings& settings = in.lanes.settings;
    const float h = settings.sub_step();
    const float frequency = std::min(settings.contact_frequency, max_frequency_share / h);
    PassInput input{in.rows.data(),
                    in.masses.data(),
                    h,
                    make_softness(frequency, settings.contact_damping_ratio, h),
                    settings.push_out_speed,
                    settings.restitution_threshold};
    PassInput on_static = input;  // contacts with static and kinematic bodies are twice as stiff
    on_static.softness = make_softness(2 * frequency, 0.5f * settings.contact_damping_ratio, h);
    PassInput on_sleeper = input;
    on_sleeper.softness = make_softness(sleeper_share * frequency, sleeper_share * settings.contact_damping_ratio, h);
    const auto run = in.reference ? run_pass_reference : run_pass;
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

void BatchSolver::run(const BatchInput& in, TaskRunner& tasks) {
    const SolverSettings& settings = in.lanes.settings;
    const float h = settings.sub_step();
    run_passes(Pass::Prepare, in, tasks);
    const auto each_body = [&](auto&& work) {
        parallel_ranges(tasks, in.batch.bodies, body_grain, [&](std::size_t begin, std::size_t end) {
            const std::size_t first = in.batch.first_row + begin;
            work(in.rows.subspan(first, end - begin), in.motions.subspan(first, end - begin));
        });
    };
    for (int step = 0; step < settings.sub_steps; ++step) {
        const bool fresh = step == 0 || turn_fast_bodies(in, false, tasks);
        each_body([&](auto rows, auto motions) { integrate_velocities(rows, motions, !fresh, settings.speed_limits); });
        solve_impacts(in, tasks);
        if (fresh) run_passes(Pass::WarmStart, in, tasks);
        run_passes(Pass::Biased, in, tasks);
        each_body([&](auto rows, auto motions) { integrate_poses(rows, motions, h); });
        impacts_.correct_paths(in.rows, in.motions);
        turn_fast_bodies(in, true, tasks);
        run_passes(Pass::Relax, in, tasks);
    }
}

bool BatchSolver::turn_fast_bodies(const BatchInput& in, bool within_sub_step, TaskRunner& tasks) {
    const float h = in.lanes.settings.sub_step();
    const float max_turn = max_turn_per_step / static_cast<float>(in.lanes.settings.sub_steps);
    const auto is_fast = [&](std::uint32_t row) {
        const Vec3 turn = read(in.rows[row].spin) * h;
        if (!in.motions[row].gyroscopic || !(length_squared(turn) > slow_turn * slow_turn)) return false;
        if (length_squared(turn) > max_turn * max_turn) return true;
        const InertiaTurn of_inertia = inertia_turn(in.motions[row], turn);
        return within_sub_step ? of_inertia.angle > whirling_turn : of_inertia.change > fast_change;
    };
    bool any = false;
    for (std::uint32_t row = in.batch.first_row; row < in.batch.first_row + in.batch.bodies; ++row) {
        if (!is_fast(row)) continue;
        any = true;
        turn_inertia(in.masses[row], in.motions[row]);
    }
    if (!any) return false;
    // Their impulses acted on bodies that stood otherwise. The relax pass counts those of a sub-step.
    for (Colour& colour : colours_)
        for (ContactBlock& block : colour.blocks)
            for (int lane = 0; lane < block_lanes; ++lane) {
                if (!is_fast(block.a[lane]) && !is_fast(block.b[lane])) continue;
                for (std::size_t i = 0; i < 4; ++i) {
                    if (within_sub_step) block.total[i][lane] += block.impulse[i][lane];
                    block.impulse[i][lane] = 0;
                }
                for (auto& impulse : block.friction_impulse) impulse[lane] = 0;
                block.twist_impulse[lane] = 0;
            }
    run_passes(Pass::PrepareAgain, in, tasks);
    return true;
}

void BatchSolver::solve_impacts(const BatchInput& in, TaskRunner& tasks) {
    const bool any = std::any_of(colours_.begin(), colours_.end(), [](const Colour& c) { return c.restitution; });
    if (!any) return;
    const SolverSettings& settings = in.lanes.settings;
    const ImpactInput input{in.rows, in.masses, in.motions, settings.sub_step(), settings.restitution_threshold};
    for (int round = 0; round < Impacts::max_rounds; ++round) {
        run_passes(Pass::FindImpacts, in, tasks);
        if (!impacts_.solve_round(colours_, input)) return;
    }
}

void BatchSolver::store(const BatchInput& in, TaskRunner& tasks) {
    if (slots_.size() > max_for_fours) {
        for_each_slot(in, tasks, [&](const Lane& lane, std::uint32_t number, ContactManifold& m) {
            in.results[number] = store_lane(lane, in.constraints[number], m, in.lanes);
        });
        return;
    }
    for_each_four(in, tasks, [&](FourLanes& four, const Four& of) {
        if (of.all) {
            ContactResult* results[4];
            for (int k = 0; k < 4; ++k) results[k] = &in.results[of.numbers[k]];
            store_four_lanes(*four.block, four.lane, of.constraints, of.manifolds, of.flipped, results, in.lanes);
            return;
        }
        for (int k = 0; k < 4; ++k)
            if (of.constraints[k])
                in.results[of.numbers[k]] = store_lane({four.block, four.lane + k, of.flipped[k]}, *of.constraints[k],
                                                       *of.manifolds[k], in.lanes);
    });
}

std::size_t BatchSolver::bytes() const {
    std::size_t sum =
        slots_.capacity() * sizeof(Slot) + fours_.capacity() * sizeof(FourLanes) + users_.capacity() * sizeof(LaneUser);
    for (const Colour& colour : colours_) sum += colour.blocks.capacity() * sizeof(ContactBlock);
    return sum;
}

}  // namespace fase::dynamics
