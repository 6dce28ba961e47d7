/// The soft step over graph colours: load, run, store.
#include "fase/dynamics/solver/solver.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "fase/dynamics/solver/rows.hpp"

namespace fase::dynamics {
namespace {

constexpr std::size_t body_grain = 256;
constexpr std::size_t contact_grain = 128;
constexpr std::size_t block_grain = 24;
constexpr int overflow_two_sided = Colouring::colours, overflow_one_sided = Colouring::colours + 1;
constexpr float absent_separation = 1e9f;  // separation of an absent point

// The share of a known load that the spring need not bear. The rest damps: at 1, towers fall.
constexpr float known_part = 0.96f;
// The contact frequency as a share of the sub-step rate. One pass per sub-step acts as a spring of about m / h² itself:
// at an eighth, pyramids vibrate.
constexpr float max_frequency_share = 0.1f;

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

void clear_block(ContactBlock& block, std::uint32_t unused_row) {
    std::memset(&block, 0, sizeof block);
    for (int i = 0; i < block_lanes; ++i) {
        block.a[i] = block.b[i] = unused_row;
        block.contact[i] = no_index;
    }
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
    const float h = settings.time_step / static_cast<float>(settings.sub_steps);
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

void Solver::fill_lane(ContactBlock& block, int lane, const Slot& slot, const Contact& c, float load,
                       const Bodies& bodies, const SolverSettings& settings) const {
    // In the block, b is always dynamic. Swapping a and b negates the normal and the second tangent, and with it y and
    // the friction impulse along that tangent.
    const std::uint32_t body_a = slot.flipped ? c.body_b : c.body_a;
    const std::uint32_t body_b = slot.flipped ? c.body_a : c.body_b;
    const float sign = slot.flipped ? -1.0f : 1.0f;
    block.a[lane] = row_of_body_[body_a];
    block.b[lane] = row_of_body_[body_b];
    block.contact[lane] = slot.contact;
    const Vec3 normal = c.normal;
    Vec3 tangent = c.tangent;
    Vec3 offset_a = slot.flipped ? c.offset_b : c.offset_a, offset_b = slot.flipped ? c.offset_a : c.offset_b;
    // On a rotating support the contact moves along a circle. Its place in the middle of the step gives velocities
    // along the chord, so that what lies there does not drift outwards. The slower spin is that of the support.
    const Vec3 spin_a = bodies.motion[body_a].angular_velocity, spin_b = bodies.motion[body_b].angular_velocity;
    const Vec3 spin = length_squared(spin_a) < length_squared(spin_b) ? spin_a : spin_b;
    const Vec3 half = normal * (dot(normal, spin) * 0.25f * settings.time_step);
    if (length_squared(half) > 1e-9f) {  // below, the drift is far below a micrometre per step
        const Quat ahead = normalized(Quat{half.x, half.y, half.z, 1});
        tangent = rotate(ahead, tangent);
        offset_a = rotate(ahead, offset_a);
        offset_b = rotate(ahead, offset_b);
    }
    write(block.normal, lane, normal * sign);
    write(block.tangent, lane, tangent);
    write(block.offset_a, lane, offset_a);
    write(block.offset_b, lane, offset_b);
    block.turns_a[lane] = (slot.flipped ? c.b_rolls : c.a_rolls) ? 0.0f : 1.0f;
    block.turns_b[lane] = (slot.flipped ? c.a_rolls : c.b_rolls) ? 0.0f : 1.0f;
    // The impulses are those of the last sub-step: scale them to the length of this one.
    const float warm = settings.warm_start_scale;
    const float each = load / static_cast<float>(c.count);
    block.known_load[lane] = known_part * each;
    // A new contact starts with what it is known to bear, so that its stack does not first give way.
    bool is_new = !c.touching;
    for (int i = 0; i < c.count; ++i) is_new &= c.impulse[i] == 0;
    for (int i = 0; i < 4; ++i) {
        const bool present = i < c.count;
        block.x[i][lane] = present ? c.x[i] : 0;
        block.y[i][lane] = present ? c.y[i] * sign : 0;
        block.separation[i][lane] = present ? c.separation[i] : absent_separation;
        block.impulse[i][lane] = !present ? 0 : is_new ? each : c.impulse[i] * warm;
        block.total[i][lane] = 0;
        block.point_mass[i][lane] = present ? 1.0f : 0.0f;  // prepare_points() replaces it by the mass
    }
    block.friction_impulse[0][lane] = c.friction_impulse[0] * warm;
    block.friction_impulse[1][lane] = c.friction_impulse[1] * (warm * sign);
    block.twist_impulse[lane] = c.twist_impulse * warm;
    block.friction[lane] = c.friction;
    block.restitution[lane] = c.restitution;
    block.impact[lane] = 0;
    block.closing[lane] = 0;
    if (c.restitution > 0) {
        const SolverMotion& ma = motions_[block.a[lane]];
        const SolverMotion& mb = motions_[block.b[lane]];
        block.closing[lane] = dot(normal * sign, ma.velocity_step - mb.velocity_step);
    }
}

void Solver::load_contacts(std::span<const Contact> contacts, std::span<const std::uint32_t> active,
                           const Bodies& bodies, const SolverSettings& settings, TaskRunner& tasks) {
    const std::span<const float> loads = known_loads_.find(
        {contacts, active, bodies, loaded_, row_of_body_, motions_, settings.gravity, settings.resting_gap}, tasks);
    colouring_.reset(rows_.size());
    for (Colour& colour : colours_) {
        colour.contacts = 0;
        colour.restitution = false;
    }
    for (HubBlocks& hub : hubs_) hub.clear();
    slots_.resize(active.size());
    for (std::size_t i = 0; i < active.size(); ++i) {
        const Contact& c = contacts[active[i]];
        const std::uint32_t row_a = row_of_body_[c.body_a], row_b = row_of_body_[c.body_b];
        const bool a_is_dynamic = motions_[row_a].is_dynamic, b_is_dynamic = motions_[row_b].is_dynamic;
        const bool both = a_is_dynamic && b_is_dynamic;
        const int colour =
            both ? colouring_.colour(row_a, row_b) : colouring_.colour_one_sided(b_is_dynamic ? row_b : row_a);
        Slot& slot = slots_[i];
        if (colour != Colouring::none) {
            slot = {active[i], static_cast<std::uint8_t>(colour), !b_is_dynamic, colours_[colour].contacts++};
        } else {
            // A body with more contacts than colours is a hub: side a of blocks in which it may occur several times.
            const int hub = both ? overflow_two_sided : overflow_one_sided;
            const bool flipped = both ? colouring_.used(row_b) > colouring_.used(row_a) : b_is_dynamic;
            slot = {active[i], static_cast<std::uint8_t>(hub), flipped,
                    hubs_[both ? 0 : 1].place(flipped ? row_b : row_a, flipped ? row_a : row_b, both)};
            ++colours_[hub].contacts;
        }
        colours_[slot.colour].restitution |= c.restitution > 0;
    }
    counts_ = {};
    const auto unused_row = static_cast<std::uint32_t>(rows_.size() - 1);
    for (int i = 0; i < Colouring::colours; ++i) {
        Colour& colour = colours_[i];
        colour.on_static = i >= Colouring::two_sided;
        colour.sides = colour.on_static ? Sides::OnlyB : Sides::Both;
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
    parallel_ranges(tasks, slots_.size(), contact_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Slot& slot = slots_[i];
            fill_lane(colours_[slot.colour].blocks[slot.index / block_lanes],
                      static_cast<int>(slot.index % block_lanes), slot, contacts[slot.contact], loads[i], bodies,
                      settings);
        }
    });
}

void Solver::run_passes(Pass pass, const SolverSettings& settings, TaskRunner& tasks) {
    const float h = settings.time_step / static_cast<float>(settings.sub_steps);
    const float frequency = std::min(settings.contact_frequency, max_frequency_share / h);
    PassInput input{rows_.data(),
                    masses_.data(),
                    h,
                    make_softness(frequency, settings.contact_damping_ratio, h),
                    settings.push_out_speed,
                    settings.restitution_threshold};
    PassInput on_static = input;  // contacts with static and kinematic bodies are twice as stiff
    on_static.softness = make_softness(2 * frequency, 0.5f * settings.contact_damping_ratio, h);
    const auto run = reference ? run_pass_reference : run_pass;
    for (const int overflow : {overflow_two_sided, overflow_one_sided}) {
        Colour& colour = colours_[overflow];
        if (pass == Pass::FindImpacts && !colour.restitution) continue;
        run(pass, colour.blocks.data(), colour.blocks.size(), colour.sides, colour.on_static ? on_static : input);
    }
    for (int i = 0; i < Colouring::colours; ++i) {
        Colour& colour = colours_[i];
        if (pass == Pass::FindImpacts && !colour.restitution) continue;
        const PassInput& pass_input = colour.on_static ? on_static : input;
        parallel_ranges(tasks, colour.blocks.size(), block_grain, [&](std::size_t begin, std::size_t end) {
            run(pass, colour.blocks.data() + begin, end - begin, colour.sides, pass_input);
        });
    }
}

void Solver::run(const SolverSettings& settings, TaskRunner& tasks) {
    const float h = settings.time_step / static_cast<float>(settings.sub_steps);
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
    run_passes(Pass::Finish, settings, tasks);
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

void Solver::store_contact(Contact& c, const ContactBlock& block, int lane, const Slot& slot, const Bodies& bodies,
                           const SolverSettings& settings) const {
    const float sign = slot.flipped ? -1.0f : 1.0f;
    c.friction_impulse[0] = block.friction_impulse[0][lane];
    c.friction_impulse[1] = block.friction_impulse[1][lane] * sign;
    c.twist_impulse = block.twist_impulse[lane];
    c.approach = 0;
    c.pushes = false;
    int hardest = 0;
    for (int i = 0; i < c.count; ++i) {
        c.impulse[i] = block.impulse[i][lane];
        c.total_impulse[i] = block.total[i][lane];
        if (!(c.total_impulse[i] > 0)) continue;
        c.pushes = true;
        c.approach = std::max(c.approach, block.approach[i][lane]);
        if (c.total_impulse[i] > c.total_impulse[hardest]) hardest = i;
    }
    if (c.pushes && c.approach > settings.restitution_threshold) {
        // The point on the surface of the smaller body, moved with it until the touch. Bodies keep their velocity of
        // the beginning of the step until then.
        const Vec3 shift = c.tangent * c.x[hardest] + cross(c.normal, c.tangent) * c.y[hardest];
        const float half_gap = 0.5f * c.separation[hardest];
        const float speed = std::max(block.approach[hardest][lane], 1e-6f);
        const float seconds = std::clamp(c.separation[hardest] / speed, -settings.time_step, settings.time_step);
        const BodyMotion& ma = bodies.motion[c.body_a];
        const BodyMotion& mb = bodies.motion[c.body_b];
        const Vec3 b_from_a = c.offset_a - c.offset_b;
        const Vec3 on_a = c.offset_a + shift - c.normal * half_gap + ma.linear_velocity * seconds;
        const Vec3 on_b = c.offset_b + shift + c.normal * half_gap + mb.linear_velocity * seconds + b_from_a;
        const bool a_is_smaller = bodies.traits[c.body_a].reach < bodies.traits[c.body_b].reach;
        c.hit_offset_a = (a_is_smaller ? on_a : on_b) - read(rows_[row_of_body_[c.body_a]].moved);
    }
    c.nearest = absent_separation;
    for (int i = 0; i < c.count; ++i) {
        c.separation[i] = block.separation[i][lane];
        c.nearest = std::min(c.nearest, c.separation[i]);
    }
}

void Solver::store_contacts(std::span<Contact> contacts, const Bodies& bodies, const SolverSettings& settings,
                            TaskRunner& tasks) const {
    parallel_ranges(tasks, slots_.size(), contact_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            const Slot& slot = slots_[s];
            const ContactBlock& block = colours_[slot.colour].blocks[slot.index / block_lanes];
            const int lane = static_cast<int>(slot.index % block_lanes);
            store_contact(contacts[slot.contact], block, lane, slot, bodies, settings);
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
