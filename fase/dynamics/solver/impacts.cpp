/// Impacts: collects what touches in a sub-step, solves it together, corrects the paths.
#include "fase/dynamics/solver/impacts.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fase/dynamics/solver/rows.hpp"

namespace fase::dynamics {
namespace {

// Points that are this much farther than the first one to touch still belong to the same impact: the corners of a box
// that lands flat, whose gaps differ by rounding.
constexpr float same_moment = 0.001f;  // m
constexpr std::size_t few_hits = 64;
constexpr int sweeps_of_few = 200, sweeps_of_many = 16, sweeps_of_manifold = 8;
constexpr float converged = 1e-6f;  // of the fastest approach

Vec3 inverse_mass(const ImpactInput& in, std::uint32_t row) {
    return {in.masses[row].inverse_mass_x, in.masses[row].inverse_mass_y, in.bodies[row].inverse_mass_z};
}
Vec3 velocity_at(const SolverBody& body, Vec3 offset) { return read(body.velocity) + cross(read(body.spin), offset); }

/// Applies an impulse at an offset from the centre of mass.
void apply(const ImpactInput& in, std::uint32_t row, Vec3 impulse, Vec3 offset) {
    SolverBody& body = in.bodies[row];
    write(body.velocity, read(body.velocity) + multiply(inverse_mass(in, row), impulse));
    write(body.spin, read(body.spin) + times(in.masses[row].inertia, cross(offset, impulse)));
}
/// Whether the body reacts to impulses. Rows of static and kinematic bodies are shared or must keep their velocity.
bool reacts(const ImpactInput& in, std::uint32_t row) { return in.motions[row].is_dynamic; }

}  // namespace

float Impacts::normal_speed(const ImpactInput& in, const Hit& hit, const Point& point) {
    return dot(hit.normal, velocity_at(in.bodies[hit.b], point.b) - velocity_at(in.bodies[hit.a], point.a));
}

bool Impacts::add_points(Hit& hit, const ImpactInput& in) const {
    const ContactBlock& k = *hit.block;
    const int lane = hit.lane;
    const SolverBody &a = in.bodies[hit.a], &b = in.bodies[hit.b];
    const float h = in.sub_step, acceleration = k.closing[lane] / h;
    const Vec3 moved = read(b.moved) - read(a.moved);
    const Vec3 turn_a = inverse_rotation_delta(read(a.rotated), k.turns_a[lane], hit.normal);
    const Vec3 turn_b = inverse_rotation_delta(read(b.rotated), k.turns_b[lane], hit.normal);
    float first = same_moment + h * 1e6f;
    Point points[4];
    int count = 0;
    bool any = false;
    for (int i = 0; i < 4; ++i) {
        if (!(k.point_mass[i][lane] > 0)) continue;
        Point& point = points[count];
        const Vec3 shift = hit.tangent * k.x[i][lane] + hit.second * k.y[i][lane];
        point.a = hit.centre_a + shift;
        point.b = hit.centre_b + shift;
        point.mass = k.point_mass[i][lane];
        point.index = i;
        const float separation =
            k.separation[i][lane] + dot(hit.normal, moved) + dot(turn_b, point.b) - dot(turn_a, point.a);
        const float gap = std::max(separation, 0.0f);
        // The speed before the forces of this sub-step; the speed at touch follows from the work along the gap.
        const float before = dot(hit.normal, velocity_at(a, point.a) - velocity_at(b, point.b)) - k.closing[lane];
        const float reach = (before + k.closing[lane]) * h;
        if (!(before > 0) || !(reach + same_moment > gap)) continue;
        point.approach = std::sqrt(std::max(before * before + 2 * acceleration * gap, 0.0f));
        if (!(point.approach > in.threshold)) continue;
        any |= reach > gap;
        point.time = std::min(2 * gap / (before + point.approach), h);
        // After the bounce the forces act for the rest of the sub-step.
        point.target = k.restitution[lane] * point.approach - acceleration * (h - point.time);
        first = std::min(first, gap);
        point.impulse = gap;  // until the points are chosen
        ++count;
    }
    if (!any) return false;
    for (int i = 0; i < count; ++i) {
        if (points[i].impulse > first + same_moment) continue;
        hit.points[hit.count] = points[i];
        hit.points[hit.count++].impulse = 0;
    }
    return hit.count > 0;
}

void Impacts::gather(std::span<Colour> colours, const ImpactInput& in) {
    hits_.clear();
    for (Colour& colour : colours) {
        if (!colour.restitution) continue;
        for (ContactBlock& block : colour.blocks)
            for (int lane = 0; lane < block_lanes; ++lane) {
                if (!(block.impact[lane] > 0)) continue;
                Hit hit{};
                hit.block = &block;
                hit.lane = lane;
                hit.a = block.a[lane];
                hit.b = block.b[lane];
                hit.normal = read(block.normal, lane);
                hit.tangent = read(block.tangent, lane);
                hit.second = cross(hit.normal, hit.tangent);
                hit.centre_a = read(block.offset_a, lane);
                hit.centre_b = read(block.offset_b, lane);
                for (int i = 0; i < 3; ++i) hit.friction_mass[i] = block.friction_mass[i][lane];
                hit.friction = block.friction[lane];
                if (add_points(hit, in)) hits_.push_back(hit);
            }
    }
    touched_.clear();
    for (const Hit& hit : hits_)
        for (const std::uint32_t row : {hit.a, hit.b})
            if (reacts(in, row))
                touched_.push_back({row, read(in.bodies[row].velocity), read(in.bodies[row].spin), {}, {}});
    std::sort(touched_.begin(), touched_.end(), [](const Touched& x, const Touched& y) { return x.row < y.row; });
    touched_.erase(std::unique(touched_.begin(), touched_.end(),
                               [](const Touched& x, const Touched& y) { return x.row == y.row; }),
                   touched_.end());
}

void Impacts::push(const ImpactInput& in, const Hit& hit, Vec3 impulse, Vec3 a, Vec3 b) {
    if (reacts(in, hit.a)) apply(in, hit.a, -impulse, a);
    if (reacts(in, hit.b)) apply(in, hit.b, impulse, b);
}

void Impacts::solve_common(const ImpactInput& in, Hit& hit) {
    float mean = 0, mass = 0;
    Vec3 a, b;
    for (int i = 0; i < hit.count; ++i) {
        const Point& p = hit.points[i];
        mean += p.target - normal_speed(in, hit, p);
        a += p.a;
        b += p.b;
    }
    const float share = 1 / static_cast<float>(hit.count);
    a *= share;
    b *= share;
    for (const auto& [row, offset] : {std::pair{hit.a, a}, std::pair{hit.b, b}}) {
        if (!reacts(in, row)) continue;
        const Vec3 lever = cross(offset, hit.normal);
        mass += dot(hit.normal, multiply(inverse_mass(in, row), hit.normal)) +
                dot(lever, times(in.masses[row].inertia, lever));
    }
    const float impulse = mass > 0 ? std::max(mean * share / mass, 0.0f) : 0.0f;
    for (int i = 0; i < hit.count; ++i) hit.points[i].impulse = impulse * share;
    push(in, hit, hit.normal * impulse, a, b);
}

float Impacts::solve_point(const ImpactInput& in, const Hit& hit, Point& point) {
    const float next = std::max(point.impulse - point.mass * (normal_speed(in, hit, point) - point.target), 0.0f);
    const float change = next - point.impulse;
    point.impulse = next;
    push(in, hit, hit.normal * change, point.a, point.b);
    return std::abs(change) / point.mass;
}

void Impacts::solve_friction(const ImpactInput& in, Hit& hit) {
    float load = 0;
    for (int i = 0; i < hit.count; ++i) load += hit.points[i].impulse;
    const Vec3 slip = velocity_at(in.bodies[hit.b], hit.centre_b) - velocity_at(in.bodies[hit.a], hit.centre_a);
    const float u1 = dot(slip, hit.tangent), u2 = dot(slip, hit.second);
    float next1 = hit.friction_impulse[0] - (hit.friction_mass[0] * u1 + hit.friction_mass[1] * u2);
    float next2 = hit.friction_impulse[1] - (hit.friction_mass[1] * u1 + hit.friction_mass[2] * u2);
    const float limit = hit.friction * load, squared = next1 * next1 + next2 * next2;
    if (squared > limit * limit) {
        const float shrink = limit / std::sqrt(squared);
        next1 *= shrink;
        next2 *= shrink;
    }
    const Vec3 impulse =
        hit.tangent * (next1 - hit.friction_impulse[0]) + hit.second * (next2 - hit.friction_impulse[1]);
    hit.friction_impulse[0] = next1;
    hit.friction_impulse[1] = next2;
    push(in, hit, impulse, hit.centre_a, hit.centre_b);
}

void Impacts::iterate(const ImpactInput& in, bool with_friction) {
    float fastest = 0;
    for (Hit& hit : hits_) {
        hit.friction_impulse[0] = hit.friction_impulse[1] = 0;
        for (int i = 0; i < hit.count; ++i) {
            hit.points[i].impulse = 0;
            fastest = std::max(fastest, hit.points[i].approach);
        }
    }
    const int sweeps = hits_.size() <= few_hits ? sweeps_of_few : sweeps_of_many;
    for (int sweep = 0; sweep < sweeps; ++sweep) {
        float change = 0;
        for (Hit& hit : hits_) {
            if (sweep == 0) solve_common(in, hit);
            const int repeats = hit.count > 1 ? sweeps_of_manifold : 1;
            for (int r = 0; r < repeats; ++r) {
                float here = 0;
                for (int i = 0; i < hit.count; ++i) here = std::max(here, solve_point(in, hit, hit.points[i]));
                if (r == 0) change = std::max(change, here);
                if (!(here > converged * fastest)) break;
            }
            if (with_friction && hit.friction > 0) solve_friction(in, hit);
        }
        // The first sweep starts from common impulses, after which no point misses its target by itself.
        if (sweep > 0 && !(change > converged * fastest)) break;
    }
}

std::vector<Impacts::Touched>::iterator Impacts::find_touched(std::uint32_t row) {
    return std::lower_bound(touched_.begin(), touched_.end(), row,
                            [](const Touched& t, std::uint32_t r) { return t.row < r; });
}

double Impacts::added_energy(const ImpactInput& in) {
    // The work of an impulse: impulse times the mean of the velocities before and after. `before` is the start of the
    // round, which `touched_` keeps.
    const auto velocity_before = [&](std::uint32_t row, Vec3 offset) {
        if (!reacts(in, row)) return velocity_at(in.bodies[row], offset);
        const Touched& body = *find_touched(row);
        return body.velocity + cross(body.spin, offset);
    };
    double energy = 0;
    for (const Hit& hit : hits_) {
        const auto work = [&](Vec3 impulse, Vec3 a, Vec3 b) {
            const Vec3 sum = velocity_before(hit.b, b) - velocity_before(hit.a, a) + velocity_at(in.bodies[hit.b], b) -
                             velocity_at(in.bodies[hit.a], a);
            return 0.5 * static_cast<double>(dot(impulse, sum));
        };
        for (int i = 0; i < hit.count; ++i) {
            const Point& p = hit.points[i];
            energy += work(hit.normal * p.impulse, p.a, p.b);
        }
        energy += work(hit.tangent * hit.friction_impulse[0] + hit.second * hit.friction_impulse[1], hit.centre_a,
                       hit.centre_b);
    }
    return energy;
}

void Impacts::restore_velocities(const ImpactInput& in) {
    for (const Touched& t : touched_) {
        write(in.bodies[t.row].velocity, t.velocity);
        write(in.bodies[t.row].spin, t.spin);
    }
}

void Impacts::finish(const ImpactInput& in) {
    for (const Touched& t : touched_) {
        SolverMotion& motion = in.motions[t.row];
        const Vec3 velocity = read(in.bodies[t.row].velocity), spin = read(in.bodies[t.row].spin);
        // The change counts as free motion: contacts do not apply it again in the next sub-step.
        motion.velocity_before += velocity - t.velocity;
        motion.free_velocity =
            motion.free_velocity == t.velocity ? velocity : motion.free_velocity + (velocity - t.velocity);
        motion.free_spin = motion.free_spin == t.spin ? spin : motion.free_spin + (spin - t.spin);
    }
    for (Hit& hit : hits_) {
        ContactBlock& k = *hit.block;
        float time = 0, load = 0;
        const auto delay = [&](std::uint32_t row, Vec3 impulse, Vec3 offset, float seconds) {
            if (!reacts(in, row)) return;
            // One sum per body: rotations by the impulses of single points would not commute.
            Touched& body = *find_touched(row);
            body.moved -= multiply(inverse_mass(in, row), impulse) * seconds;
            body.rotated -= times(in.masses[row].inertia, cross(offset, impulse)) * seconds;
        };
        for (int i = 0; i < hit.count; ++i) {
            const Point& p = hit.points[i];
            k.total[p.index][hit.lane] += p.impulse;
            k.approach[p.index][hit.lane] = std::max(k.approach[p.index][hit.lane], p.approach);
            delay(hit.a, hit.normal * -p.impulse, p.a, p.time);
            delay(hit.b, hit.normal * p.impulse, p.b, p.time);
            load += p.impulse;
            time += p.impulse * p.time;
        }
        if (!(load > 0)) continue;
        const Vec3 friction = hit.tangent * hit.friction_impulse[0] + hit.second * hit.friction_impulse[1];
        delay(hit.a, friction * -1.0f, hit.centre_a, time / load);
        delay(hit.b, friction, hit.centre_b, time / load);
    }
    for (const Touched& body : touched_) delays_.push_back({body.row, body.moved, body.rotated});
}

void Impacts::correct_paths(std::span<SolverBody> bodies, std::span<SolverMotion> motions) {
    for (const Delay& delay : delays_) {
        SolverBody& body = bodies[delay.row];
        write(body.moved, read(body.moved) + delay.moved);
        write(body.rotated, read(body.rotated) + delay.rotated);
        const Vec3 t = delay.rotated * 0.5f;
        if (length_squared(t) > 0)
            motions[delay.row].turned = normalized(Quat{t.x, t.y, t.z, 1} * motions[delay.row].turned);
    }
    delays_.clear();
}

bool Impacts::solve_round(std::span<Colour> colours, const ImpactInput& in) {
    gather(colours, in);
    if (hits_.empty()) return false;
    iterate(in, true);
    if (added_energy(in) > 0) {
        bool friction = false;
        for (const Hit& hit : hits_) friction |= hit.friction_impulse[0] != 0 || hit.friction_impulse[1] != 0;
        if (friction) {
            restore_velocities(in);
            iterate(in, false);
        }
    }
    finish(in);
    return true;
}

}  // namespace fase::dynamics
