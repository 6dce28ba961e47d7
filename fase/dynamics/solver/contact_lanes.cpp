/// Contacts into lanes of the solver's blocks, and back.
#include "fase/dynamics/solver/contact_lanes.hpp"

#include <algorithm>
#include <array>
#include <cstring>

#include "fase/dynamics/solver/rows.hpp"
#include "fase/math/detail/float4.hpp"

namespace fase::dynamics {
namespace {

constexpr float absent_separation = 1e9f;  // separation of an absent point

// The square of half the radians of a turn, below which what lies on it drifts by far less than a micrometre per step.
constexpr float min_turn = 1e-9f;

// The share of a known load that the spring need not bear. The rest damps: at 1, towers fall.
constexpr float known_part = 0.96f;

/// Where the surfaces met at a point, from the centre of mass of a at the beginning of the step: on the surface of the
/// smaller body, moved with it until the touch. Bodies keep their velocity of the beginning of the step until then.
Vec3 hit_offset(const ContactManifold& m, int point, float separation, float approach, const Constraint& constraint,
                const LaneInput& in) {
    const Vec3 shift = m.tangent * m.x[point] + cross(m.normal, m.tangent) * m.y[point];
    const float half_gap = 0.5f * separation, step = in.settings.time_step;
    const float seconds = std::clamp(separation / std::max(approach, 1e-6f), -step, step);
    const BodyMotion& a = in.bodies.motion[constraint.body_a];
    const BodyMotion& b = in.bodies.motion[constraint.body_b];
    const Vec3 b_from_a = m.offset_a - m.offset_b;
    const Vec3 on_a = m.offset_a + shift - m.normal * half_gap + a.linear_velocity * seconds;
    const Vec3 on_b = m.offset_b + shift + m.normal * half_gap + b.linear_velocity * seconds + b_from_a;
    return in.bodies.traits[constraint.body_a].reach < in.bodies.traits[constraint.body_b].reach ? on_a : on_b;
}

/// The same at the hardest point of a lane, from the centre of mass of a at the end of the step.
Vec3 hit_place(const ContactBlock& block, int lane, const ContactManifold& m, const Constraint& constraint,
               const LaneInput& in) {
    int hardest = 0;
    for (int i = 1; i < m.count; ++i)
        if (m.total_impulse[i] > m.total_impulse[hardest]) hardest = i;
    return hit_offset(m, hardest, block.separation[hardest][lane], block.approach[hardest][lane], constraint, in) -
           read(in.rows[in.row_of_body[constraint.body_a]].moved);
}

using detail::any;
using detail::Float4;
using detail::load_four;
using detail::select;
using detail::store_four;
using Vec3x4 = Vec3Of<Float4>;

/// What the four contacts of fill_four() read of their manifolds.
struct FourManifolds {
    Vec3x4 normal, tangent, offset_a, offset_b;
    Float4 count;
    std::array<Float4, 4> x, y, separation, impulse;

