/// Contacts into lanes of the solver's blocks, and back.
#include "fase/dynamics/solver/contact_lanes.hpp"

#include <algorithm>
#include <cstring>

#include "fase/dynamics/solver/rows.hpp"

namespace fase::dynamics {
namespace {

constexpr float absent_separation = 1e9f;  // separation of an absent point

// The share of a known load that the spring need not bear. The rest damps: at 1, towers fall.
constexpr float known_part = 0.96f;

/// Where the surfaces met at a point, from the centre of mass of a at the beginning of the step: on the surface of the
/// smaller body, moved with it until the touch. Bodies keep their velocity of the beginning of the step until then.
Vec3 hit_offset(const ContactManifold& m, int point, float approach, const Constraint& constraint,
                const LaneInput& in) {
    const Vec3 shift = m.tangent * m.x[point] + cross(m.normal, m.tangent) * m.y[point];
    const float half_gap = 0.5f * m.separation[point], step = in.settings.time_step;
    const float seconds = std::clamp(m.separation[point] / std::max(approach, 1e-6f), -step, step);
    const BodyMotion& a = in.bodies.motion[constraint.body_a];
    const BodyMotion& b = in.bodies.motion[constraint.body_b];
    const Vec3 b_from_a = m.offset_a - m.offset_b;
    const Vec3 on_a = m.offset_a + shift - m.normal * half_gap + a.linear_velocity * seconds;
    const Vec3 on_b = m.offset_b + shift + m.normal * half_gap + b.linear_velocity * seconds + b_from_a;
    return in.bodies.traits[constraint.body_a].reach < in.bodies.traits[constraint.body_b].reach ? on_a : on_b;
}

}  // namespace

void clear_block(ContactBlock& block, std::uint32_t unused_row) {
    std::memset(&block, 0, sizeof block);
    for (int i = 0; i < block_lanes; ++i) block.a[i] = block.b[i] = unused_row;
}

void fill_lane(const Lane& at, const Constraint& constraint, const ContactManifold& m, float known_load,
               const LaneInput& in) {
    // In the block, b is always dynamic. Swapping a and b negates the normal and the second tangent, and with it y and
    // the friction impulse along that tangent.
    ContactBlock& block = *at.block;
    const int lane = at.number;
    const std::uint32_t body_a = at.flipped ? constraint.body_b : constraint.body_a;
    const std::uint32_t body_b = at.flipped ? constraint.body_a : constraint.body_b;
    const float sign = at.flipped ? -1.0f : 1.0f;
    block.a[lane] = in.row_of_body[body_a];
    block.b[lane] = in.row_of_body[body_b];
    const Vec3 normal = m.normal;
    Vec3 tangent = m.tangent;
    Vec3 offset_a = at.flipped ? m.offset_b : m.offset_a, offset_b = at.flipped ? m.offset_a : m.offset_b;
    // On a rotating support the contact moves along a circle. Its place in the middle of the step gives velocities
    // along the chord, so that what lies there does not drift outwards. The slower spin is that of the support.
    const Vec3 spin_a = read(in.rows[block.a[lane]].spin), spin_b = read(in.rows[block.b[lane]].spin);
    const Vec3 spin = length_squared(spin_a) < length_squared(spin_b) ? spin_a : spin_b;
    const Vec3 half = normal * (dot(normal, spin) * 0.25f * in.settings.time_step);
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
    block.turns_a[lane] = (at.flipped ? m.b_rolls : m.a_rolls) ? 0.0f : 1.0f;
    block.turns_b[lane] = (at.flipped ? m.a_rolls : m.b_rolls) ? 0.0f : 1.0f;
    // The impulses are those of the last sub-step: scale them to the length of this one.
    const float warm = in.settings.warm_start_scale;
    const float each = known_load / static_cast<float>(m.count);
    block.known_load[lane] = known_part * each;
    // A new contact starts with what it is known to bear, so that its stack does not first give way.
    bool is_new = constraint.began;
    for (int i = 0; i < m.count; ++i) is_new &= m.impulse[i] == 0;
    for (int i = 0; i < 4; ++i) {
        const bool present = i < m.count;
        block.x[i][lane] = present ? m.x[i] : 0;
        block.y[i][lane] = present ? m.y[i] * sign : 0;
        block.separation[i][lane] = present ? m.separation[i] : absent_separation;
        block.impulse[i][lane] = !present ? 0 : is_new ? each : m.impulse[i] * warm;
        block.total[i][lane] = 0;
        block.point_mass[i][lane] = present ? 1.0f : 0.0f;  // prepare_points() replaces it by the mass
    }
    block.friction_impulse[0][lane] = m.friction_impulse[0] * warm;
    block.friction_impulse[1][lane] = m.friction_impulse[1] * (warm * sign);
    block.twist_impulse[lane] = m.twist_impulse * warm;
    for (auto& row : block.change) row[lane] = 0;
    block.friction[lane] = m.friction;
    block.restitution[lane] = m.restitution;
    block.impact[lane] = 0;
    block.closing[lane] = 0;
    if (m.restitution > 0) {
        const SolverMotion& ma = in.motions[block.a[lane]];
        const SolverMotion& mb = in.motions[block.b[lane]];
        block.closing[lane] = dot(normal * sign, ma.velocity_step - mb.velocity_step);
    }
}

ContactResult store_lane(const Lane& at, const Constraint& constraint, ContactManifold& m, const SolverBody& row_a,
                         const LaneInput& in) {
    const ContactBlock& block = *at.block;
    const int lane = at.number;
    m.friction_impulse[0] = block.friction_impulse[0][lane];
    m.friction_impulse[1] = block.friction_impulse[1][lane] * (at.flipped ? -1.0f : 1.0f);
    m.twist_impulse = block.twist_impulse[lane];
    ContactResult result;
    int hardest = 0;
    for (int i = 0; i < m.count; ++i) {
        m.impulse[i] = block.impulse[i][lane];
        m.total_impulse[i] = block.total[i][lane];
        if (!(m.total_impulse[i] > 0)) continue;
        result.pushes = true;
        result.impulse += m.total_impulse[i];
        result.approach = std::max(result.approach, block.approach[i][lane]);
        if (m.total_impulse[i] > m.total_impulse[hardest]) hardest = i;
    }
    if (result.pushes && result.approach > in.settings.restitution_threshold)
        result.hit_offset_a = hit_offset(m, hardest, block.approach[hardest][lane], constraint, in) - read(row_a.moved);
    result.nearest = absent_separation;
    for (int i = 0; i < m.count; ++i) {
        m.separation[i] = block.separation[i][lane] + block.change[0][lane] + block.x[i][lane] * block.change[1][lane] +
                          block.y[i][lane] * block.change[2][lane];
        result.nearest = std::min(result.nearest, m.separation[i]);
    }
    return result;
}

}  // namespace fase::dynamics
