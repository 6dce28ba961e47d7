/// Integrates velocities and poses: four bodies at a time where nothing special happens to any of them, else one.
#include "fase/dynamics/solver/integrate.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <type_traits>

#include "fase/dynamics/solver/rows.hpp"
#include "fase/math/detail/double4.hpp"
#include "fase/math/detail/float4.hpp"

namespace fase::dynamics {

using detail::any;
using detail::Double4;
using detail::Float4;
using detail::load_four;
using detail::select;
using detail::store_four;

namespace {

constexpr float max_part = 0.25f;        // radians of a torque-free rotation that are integrated at once
constexpr float min_gyroscopic = 1e-8f;  // square of the radians per sub-step, above which unequal moments matter

Vec3 without_locked(Vec3 v, unsigned locks) { return {locks & 1 ? 0 : v.x, locks & 2 ? 0 : v.y, locks & 4 ? 0 : v.z}; }
/// Returns v, scaled to length `max` when it is longer. A NaN or infinite v is returned unchanged; finish() handles it.
Vec3 clamp_length(Vec3 v, float max, bool& clamped) {
    const float squared = length_squared(v);
    if (!(squared > max * max)) return v;
    clamped = true;
    return v * (max / std::sqrt(squared));
}

double select(bool condition, double yes, double no) { return condition ? yes : no; }

template <class T> T tangent_of(T x) {
    const T a = select(x < T(0), -x, x);
    const T clamped = select(a < T(1), a, T(1));
    const T squared = clamped * clamped;
    const T tangent = clamped * (T(15) - squared) / (T(15) - T(6) * squared) + (a - clamped) * T(3.4);
    return select(x < T(0), -tangent, tangent);
}

/// Rotates the momentum about principal axis i by the rotation of the body in `h` seconds, and appends that rotation to
/// `turn`. T: double, or a vector of doubles for as many bodies, whose moments are above 0.
template <int i, class T> void rotate_about_axis(QuatOf<T>& turn, Vec3Of<T>& momentum, const Vec3Of<T>& moments, T h) {
    constexpr int j = (i + 1) % 3, k = (i + 2) % 3;
    if constexpr (std::is_same_v<T, double>)
        if (!(moments[i] > 0)) return;
    const T t = tangent_of(T(0.5) * h * (momentum[i] / moments[i]));
    const T scale = T(1) / (T(1) + t * t), c = (T(1) - t * t) * scale, s = T(2) * t * scale;
    const T mj = momentum[j], mk = momentum[k];
    momentum[j] = c * mj + s * mk;
    momentum[k] = c * mk - s * mj;
    QuatOf<T> q{T(0), T(0), T(0), T(1)};
    (i == 0 ? q.x : i == 1 ? q.y : q.z) = t;
    turn = turn * q;
}

template <class T> void rotate_about_all_axes(QuatOf<T>& rotation, Vec3Of<T>& momentum, const Vec3Of<T>& moments, T h) {
    QuatOf<T> turn{T(0), T(0), T(0), T(1)};
    const T half = T(0.5) * h;
    rotate_about_axis<0>(turn, momentum, moments, half);
    rotate_about_axis<1>(turn, momentum, moments, half);
    rotate_about_axis<2>(turn, momentum, moments, h);
    rotate_about_axis<1>(turn, momentum, moments, half);
    rotate_about_axis<0>(turn, momentum, moments, half);
    rotation = normalized(rotation * turn);
}

void integrate_velocity(SolverBody& body, SolverMotion& motion, bool warm_start, SpeedLimits limits) {
    if (!motion.is_dynamic) return;
    Vec3 velocity = read(body.velocity), spin = read(body.spin);
    motion.velocity_before = without_locked(velocity, motion.locks);
    Vec3 pushed, turned;
    if (warm_start) {
        pushed = velocity - motion.free_velocity;
        turned = spin - motion.free_spin;
    }
    velocity = without_locked((velocity + motion.velocity_step) * motion.linear_factor, motion.locks);
    spin = without_locked((spin + motion.spin_step) * motion.angular_factor, motion.locks >> 3);
    velocity = clamp_length(velocity, limits.linear, motion.clamped);
    spin = clamp_length(spin, limits.angular, motion.clamped);
    motion.free_velocity = velocity;
    motion.free_spin = spin;
    write(body.velocity, velocity + pushed);
    write(body.spin, spin + turned);
}

/// Integrates the pose of a body. Returns true when unequal moments matter: rotate_freely() must do its rotation.
[[nodiscard]] bool integrate_pose(SolverBody& body, SolverMotion& motion, float h) {
    const Vec3 velocity = read(body.velocity), spin = read(body.spin);
    const bool free = motion.is_dynamic && velocity == motion.free_velocity;
    const Vec3 mean = free ? (velocity + motion.velocity_before) * 0.5f : velocity;
    write(body.moved, read(body.moved) + mean * h);
    write(body.rotated, read(body.rotated) + spin * h);
    const float fast = length_squared(spin) * h * h;
    if (motion.gyroscopic && fast > min_gyroscopic) return true;
    if (!(fast > 0)) return false;
    // tan(angle / 2) / angle, so that the normalised quaternion has the exact angle.
    const float x = 0.25f * fast;
    const float scale = x < 1 ? 0.5f * (15 - x) / (15 - 6 * x) : 0.78f;
    const Vec3 t = spin * (h * scale);
    motion.turned = normalized(Quat{t.x, t.y, t.z, 1} * motion.turned);
    return false;
}

/// Whether a body rotates by more than max_part in a sub-step.
bool turns_far(Vec3 spin, float h) { return length_squared(spin) * h * h > max_part * max_part; }

void rotate_freely(SolverBody& body, SolverMotion& motion, float h) {
    const Vec3 spin = read(body.spin);
    const Quatd start = normalized(to_double(motion.rotation));
    const Vec3d moments = to_double(motion.moments);
    Quatd rotation = normalized(to_double(motion.turned) * start);
    Vec3d momentum = multiply(rotate_back(rotation, to_double(spin)), moments);
    // The splitting conserves the energy only while the angles of its parts are small.
    const int count = turns_far(spin, h) ? 1 + static_cast<int>(std::min(length(spin) * h / max_part, 63.0f)) : 1;
    for (int i = 0; i < count; ++i) rotate_about_all_axes(rotation, momentum, moments, static_cast<double>(h) / count);
    const Vec3d principal{momentum.x / moments.x, momentum.y / moments.y, momentum.z / moments.z};
    const Vec3 after = to_float(rotate(rotation, principal));
    motion.free_spin += after - spin;
    write(body.spin, after);
    motion.turned = to_float(normalized(rotation * conjugate(start)));
}

// The same for four bodies, in the same order of operations.

/// Loads a vector, and the float after it, of four objects.
template <class F> Vec3Of<Float4> load_vectors(const F& from, Float4& after) {
    const auto [x, y, z, w] = load_four(from);
    after = w;
    return {x, y, z};
}
template <class F> void store_vectors(Vec3Of<Float4> v, Float4 after, const F& to) {
    store_four(v.x, v.y, v.z, after, to);
}

/// Whether nothing but forces and damping changes the velocities: the speed limits are far.
bool integrate_four_velocities(SolverBody* bodies, SolverMotion* motions, bool warm_start, SpeedLimits limits) {
    for (int k = 0; k < 4; ++k)
        if (!motions[k].is_dynamic || motions[k].locks != 0) return false;
    Float4 mass, unused, linear_factor, angular_factor;
    const Vec3Of<Float4> before = load_vectors([&](int k) { return bodies[k].velocity; }, mass);
    const Vec3Of<Float4> spin_before = load_vectors([&](int k) { return bodies[k].spin; }, unused);
    const Vec3Of<Float4> step = load_vectors([&](int k) { return &motions[k].velocity_step.x; }, linear_factor);
    const Vec3Of<Float4> spin_step = load_vectors([&](int k) { return &motions[k].spin_step.x; }, angular_factor);
    const Vec3Of<Float4> velocity = (before + step) * linear_factor, spin = (spin_before + spin_step) * angular_factor;
    const Float4 max_linear = limits.linear * limits.linear, max_angular = limits.angular * limits.angular;
    if (any((max_linear < length_squared(velocity)) | (max_angular < length_squared(spin)))) return false;
    Vec3Of<Float4> pushed, turned;
    if (warm_start) {
        Float4 rest;
        pushed = before - load_vectors([&](int k) { return &motions[k].free_velocity.x; }, rest);
        turned = spin_before - load_vectors([&](int k) { return &motions[k].free_spin.x; }, rest);
    }
    store_vectors(before, Float4(), [&](int k) { return &motions[k].velocity_before.x; });
    store_vectors(velocity, Float4(), [&](int k) { return &motions[k].free_velocity.x; });
    store_vectors(spin, Float4(), [&](int k) { return &motions[k].free_spin.x; });
    store_vectors(velocity + pushed, mass, [&](int k) { return bodies[k].velocity; });
    store_vectors(spin + turned, unused, [&](int k) { return bodies[k].spin; });
    return true;
}

/// Returns a bit for each body whose rotation rotate_four_freely() must do.
[[nodiscard]] unsigned integrate_four_poses(SolverBody* bodies, SolverMotion* motions, float h) {
    Float4 unused;
    const Vec3Of<Float4> velocity = load_vectors([&](int k) { return bodies[k].velocity; }, unused);
    const Vec3Of<Float4> spin = load_vectors([&](int k) { return bodies[k].spin; }, unused);
    const Float4 fast = length_squared(spin) * h * h;
    Float4::Mask turns = Float4(0.0f) < fast, is_dynamic;
    unsigned rotate_freely = 0;
    for (int k = 0; k < 4; ++k) {
        is_dynamic[k] = motions[k].is_dynamic ? -1 : 0;
        if (!(motions[k].gyroscopic && fast.v[k] > min_gyroscopic)) continue;
        rotate_freely |= 1u << k;
        turns[k] = 0;
    }
    const Vec3Of<Float4> free = load_vectors([&](int k) { return &motions[k].free_velocity.x; }, unused);
    const Vec3Of<Float4> before = load_vectors([&](int k) { return &motions[k].velocity_before.x; }, unused);
    const Float4::Mask is_free = is_dynamic & (velocity.x == free.x) & (velocity.y == free.y) & (velocity.z == free.z);
    const Vec3Of<Float4> mean = (velocity + before) * Float4(0.5f);
    const Vec3Of<Float4> by = select(is_free, mean, velocity);
    const Vec3Of<Float4> moved = load_vectors([&](int k) { return bodies[k].moved; }, unused) + by * Float4(h);
    store_vectors(moved, unused, [&](int k) { return bodies[k].moved; });
    const Vec3Of<Float4> rotated = load_vectors([&](int k) { return bodies[k].rotated; }, unused) + spin * Float4(h);
    store_vectors(rotated, unused, [&](int k) { return bodies[k].rotated; });
    if (!any(turns)) return rotate_freely;
    const auto [x, y, z, w] = load_four([&](int k) { return &motions[k].turned.x; });
    const Float4 share = Float4(0.25f) * fast;
    const Float4 scale =
        select(share < Float4(1.0f), Float4(0.5f) * (Float4(15.0f) - share) / (Float4(15.0f) - Float4(6.0f) * share),
               Float4(0.78f));
    const Vec3Of<Float4> t = spin * (Float4(h) * scale);
    const QuatOf<Float4> q = normalized(QuatOf<Float4>{t.x, t.y, t.z, Float4(1.0f)} * QuatOf<Float4>{x, y, z, w});
    store_four(select(turns, q.x, x), select(turns, q.y, y), select(turns, q.z, z), select(turns, q.w, w),
               [&](int k) { return &motions[k].turned.x; });
    return rotate_freely;
}

/// Bodies that wait for rotate_freely(), which takes four at a time.
class FreeRotations {
public:
    FreeRotations(std::span<SolverBody> bodies, std::span<SolverMotion> motions, float h)
        : bodies_(bodies), motions_(motions), h_(h) {}
    void add(std::size_t body) {
        if (turns_far(read(bodies_[body].spin), h_)) return rotate_freely(bodies_[body], motions_[body], h_);
        waiting_[count_++] = body;
        if (count_ == 4) rotate_four();
    }
    void finish() {
        for (std::size_t k = 0; k < count_; ++k) rotate_freely(bodies_[waiting_[k]], motions_[waiting_[k]], h_);
        count_ = 0;
    }

private:
    std::span<SolverBody> bodies_;
    std::span<SolverMotion> motions_;
    float h_;
    std::size_t waiting_[4] = {}, count_ = 0;