    explicit FourManifolds(const ContactManifold* const (&m)[4]) {
        const auto part = [&](auto field, int at) { return load_four([&](int k) { return &(m[k]->*field).x + at; }); };
        const auto [nx, ny, nz, unused] = part(&ContactManifold::normal, 0);
        // Tangent and offsets follow each other.
        const auto [tx, ty, tz, ax] = part(&ContactManifold::tangent, 0);
        const auto [ay, az, bx, by] = part(&ContactManifold::tangent, 4);
        normal = {nx, ny, nz};
        tangent = {tx, ty, tz};
        offset_a = {ax, ay, az};
        offset_b = {bx, by, Float4::Lanes{m[0]->offset_b.z, m[1]->offset_b.z, m[2]->offset_b.z, m[3]->offset_b.z}};
        count = Float4::Lanes{static_cast<float>(m[0]->count), static_cast<float>(m[1]->count),
                              static_cast<float>(m[2]->count), static_cast<float>(m[3]->count)};
        x = load_four([&](int k) { return m[k]->x; });
        y = load_four([&](int k) { return m[k]->y; });
        separation = load_four([&](int k) { return m[k]->separation; });
        impulse = load_four([&](int k) { return m[k]->impulse; });
    }
};

template <class F> Float4 lanes_of(const F& value) { return Float4::Lanes{value(0), value(1), value(2), value(3)}; }
void store(float (*rows)[block_lanes], int lane, const Vec3x4& v) {
    v.x.store(rows[0] + lane);
    v.y.store(rows[1] + lane);
    v.z.store(rows[2] + lane);
}

/// What gravity and forces add to the closing velocity of a contact that may bounce, m/s per sub-step.
float closing_of(const ContactBlock& block, int lane, Vec3 normal, const LaneInput& in) {
    return dot(normal, in.motions[block.a[lane]].velocity_step - in.motions[block.b[lane]].velocity_step);
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
    if (length_squared(half) > min_turn) {
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
    if (m.restitution > 0) block.closing[lane] = closing_of(block, lane, normal * sign, in);
}

bool fill_four(ContactBlock& block, int lane, const Constraint* const (&constraints)[4],
               const ContactManifold* const (&manifolds)[4], const bool (&flipped)[4], const float (&known_loads)[4],
               const LaneInput& in) {
    const FourManifolds m(manifolds);
    const SolverBody *a[4], *b[4];
    for (int k = 0; k < 4; ++k) {
        const std::uint32_t row_a = in.row_of_body[constraints[k]->body_a];
        const std::uint32_t row_b = in.row_of_body[constraints[k]->body_b];
        block.a[lane + k] = flipped[k] ? row_b : row_a;
        block.b[lane + k] = flipped[k] ? row_a : row_b;
        a[k] = &in.rows[block.a[lane + k]];
        b[k] = &in.rows[block.b[lane + k]];
    }
    const auto [sax, say, saz, unused_a] = load_four([&](int k) { return a[k]->spin; });
    const auto [sbx, sby, sbz, unused_b] = load_four([&](int k) { return b[k]->spin; });
    const Vec3x4 spin_a{sax, say, saz}, spin_b{sbx, sby, sbz};
    const Vec3x4 spin = select(length_squared(spin_a) < length_squared(spin_b), spin_a, spin_b);
    const Vec3x4 half = m.normal * (dot(m.normal, spin) * Float4(0.25f) * Float4(in.settings.time_step));
    if (any(Float4(min_turn) < length_squared(half))) return false;

    const Float4 zero(0.0f), one(1.0f), warm(in.settings.warm_start_scale);
    const Float4 sign = lanes_of([&](int k) { return flipped[k] ? -1.0f : 1.0f; });
    const Float4::Mask swaps = sign < zero;
    store(block.normal, lane, m.normal * sign);
    store(block.tangent, lane, m.tangent);
    store(block.offset_a, lane, select(swaps, m.offset_b, m.offset_a));
    store(block.offset_b, lane, select(swaps, m.offset_a, m.offset_b));
    const Float4 each = Float4::load(known_loads) / m.count;
    (Float4(known_part) * each).store(block.known_load + lane);
    Float4::Mask is_new = zero < lanes_of([&](int k) { return constraints[k]->began ? 1.0f : 0.0f; });
    for (std::size_t i = 0; i < 4; ++i) {
        const Float4::Mask present = Float4(static_cast<float>(i)) < m.count;
        is_new &= (m.impulse[i] == zero) | ~present;
        select(present, m.x[i], zero).store(block.x[i] + lane);
        select(present, m.y[i] * sign, zero).store(block.y[i] + lane);
        select(present, m.separation[i], absent_separation).store(block.separation[i] + lane);
        zero.store(block.total[i] + lane);
        select(present, one, zero).store(block.point_mass[i] + lane);
    }
    for (std::size_t i = 0; i < 4; ++i) {
        const Float4::Mask present = Float4(static_cast<float>(i)) < m.count;
        select(present, select(is_new, each, m.impulse[i] * warm), zero).store(block.impulse[i] + lane);
    }
    for (auto& row : block.change) zero.store(row + lane);
    zero.store(block.impact + lane);
    zero.store(block.closing + lane);
    for (int k = 0; k < 4; ++k) {
        const ContactManifold& manifold = *manifolds[k];
        const int at = lane + k;
        block.turns_a[at] = (flipped[k] ? manifold.b_rolls : manifold.a_rolls) ? 0.0f : 1.0f;
        block.turns_b[at] = (flipped[k] ? manifold.a_rolls : manifold.b_rolls) ? 0.0f : 1.0f;
        block.friction_impulse[0][at] = manifold.friction_impulse[0] * in.settings.warm_start_scale;
        block.friction_impulse[1][at] =
            manifold.friction_impulse[1] * (in.settings.warm_start_scale * (flipped[k] ? -1.0f : 1.0f));
        block.twist_impulse[at] = manifold.twist_impulse * in.settings.warm_start_scale;
        block.friction[at] = manifold.friction;
        block.restitution[at] = manifold.restitution;
        if (manifold.restitution > 0) block.closing[at] = closing_of(block, at, read(block.normal, at), in);
    }
    return true;
}

ContactResult store_lane(const Lane& at, const Constraint& constraint, ContactManifold& m, const LaneInput& in) {
    const ContactBlock& block = *at.block;
    const int lane = at.number;
    m.friction_impulse[0] = block.friction_impulse[0][lane];
    m.friction_impulse[1] = block.friction_impulse[1][lane] * (at.flipped ? -1.0f : 1.0f);
    m.twist_impulse = block.twist_impulse[lane];
    ContactResult result;
    for (int i = 0; i < m.count; ++i) {
        m.impulse[i] = block.impulse[i][lane];
        m.total_impulse[i] = block.total[i][lane];
        if (!(m.total_impulse[i] > 0)) continue;
        result.pushes = true;
        result.impulse += m.total_impulse[i];
        result.approach = std::max(result.approach, block.approach[i][lane]);
    }
    result.nearest = absent_separation;
    for (int i = 0; i < m.count; ++i) {
        m.separation[i] = block.separation[i][lane] + block.change[0][lane] + block.x[i][lane] * block.change[1][lane] +
                          block.y[i][lane] * block.change[2][lane];
        result.nearest = std::min(result.nearest, m.separation[i]);
    }
    if (result.pushes && result.approach > in.settings.restitution_threshold)
        result.hit_offset_a = hit_place(block, lane, m, constraint, in);
    return result;
}

void store_four_lanes(const ContactBlock& block, int lane, const Constraint* const (&constraints)[4],
                      ContactManifold* const (&manifolds)[4], const bool (&flipped)[4],
                      ContactResult* const (&results)[4], const LaneInput& in) {
    const auto row = [&](const float* values) { return Float4::load(values + lane); };
    const Float4 zero(0.0f), far(absent_separation);
    const Float4 count = lanes_of([&](int k) { return static_cast<float>(manifolds[k]->count); });
    const auto before = load_four([&](int k) { return manifolds[k]->separation; });
    const Float4 centre = row(block.change[0]), slope_x = row(block.change[1]), slope_y = row(block.change[2]);
    Float4 sum = zero, approach = zero, nearest = far, separation[4];
    for (std::size_t i = 0; i < 4; ++i) {
        const Float4::Mask present = Float4(static_cast<float>(i)) < count;
        const Float4 total = row(block.total[i]);
        const Float4::Mask pushes = present & (zero < total);
        sum = sum + select(pushes, total, zero);
        const Float4 speed = select(pushes, row(block.approach[i]), zero);
        approach = select(approach < speed, speed, approach);
        const Float4 now = row(block.separation[i]) + centre + row(block.x[i]) * slope_x + row(block.y[i]) * slope_y;
        separation[i] = select(present, now, before[i]);
        nearest = select(present & (now < nearest), now, nearest);
    }
    const auto store_rows = [&](const float(*rows)[block_lanes], auto field) {
        store_four(row(rows[0]), row(rows[1]), row(rows[2]), row(rows[3]), [&](int k) { return manifolds[k]->*field; });
    };
    store_rows(block.impulse, &ContactManifold::impulse);
    store_rows(block.total, &ContactManifold::total_impulse);
    store_four(separation[0], separation[1], separation[2], separation[3],
               [&](int k) { return manifolds[k]->separation; });
    for (int k = 0; k < 4; ++k) {
        const int at = lane + k;
        ContactManifold& m = *manifolds[k];
        m.friction_impulse[0] = block.friction_impulse[0][at];
        m.friction_impulse[1] = block.friction_impulse[1][at] * (flipped[k] ? -1.0f : 1.0f);
        m.twist_impulse = block.twist_impulse[at];
        ContactResult& result = *results[k];
        result = {nearest.v[k], approach.v[k], sum.v[k], sum.v[k] > 0, {}};
        if (result.pushes && result.approach > in.settings.restitution_threshold)
            result.hit_offset_a = hit_place(block, at, m, *constraints[k], in);
    }
}

}  // namespace fase::dynamics
