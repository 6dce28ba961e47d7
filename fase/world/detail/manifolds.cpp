/// Manifolds from step to step: reuse, and the impulses of points that were there before.
#include "fase/world/detail/manifolds.hpp"

#include <algorithm>

#include "fase/geometry/aabb.hpp"

namespace fase {

using dynamics::BodyMotion;
using dynamics::Contact;
using dynamics::ContactManifold;

RotationSince::RotationSince(Quat now, Quat then) : rotation(now * conjugate(then)) {
    const auto [x, y, z, w] = rotation;
    const float xx = x * x, yy = y * y, zz = z * z;
    change = {Vec3{-yy - zz, x * y + w * z, x * z - w * y} * 2.0f, Vec3{x * y - w * z, -xx - zz, y * z + w * x} * 2.0f,
              Vec3{x * z + w * y, y * z - w * x, -xx - yy} * 2.0f};
}

PairMotion::PairMotion(const Contact& contact, const BodyMotion& motion_a, const BodyMotion& motion_b)
    : a(motion_a.rotation, contact.rotation_a),
      b(motion_b.rotation, contact.rotation_b),
      moved(to_float((motion_b.position - motion_a.position) - contact.b_from_a)) {}

namespace {

/// Moves a manifold with its bodies. It turns about the normal with a, but does not tilt: the levers of a leaning tower
/// stay those of the upright one. With soft contacts, true levers make tall towers buckle
/// (docs/decisions/0014-contacts-move-with-their-bodies.md). Returns false when a point moved by `distance` or more
/// between the bodies; the manifold is then partly moved.
bool move_manifold(ContactManifold& m, const PairMotion& motion, float distance) {
    const RotationSince &a = motion.a, &b = motion.b;
    // The relative displacement is affine in the tangent coordinates of the points.
    const Vec3 n = m.normal, second = cross(n, m.first_tangent);
    const Vec3 centre = motion.moved + b.change * m.first_offset_b - a.change * m.first_offset_a;
    const Mat3 change = b.change - a.change;
    const Vec3 slope_x = change * m.first_tangent, slope_y = change * second;
    const float centre_n = dot(centre, n), slope_x_n = dot(slope_x, n), slope_y_n = dot(slope_y, n);
    bool near = true;
    for (int i = 0; i < 4; ++i) {  // absent points lie in the centre
        near &= length_squared(centre + slope_x * m.x[i] + slope_y * m.y[i]) < distance * distance;
        m.separation[i] = m.first_separation[i] + centre_n + slope_x_n * m.x[i] + slope_y_n * m.y[i];
    }
    if (!near) return false;
    m.tangent = m.first_tangent;
    m.offset_a = m.first_offset_a;
    m.offset_b = m.first_offset_b;
    if (const float turn = dot(n, a.rotation.vector()); turn * turn > 1e-9f) {
        const Quat twist = a.twist(n);
        m.tangent = rotate(twist, m.tangent);
        m.offset_a = rotate(twist, m.offset_a);
        m.offset_b = rotate(twist, m.offset_b);
    }
    return true;
}

float nearest_of(std::span<const ContactManifold> manifolds) {
    float nearest = Aabb::infinity;
    for (const ContactManifold& m : manifolds)
        for (int i = 0; i < m.count; ++i) nearest = std::min(nearest, m.separation[i]);
    return nearest;
}

/// The points of a manifold, from the centres of mass of both bodies.
struct PlacedPoints {
    Vec3 from_a[4], from_b[4];

