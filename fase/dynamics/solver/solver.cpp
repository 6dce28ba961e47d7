/// The soft step over graph colours: load, run, store.
#include "fase/dynamics/solver/solver.hpp"

#include <algorithm>
#include <cstring>

namespace fase::dynamics {
namespace {

constexpr std::size_t body_grain = 256;
constexpr std::size_t contact_grain = 128;
constexpr std::size_t block_grain = 24;
constexpr int overflow_two_sided = Colouring::colours, overflow_one_sided = Colouring::colours + 1;
constexpr float absent_separation = 1e9f;  // separation of an absent point

Vec3 read(const float (*rows)[8], int lane) { return {rows[0][lane], rows[1][lane], rows[2][lane]}; }
void write(float (*rows)[8], int lane, Vec3 v) {
    rows[0][lane] = v.x;
    rows[1][lane] = v.y;
    rows[2][lane] = v.z;
}
Vec3 read(const float* p) { return {p[0], p[1], p[2]}; }
void write(float* p, Vec3 v) {
    p[0] = v.x;
    p[1] = v.y;
    p[2] = v.z;
}

/// Computes the world inverse inertia R diag(inverse moments) Rᵀ, with zeros in the rows and columns of locked axes.
void world_inertia(SolverMass& mass, const BodyTraits& traits, Quat rotation) {
    const Mat3 r = to_matrix(rotation);
    const Vec3 i = traits.inverse_moments;
    const Vec3 x = r.x * i.x, y = r.y * i.y, z = r.z * i.z;
    float m[6] = {r.x.x * x.x + r.y.x * y.x + r.z.x * z.x, r.x.x * x.y + r.y.x * y.y + r.z.x * z.y,
                  r.x.x * x.z + r.y.x * y.z + r.z.x * z.z, r.x.y * x.y + r.y.y * y.y + r.z.y * z.y,
                  r.x.y * x.z + r.y.y * y.z + r.z.y * z.z, r.x.z * x.z + r.y.z * y.z + r.z.z * z.z};
    if (traits.locks & 8) m[0] = m[1] = m[2] = 0;
    if (traits.locks & 16) m[1] = m[3] = m[4] = 0;
    if (traits.locks & 32) m[2] = m[4] = m[5] = 0;
    std::copy(m, m + 6, mass.inertia);
    mass.inverse_mass = traits.inverse_mass;
}
Vec3 times(const float* m, Vec3 v) {
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[1] * v.x + m[3] * v.y + m[4] * v.z,
            m[2] * v.x + m[4] * v.y + m[5] * v.z};
}

void clear_block(ContactBlock& block, std::uint32_t unused_row) {
    std::memset(&block, 0, sizeof block);
    for (int i = 0; i < block_lanes; ++i) {
        block.a[i] = block.b[i] = unused_row;
        block.contact[i] = no_index;
        block.turn_a[3][i] = block.turn_b[3][i] = 1;
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
            row.inverse_mass = traits.inverse_mass;
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

void Solver::fill_lane(ContactBlock& block, int lane, const Slot& slot, const Contact& c, const Bodies& bodies) const {
    // In the block, b is always dynamic. Swapping a and b negates the normal and the second tangent, and with it y and
    // the friction impulse along that tangent.
    const std::uint32_t body_a = slot.flipped ? c.body_b : c.body_a;
    const std::uint32_t body_b = slot.flipped ? c.body_a : c.body_b;
    const BodyMotion& a = bodies.motion[body_a];
    const BodyMotion& b = bodies.motion[body_b];
    const float sign = slot.flipped ? -1.0f : 1.0f;
    block.a[lane] = row_of_body_[body_a];
    block.b[lane] = row_of_body_[body_b];
    block.contact[lane] = slot.contact;
    write(block.normal, lane, c.normal * sign);
    write(block.tangent, lane, c.tangent);
    write(block.offset_a, lane, slot.flipped ? c.offset_b : c.offset_a);
    write(block.offset_b, lane, slot.flipped ? c.offset_a : c.offset_b);
    write(block.shift, lane, to_float(b.position - a.position) - c.b_from_a * sign);
    const Quat turn_a = a.rotation * conjugate(slot.flipped ? c.rotation_b : c.rotation_a);
    const Quat turn_b = b.rotation * conjugate(slot.flipped ? c.rotation_a : c.rotation_b);
    const float qa[4] = {turn_a.x, turn_a.y, turn_a.z, turn_a.w}, qb[4] = {turn_b.x, turn_b.y, turn_b.z, turn_b.w};
    for (int i = 0; i < 4; ++i) {
        const bool present = i < c.count;
        block.turn_a[i][lane] = qa[i];
        block.turn_b[i][lane] = qb[i];
        block.x[i][lane] = present ? c.x[i] : 0;
        block.y[i][lane] = present ? c.y[i] * sign : 0;
        block.separation[i][lane] = present ? c.separation[i] : absent_separation;
        block.impulse[i][lane] = present ? c.impulse[i] : 0;
        block.point_mass[i][lane] = present ? 1.0f : 0.0f;  // prepare_points() replaces it by the mass
    }
    block.friction_impulse[0][lane] = c.friction_impulse[0];
    block.friction_impulse[1][lane] = c.friction_impulse[1] * sign;
    block.twist_impulse[lane] = c.twist_impulse;
    block.friction[lane] = c.friction;
    block.restitution[lane] = c.restitution;
    if (c.restitution > 0) {
        const SolverMotion& ma = motions_[block.a[lane]];
        const SolverMotion& mb = motions_[block.b[lane]];
        // Velocity per sub-step; bounce() divides by the time.
        block.closing[lane] = dot(c.normal * sign, ma.velocity_step - mb.velocity_step);
    }
}

void Solver::load_contacts(std::span<const Contact> contacts, std::span<const std::uint32_t> active,
                           const Bodies& bodies, const SolverSettings&, TaskRunner& tasks) {
    colouring_.reset(rows_.size());
    for (Colour& colour : colours_) colour.contacts = 0;
    slots_.resize(active.size());
    any_restitution_ = false;
    for (std::size_t i = 0; i < active.size(); ++i) {
        const Contact& c = contacts[active[i]];
        const std::uint32_t row_a = row_of_body_[c.body_a], row_b = row_of_body_[c.body_b];
        const bool a_is_dynamic = motions_[row_a].is_dynamic, b_is_dynamic = motions_[row_b].is_dynamic;
        int colour = a_is_dynamic && b_is_dynamic ? colouring_.colour(row_a, row_b)
                                                  : colouring_.colour_one_sided(b_is_dynamic ? row_b : row_a);
        if (colour == Colouring::none) colour = a_is_dynamic && b_is_dynamic ? overflow_two_sided : overflow_one_sided;
        slots_[i] = {active[i], static_cast<std::uint8_t>(colour), !b_is_dynamic, colours_[colour].contacts++};
        any_restitution_ |= c.restitution > 0;
    }
    counts_ = {};
    const auto unused_row = static_cast<std::uint32_t>(rows_.size() - 1);
    for (int i = 0; i < Colouring::colours + 2; ++i) {
        Colour& colour = colours_[i];
        colour.one_sided = (i >= Colouring::two_sided && i < Colouring::colours) || i == overflow_one_sided;
        const std::uint32_t lanes = i >= Colouring::colours ? 1 : block_lanes;  // overflow: one block per contact
        colour.blocks.resize((colour.contacts + lanes - 1) / lanes);
        if (colour.contacts == 0) continue;
        if (i >= Colouring::colours) {
            counts_.overflow += colour.contacts;
            for (ContactBlock& block : colour.blocks) clear_block(block, unused_row);
        } else {
            ++counts_.colours;
            clear_block(colour.blocks.back(), unused_row);
        }
    }
    parallel_ranges(tasks, slots_.size(), contact_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            const Slot& slot = slots_[i];
            const bool overflow = slot.colour >= Colouring::colours;
            ContactBlock& block = colours_[slot.colour].blocks[overflow ? slot.index : slot.index / block_lanes];
            const int lane = overflow ? 0 : static_cast<int>(slot.index % block_lanes);
            fill_lane(block, lane, slot, contacts[slot.contact], bodies);
        }
    });
}

void Solver::run_passes(Pass pass, const SolverSettings& settings, TaskRunner& tasks) {
    const float h = settings.time_step / static_cast<float>(settings.sub_steps);
    const float frequency = std::min(settings.contact_frequency, 0.25f / h);
    PassInput input{rows_.data(), masses_.data(), h, make_softness(frequency, settings.contact_damping_ratio, h),
                    settings.push_out_speed};
    PassInput one_sided = input;  // contacts with static and kinematic bodies are twice as stiff
    one_sided.softness = make_softness(2 * frequency, 0.5f * settings.contact_damping_ratio, h);
    const auto run = reference ? run_pass_reference : run_pass;
    for (const int overflow : {overflow_two_sided, overflow_one_sided}) {
        Colour& colour = colours_[overflow];
        for (ContactBlock& block : colour.blocks)
            run(pass, &block, 1, colour.one_sided, colour.one_sided ? one_sided : input);
    }
    for (int i = 0; i < Colouring::colours; ++i) {
        Colour& colour = colours_[i];
        const PassInput& pass_input = colour.one_sided ? one_sided : input;
        parallel_ranges(tasks, colour.blocks.size(), block_grain, [&](std::size_t begin, std::size_t end) {
            run(pass, colour.blocks.data() + begin, end - begin, colour.one_sided, pass_input);
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
        if (step == 0) run_passes(Pass::WarmStart, settings, tasks);
        run_passes(Pass::Biased, settings, tasks);
        each_body([&](auto rows, auto motions) { integrate_poses(rows, motions, h); });
        run_passes(Pass::Relax, settings, tasks);
    }
    if (any_restitution_)
        for (Colour& colour : colours_)
            for (ContactBlock& block : colour.blocks) bounce(block, settings);
    for (const SolverMotion& motion : motions_) counts_.clamped += motion.clamped ? 1 : 0;
}

/// Applies restitution to each point. The approach speed is the speed at the moment of touch, computed from speed, gap
/// and forces at the beginning of the step, so that an elastic bounce conserves energy wherever in the step it happens.
void Solver::bounce(ContactBlock& k, const SolverSettings& settings) {
    const float sub_steps = static_cast<float>(settings.sub_steps), h = settings.time_step / sub_steps;
    for (int lane = 0; lane < block_lanes; ++lane) {
        if (!(k.restitution[lane] > 0)) continue;
        SolverBody& a = rows_[k.a[lane]];
        SolverBody& b = rows_[k.b[lane]];
        const SolverMass& mass_a = masses_[k.a[lane]];
        const SolverMass& mass_b = masses_[k.b[lane]];
        const Vec3 n = read(k.normal, lane), t1 = read(k.tangent, lane), t2 = cross(n, t1);
        const float closing = k.closing[lane] / h;  // m/s²
        for (int i = 0; i < 4; ++i) {
            const float approach = k.approach[i][lane], mass = k.point_mass[i][lane], old = k.impulse[i][lane];
            if (!(mass > 0) || !(old > 0) || !(approach > settings.restitution_threshold)) continue;
            const float gap = std::max(k.separation[i][lane], 0.0f);
            const float at_touch = std::sqrt(std::max(approach * approach + 2 * closing * gap, 0.0f));
            const float target = k.restitution[lane] * at_touch;
            const Vec3 shift = t1 * k.x[i][lane] + t2 * k.y[i][lane];
            const Vec3 ra = read(k.offset_a, lane) + shift, rb = read(k.offset_b, lane) + shift;
            Vec3 va = read(a.velocity), wa = read(a.spin), vb = read(b.velocity), wb = read(b.spin);
            const float speed = dot(n, vb + cross(wb, rb) - va - cross(wa, ra));
            const float impulse = std::max(old - mass * (speed - target), 0.0f);
            k.impulse[i][lane] = impulse;
            const Vec3 p = n * (impulse - old);
            if (b.inverse_mass > 0) {
                write(b.velocity, vb + p * b.inverse_mass);
                write(b.spin, wb + times(mass_b.inertia, cross(rb, p)));
            }
            if (a.inverse_mass > 0) {
                write(a.velocity, va - p * a.inverse_mass);
                write(a.spin, wa - times(mass_a.inertia, cross(ra, p)));
            }
        }
    }
}

void Solver::store_contacts(std::span<Contact> contacts, TaskRunner& tasks) const {
    parallel_ranges(tasks, slots_.size(), contact_grain, [&](std::size_t begin, std::size_t end) {
        for (std::size_t s = begin; s < end; ++s) {
            const Slot& slot = slots_[s];
            const bool overflow = slot.colour >= Colouring::colours;
            const ContactBlock& block = colours_[slot.colour].blocks[overflow ? slot.index : slot.index / block_lanes];
            const int lane = overflow ? 0 : static_cast<int>(slot.index % block_lanes);
            Contact& c = contacts[slot.contact];
            float fastest = 0;
            c.nearest = absent_separation;
            c.pushes = false;
            for (int i = 0; i < c.count; ++i) {
                c.impulse[i] = block.impulse[i][lane];
                c.nearest = std::min(c.nearest, block.separation[i][lane]);
                if (!(c.impulse[i] > 0)) continue;
                c.pushes = true;
                fastest = std::max(fastest, block.approach[i][lane]);
            }
            c.approach = fastest;
            c.friction_impulse[0] = block.friction_impulse[0][lane];
            c.friction_impulse[1] = slot.flipped ? -block.friction_impulse[1][lane] : block.friction_impulse[1][lane];
            c.twist_impulse = block.twist_impulse[lane];
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