    void rotate_four() {
        count_ = 0;
        const auto body = [&](int k) -> SolverBody& { return bodies_[waiting_[k]]; };
        const auto motion = [&](int k) -> SolverMotion& { return motions_[waiting_[k]]; };
        const auto quat = [](const std::array<Float4, 4>& q) {
            return to_double(QuatOf<Float4>{q[0], q[1], q[2], q[3]});
        };
        Float4 after_spin, after_free, unused;
        const Vec3Of<Float4> spin = load_vectors([&](int k) { return body(k).spin; }, after_spin);
        const Vec3Of<Float4> free = load_vectors([&](int k) { return &motion(k).free_spin.x; }, after_free);
        const Vec3Of<Double4> moments = to_double(load_vectors([&](int k) { return &motion(k).moments.x; }, unused));
        const QuatOf<Double4> start = normalized(quat(load_four([&](int k) { return &motion(k).rotation.x; })));
        const QuatOf<Double4> turned = quat(load_four([&](int k) { return &motion(k).turned.x; }));
        QuatOf<Double4> rotation = normalized(turned * start);
        Vec3Of<Double4> momentum = multiply(rotate_back(rotation, to_double(spin)), moments);
        rotate_about_all_axes(rotation, momentum, moments, Double4(static_cast<double>(h_)));
        const Vec3Of<Double4> principal{momentum.x / moments.x, momentum.y / moments.y, momentum.z / moments.z};
        const Vec3Of<Float4> after = to_float(rotate(rotation, principal));
        store_vectors(free + (after - spin), after_free, [&](int k) { return &motion(k).free_spin.x; });
        store_vectors(after, after_spin, [&](int k) { return body(k).spin; });
        const auto [x, y, z, w] = to_float(normalized(rotation * conjugate(start)));
        store_four(x, y, z, w, [&](int k) { return &motion(k).turned.x; });
    }
};

}  // namespace

InertiaTurn inertia_turn(const SolverMotion& motion, Vec3 rotation) {
    const Vec3 about = rotate_back(motion.turned * motion.rotation, rotation), i = motion.moments;
    const auto turn = [&](const auto& differ) {
        return length(Vec3{about.x * differ(i.y, i.z), about.y * differ(i.z, i.x), about.z * differ(i.x, i.y)});
    };
    return {turn([](float x, float y) { return std::abs(x - y) / std::max(x, y); }), turn([&](float x, float y) {
                return std::max({i.x, i.y, i.z}) * std::abs(1 / x - 1 / y);
            })};
}

void set_inertia(SolverMass& mass, Vec3 inverse_moments, Quat rotation) {
    const Mat3 r = to_matrix(rotation);
    const Vec3 i = inverse_moments, x = r.x * i.x, y = r.y * i.y, z = r.z * i.z;
    mass.inertia[0] = r.x.x * x.x + r.y.x * y.x + r.z.x * z.x;
    mass.inertia[1] = r.x.x * x.y + r.y.x * y.y + r.z.x * z.y;
    mass.inertia[2] = r.x.x * x.z + r.y.x * y.z + r.z.x * z.z;
    mass.inertia[3] = r.x.y * x.y + r.y.y * y.y + r.z.y * z.y;
    mass.inertia[4] = r.x.y * x.z + r.y.y * y.z + r.z.y * z.z;
    mass.inertia[5] = r.x.z * x.z + r.y.z * y.z + r.z.z * z.z;
}

void turn_inertia(SolverMass& mass, const SolverMotion& motion) {
    set_inertia(mass, {1 / motion.moments.x, 1 / motion.moments.y, 1 / motion.moments.z},
                normalized(motion.turned * motion.rotation));
}

double approximate_tangent(double x) { return tangent_of(x); }

void rotate_torque_free(Quatd& rotation, Vec3d& momentum, Vec3d moments, double h) {
    rotate_about_all_axes(rotation, momentum, moments, h);
}

void integrate_velocities(std::span<SolverBody> bodies, std::span<SolverMotion> motions, bool warm_start,
                          SpeedLimits limits) {
    std::size_t i = 0;
    for (; i + 4 <= bodies.size(); i += 4) {
        if (integrate_four_velocities(&bodies[i], &motions[i], warm_start, limits)) continue;
        for (std::size_t k = i; k < i + 4; ++k) integrate_velocity(bodies[k], motions[k], warm_start, limits);
    }
    for (; i < bodies.size(); ++i) integrate_velocity(bodies[i], motions[i], warm_start, limits);
}

void integrate_poses(std::span<SolverBody> bodies, std::span<SolverMotion> motions, float h) {
    FreeRotations rotations(bodies, motions, h);
    std::size_t i = 0;
    for (; i + 4 <= bodies.size(); i += 4)
        for (unsigned bits = integrate_four_poses(&bodies[i], &motions[i], h); bits != 0; bits &= bits - 1)
            rotations.add(i + static_cast<std::size_t>(std::countr_zero(bits)));
    for (; i < bodies.size(); ++i)
        if (integrate_pose(bodies[i], motions[i], h)) rotations.add(i);
    rotations.finish();
}

}  // namespace fase::dynamics
