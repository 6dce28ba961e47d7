/// Integrates velocities and poses, one body at a time.
#include "fase/dynamics/solver/integrate.hpp"

#include "fase/dynamics/solver/rows.hpp"

namespace fase::dynamics {
namespace {

Vec3 without_locked(Vec3 v, unsigned locks) { return {locks & 1 ? 0 : v.x, locks & 2 ? 0 : v.y, locks & 4 ? 0 : v.z}; }
/// Returns v, scaled to length `max` when it is longer. A NaN or infinite v is returned unchanged; finish() handles it.
Vec3 clamp_length(Vec3 v, float max, bool& clamped) {
    const float squared = length_squared(v);
    if (!(squared > max * max)) return v;
    clamped = true;
    return v * (max / std::sqrt(squared));
}

/// Rotates the momentum about principal axis i by the rotation of the body in `h` seconds, and appends that rotation to
/// `turn`.
template <int i> void rotate_about_axis(Quatd& turn, Vec3d& momentum, Vec3d moments, double h) {
    constexpr int j = (i + 1) % 3, k = (i + 2) % 3;
    if (!(moments[i] > 0)) return;
    const double t = approximate_tangent(0.5 * h * (momentum[i] / moments[i]));
    const double scale = 1 / (1 + t * t), c = (1 - t * t) * scale, s = 2 * t * scale;
    const double mj = momentum[j], mk = momentum[k];
    momentum[j] = c * mj + s * mk;
    momentum[k] = c * mk - s * mj;
    Quatd q{0, 0, 0, 1};
    (i == 0 ? q.x : i == 1 ? q.y : q.z) = t;
    turn = turn * q;
}

}  // namespace

double approximate_tangent(double x) {
    const double a = x < 0 ? -x : x;
    const double clamped = a < 1 ? a : 1;
    const double squared = clamped * clamped;
    const double tangent = clamped * (15 - squared) / (15 - 6 * squared) + (a - clamped) * 3.4;
    return x < 0 ? -tangent : tangent;
}

void rotate_torque_free(Quatd& rotation, Vec3d& momentum, Vec3d moments, double h) {
    Quatd turn;
    rotate_about_axis<0>(turn, momentum, moments, 0.5 * h);
    rotate_about_axis<1>(turn, momentum, moments, 0.5 * h);
    rotate_about_axis<2>(turn, momentum, moments, h);
    rotate_about_axis<1>(turn, momentum, moments, 0.5 * h);
    rotate_about_axis<0>(turn, momentum, moments, 0.5 * h);
    rotation = normalized(rotation * turn);
}

void integrate_velocities(std::span<SolverBody> bodies, std::span<SolverMotion> motions, bool warm_start,
                          SpeedLimits limits) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        SolverBody& body = bodies[i];
        SolverMotion& motion = motions[i];
        if (!motion.is_dynamic) continue;
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
}

void integrate_poses(std::span<SolverBody> bodies, std::span<SolverMotion> motions, float h) {
    for (std::size_t i = 0; i < bodies.size(); ++i) {
        SolverBody& body = bodies[i];
        SolverMotion& motion = motions[i];
        const Vec3 velocity = read(body.velocity);
        Vec3 spin = read(body.spin);
        const bool free = motion.is_dynamic && velocity == motion.free_velocity;
        const Vec3 mean = free ? (velocity + motion.velocity_before) * 0.5f : velocity;
        write(body.moved, read(body.moved) + mean * h);
        write(body.rotated, read(body.rotated) + spin * h);
        Quat turned = motion.turned;
        const float fast = length_squared(spin) * h * h;
        if (motion.gyroscopic && fast > 1e-8f) {
            const Quatd start = normalized(to_double(motion.rotation));
            const Vec3d moments = to_double(motion.moments);
            Quatd rotation = normalized(to_double(turned) * start);
            Vec3d momentum = multiply(rotate_back(rotation, to_double(spin)), moments);
            rotate_torque_free(rotation, momentum, moments, static_cast<double>(h));
            const Vec3d principal{momentum.x / moments.x, momentum.y / moments.y, momentum.z / moments.z};
            const Vec3 after = to_float(rotate(rotation, principal));
            motion.free_spin += after - spin;
            write(body.spin, after);
            turned = to_float(normalized(rotation * conjugate(start)));
        } else if (fast > 0) {
            // tan(angle / 2) / angle, so that the normalised quaternion has the exact angle.
            const float x = 0.25f * fast;
            const float scale = x < 1 ? 0.5f * (15 - x) / (15 - 6 * x) : 0.78f;
            const Vec3 t = spin * (h * scale);
            turned = normalized(Quat{t.x, t.y, t.z, 1} * turned);
        }
        motion.turned = turned;
    }
}

}  // namespace fase::dynamics