    explicit PlacedPoints(const ContactManifold& m) {
        const Vec3 second = cross(m.normal, m.first_tangent);
        for (int i = 0; i < m.count; ++i) {
            const Vec3 from_centre = m.first_tangent * m.x[i] + second * m.y[i];
            from_a[i] = m.first_offset_a + from_centre;
            from_b[i] = m.first_offset_b + from_centre;
        }
    }
};

/// Gives each new point the impulses of an old one for warm starting: first of one with the same feature nearby, then
/// of the nearest one. A place counts as near when it is near on either body: points of a sliding box move with it.
/// Features alone do not suffice: they change on flush faces.
void match_points(ContactManifold& m, const ContactManifold& old, const PairMotion& motion, float match_distance) {
    const PlacedPoints now(m);
    PlacedPoints before(old);
    for (int i = 0; i < old.count; ++i) {
        before.from_a[i] = motion.a.turned(before.from_a[i]);
        before.from_b[i] = motion.b.turned(before.from_b[i]);
    }
    const auto distance_squared = [&](int i, int j) {
        return std::min(length_squared(now.from_a[i] - before.from_a[j]),
                        length_squared(now.from_b[i] - before.from_b[j]));
    };
    const bool single = m.count == 1 && old.count == 1;
    const float limit = single ? Aabb::infinity : match_distance * match_distance;
    bool used[4] = {}, matched[4] = {};
    for (const bool by_feature : {true, false})
        for (int i = 0; i < m.count; ++i) {
            if (matched[i]) continue;
            float nearest = limit;
            int match = -1;
            for (int j = 0; j < old.count; ++j) {
                if (used[j] || (by_feature && old.feature[j] != m.feature[i])) continue;
                const float squared = distance_squared(i, j);
                if (!(squared < nearest)) continue;
                nearest = squared;
                match = j;
            }
            if (match < 0) continue;
            m.impulse[i] = old.impulse[match];
            used[match] = matched[i] = true;
        }
}

/// Replaces the points of a manifold. The tangent is chosen in the axes of a, so that it turns with a.
void set_points(ContactManifold& m, const WorldManifold& world, Quat rotation_a) {
    m.count = static_cast<std::uint8_t>(world.count);
    for (int i = 0; i < 4; ++i) m.impulse[i] = m.total_impulse[i] = m.x[i] = m.y[i] = m.first_separation[i] = 0;
    m.friction_impulse[0] = m.friction_impulse[1] = m.twist_impulse = 0;
    if (world.count == 0) return;
    m.normal = world.normal;
    m.first_tangent = m.tangent = rotate(rotation_a, any_perpendicular(rotate_back(rotation_a, world.normal)));
    m.first_offset_a = m.offset_a = world.offset_a;
    m.first_offset_b = m.offset_b = world.offset_b;
    const Vec3 second = cross(m.normal, m.tangent);
    for (int i = 0; i < world.count; ++i) {
        m.x[i] = dot(world.points[i], m.tangent);
        m.y[i] = dot(world.points[i], second);
        m.first_separation[i] = m.separation[i] = world.separation[i];
        m.feature[i] = world.feature[i];
    }
}

}  // namespace

bool reuse_manifolds(Contact& contact, std::span<ContactManifold> manifolds, const PairMotion& motion, float distance) {
    constexpr float max_tilt = 3e-4f;
    for (ContactManifold& m : manifolds)
        if (!(motion.a.tilt(m.normal) < max_tilt && motion.b.tilt(m.normal) < max_tilt) ||
            !move_manifold(m, motion, distance))
            return false;
    contact.nearest = nearest_of(manifolds);
    return true;
}

void store_manifold(Contact& c, ContactManifold& m, const WorldManifold& world, const BodyMotion& a,
                    const BodyMotion& b, const PairMotion& motion, float match_distance) {
    const ContactManifold old = m;
    const bool had_points = c.manifolds != 0;
    set_points(m, world, a.rotation);
    c.manifolds = world.count > 0 ? 1 : 0;
    c.points = m.count;
    if (c.manifolds == 0) return;
    c.b_from_a = b.position - a.position;
    c.rotation_a = a.rotation;
    c.rotation_b = b.rotation;
    c.nearest = nearest_of({&m, 1});
    if (!had_points) return;
    const Vec3 friction =
        old.tangent * old.friction_impulse[0] + cross(old.normal, old.tangent) * old.friction_impulse[1];
    m.friction_impulse[0] = dot(friction, m.tangent);
    m.friction_impulse[1] = dot(friction, cross(m.normal, m.tangent));
    m.twist_impulse = old.twist_impulse;
    match_points(m, old, motion, match_distance);
}

}  // namespace fase
