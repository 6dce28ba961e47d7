/// Stage "collide": updates the contact manifold of each active pair.
#include <algorithm>

#include "fase/narrow/dispatch.hpp"
#include "fase/world/detail/state.hpp"

namespace fase {

using dynamics::BodyMotion;
using dynamics::Contact;

namespace {

/// How a body moved since the manifold was computed.
struct Displacement {
    Vec3 moved;
    Quat rotation;

    Displacement(const BodyMotion& now, Vec3d position, Quat rotation_then)
        : moved(to_float(now.position - position)), rotation(now.rotation * conjugate(rotation_then)) {}
    /// Returns R v - v for the rotation R.
    [[nodiscard]] Vec3 of(Vec3 v) const {
        const Vec3 q = rotation.vector();
        return cross(q, cross(q, v) + v * rotation.w) * 2.0f;
    }
    /// Returns the square of the sine of half the angle by which the axis tilted.
    [[nodiscard]] float tilt(Vec3 axis) const {
        const Vec3 v = rotation.vector();
        return length_squared(v - axis * dot(axis, v));
    }
    /// Returns the part of the rotation that is about the axis.
    [[nodiscard]] Quat twist(Vec3 axis) const {
        const Vec3 v = axis * dot(axis, rotation.vector());
        return normalized(Quat{v.x, v.y, v.z, rotation.w});
    }
};

/// Reuses the manifold while none of its points moved by `distance` between the bodies, and neither body tilted by more
/// than about two degrees. Updates separations, and turns the frame about the normal with the bodies. It does not tilt
/// the frame: the levers of a leaning tower stay those of the upright one. With soft contacts, true levers make tall
/// towers buckle (docs/decisions/0014-contacts-move-with-their-bodies.md).
bool reuse_manifold(Contact& c, const BodyMotion& a, const BodyMotion& b, float distance) {
    constexpr float max_tilt = 3e-4f;
    const Displacement moved_a(a, c.position_a, c.rotation_a), moved_b(b, c.position_b, c.rotation_b);
    const Vec3 n = c.first_normal;
    if (!(moved_a.tilt(n) < max_tilt && moved_b.tilt(n) < max_tilt)) return false;
    // The relative displacement is affine in the tangent coordinates of the points.
    const Vec3 second = cross(n, c.first_tangent);
    const Vec3 centre = (moved_b.moved + moved_b.of(c.first_offset_b)) - (moved_a.moved + moved_a.of(c.first_offset_a));
    const Vec3 slope_x = moved_b.of(c.first_tangent) - moved_a.of(c.first_tangent);
    const Vec3 slope_y = moved_b.of(second) - moved_a.of(second);
    float separation[4] = {};
    for (int i = 0; i < c.count; ++i) {
        const Vec3 moved = centre + slope_x * c.x[i] + slope_y * c.y[i];
        if (!(length_squared(moved) < distance * distance)) return false;
        separation[i] = c.first_separation[i] + dot(moved, n);
    }
    c.normal = n;
    c.tangent = c.first_tangent;
    c.offset_a = c.first_offset_a;
    c.offset_b = c.first_offset_b;
    if (const float turn = dot(n, moved_a.rotation.vector()); turn * turn > 1e-9f) {
        const Quat twist = moved_a.twist(n);
        c.tangent = rotate(twist, c.tangent);
        c.offset_a = rotate(twist, c.offset_a);
        c.offset_b = rotate(twist, c.offset_b);
    }
    c.nearest = separation[0];
    for (int i = 0; i < c.count; ++i) {
        c.separation[i] = separation[i];
        c.nearest = std::min(c.nearest, separation[i]);
    }
    return true;
}

/// The points of a manifold in the axes of both bodies.
struct PlacedPoints {
    Vec3 in_a[4], in_b[4];

    PlacedPoints(const Contact& c, int count) {
        const Vec3 second = cross(c.first_normal, c.first_tangent);
        for (int i = 0; i < count; ++i) {
            const Vec3 from_centre = c.first_tangent * c.x[i] + second * c.y[i];
            in_a[i] = rotate_back(c.rotation_a, c.first_offset_a + from_centre);
            in_b[i] = rotate_back(c.rotation_b, c.first_offset_b + from_centre);
        }
    }
};

/// Gives each new point the impulses of an old one for warm starting: first of one with the same feature nearby, then
/// of the nearest one. A place counts as near when it is near on either body: points of a sliding box move with it.
/// Features alone do not suffice: they change on flush faces.
void match_points(Contact& c, const Contact& old, float match_distance) {
    const PlacedPoints now(c, c.count), before(old, old.count);
    const auto distance_squared = [&](int i, int j) {
        return std::min(length_squared(now.in_a[i] - before.in_a[j]), length_squared(now.in_b[i] - before.in_b[j]));
    };
    const bool single = c.count == 1 && old.count == 1;
    const float limit = single ? Aabb::infinity : match_distance * match_distance;
    bool used[4] = {}, matched[4] = {};
    for (const bool by_feature : {true, false})
        for (int i = 0; i < c.count; ++i) {
            if (matched[i]) continue;
            float nearest = limit;
            int match = -1;
            for (int j = 0; j < old.count; ++j) {
                if (used[j] || (by_feature && old.feature[j] != c.feature[i])) continue;
                const float squared = distance_squared(i, j);
                if (!(squared < nearest)) continue;
                nearest = squared;
                match = j;
            }
            if (match < 0) continue;
            c.impulse[i] = old.impulse[match];
            used[match] = matched[i] = true;
        }
}

/// A manifold in world axes: offsets of its centre from the two centres of mass, and the points relative to the centre.
struct WorldManifold {
    Vec3 normal, offset_a, offset_b;
    Vec3 points[4];
};

/// Stores a new manifold in the contact.
void store_manifold(Contact& c, const narrow::Manifold& manifold, const WorldManifold& world, const BodyMotion& a,
                    const BodyMotion& b, float match_distance) {
    const Contact old = c;
    c.count = static_cast<std::uint8_t>(manifold.count);
    for (int i = 0; i < 4; ++i) c.impulse[i] = c.total_impulse[i] = 0;
    c.friction_impulse[0] = c.friction_impulse[1] = c.twist_impulse = 0;
    if (manifold.count == 0) return;
    c.position_a = a.position;
    c.position_b = b.position;
    c.rotation_a = a.rotation;
    c.rotation_b = b.rotation;
    c.first_normal = c.normal = world.normal;
    // Chosen in the axes of a, so that it turns with a.
    c.first_tangent = c.tangent = rotate(a.rotation, any_perpendicular(rotate_back(a.rotation, world.normal)));
    c.first_offset_a = c.offset_a = world.offset_a;
    c.first_offset_b = c.offset_b = world.offset_b;
    const Vec3 second = cross(c.normal, c.tangent);
    c.nearest = manifold.points[0].separation;
    for (int i = 0; i < manifold.count; ++i) {
        const narrow::ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
        c.x[i] = dot(world.points[i], c.tangent);
        c.y[i] = dot(world.points[i], second);
        c.first_separation[i] = c.separation[i] = point.separation;
        c.feature[i] = point.feature;
        c.nearest = std::min(c.nearest, point.separation);
    }
    if (old.count == 0) return;
    const Vec3 old_second = cross(old.normal, old.tangent);
    const Vec3 friction = old.tangent * old.friction_impulse[0] + old_second * old.friction_impulse[1];
    c.friction_impulse[0] = dot(friction, c.tangent);
    c.friction_impulse[1] = dot(friction, second);
    c.twist_impulse = old.twist_impulse;
    match_points(c, old, match_distance);
}

bool is_half_space(const Shape& shape) { return std::holds_alternative<HalfSpace>(shape); }

/// Places the frames of two colliders near each other, in float. The difference is taken in double, so bodies may be
/// far from the origin. A half-space is shifted along its plane until it is nearest to the other shape: it may be the
/// ground of a whole world, and a float is not exact a kilometre from its origin.
struct NearbyFrames {
    LocalPose b_in_a;  ///< of the colliders
    Vec3 origin_a;     ///< of the shifted frame of collider a, from the centre of mass of body a, world axes

    NearbyFrames(const LocalPose& pose_a, const LocalPose& pose_b, const Shape& a, const Shape& b, Vec3d b_from_a) {
        const Vec3d between = to_double(pose_b.position) + b_from_a - to_double(pose_a.position);
        const Quat back = conjugate(pose_a.rotation);
        Vec3d shift;
        if (is_half_space(a)) {
            const Vec3d up = rotate(normalized(to_double(pose_a.rotation)), Vec3d{0, 1, 0});
            shift = between - up * dot(up, between);
        } else if (is_half_space(b)) {
            const Vec3d up = rotate(normalized(to_double(pose_b.rotation)), Vec3d{0, 1, 0});
            b_in_a = {rotate(back, to_float(up * dot(up, between))), back * pose_b.rotation};
            origin_a = pose_a.position;
            return;
        }
        b_in_a = {rotate(back, to_float(between - shift)), back * pose_b.rotation};
        origin_a = pose_a.position + to_float(shift);
    }
};

/// Updates one contact. Returns true when its manifold was reused.
bool update_contact(WorldState& state, Contact& c) {
    const BodyMotion& a = state.bodies.motion[c.body_a];
    const BodyMotion& b = state.bodies.motion[c.body_b];
    if (c.reusable && reuse_manifold(c, a, b, std::min(state.settings.contact_reuse_distance, c.reuse_distance)))
        return true;
    const Collider& ca = state.colliders[c.collider_a];
    const Collider& cb = state.colliders[c.collider_b];
    const SharedShape& shape_a = state.shapes[ca.shape];
    const SharedShape& shape_b = state.shapes[cb.shape];
    const Vec3d exact_b_from_a = b.position - a.position;
    const Vec3 b_from_a = to_float(exact_b_from_a);
    // The smaller shape sets the scale; a half-space has no size.
    const float radius_a = shape_a.inner_radius > 0 ? shape_a.inner_radius : Aabb::infinity;
    const float radius_b = shape_b.inner_radius > 0 ? shape_b.inner_radius : Aabb::infinity;
    const float scale = std::min({radius_a, radius_b, 1e6f});
    c.reuse_distance = 0.1f * scale;
    const LocalPose pose_a = collider_pose(state, ca), pose_b = collider_pose(state, cb);
    const NearbyFrames frames(pose_a, pose_b, shape_a.shape, shape_b.shape, exact_b_from_a);
    const float margin =
        c.sensor ? 0.0f : state.settings.speculative_distance + state.sweep[c.body_a] + state.sweep[c.body_b];
    const narrow::Manifold manifold = narrow::collide(shape_a.shape, shape_b.shape, frames.b_in_a, margin);
    Vec3 centre;
    for (int i = 0; i < manifold.count; ++i) centre += manifold.points[static_cast<std::size_t>(i)].position;
    if (manifold.count > 0) centre *= 1.0f / static_cast<float>(manifold.count);
    WorldManifold world;
    world.normal = rotate(pose_a.rotation, manifold.normal);
    for (int i = 0; i < manifold.count; ++i)
        world.points[i] = rotate(pose_a.rotation, manifold.points[static_cast<std::size_t>(i)].position - centre);
    world.offset_a = frames.origin_a + rotate(pose_a.rotation, centre);
    // The place relative to a body on a half-space is exact; that relative to the far origin of the half-space is not.
    world.offset_b = is_half_space(shape_a.shape)
                         ? pose_b.position + rotate(pose_a.rotation, centre - frames.b_in_a.position)
                         : world.offset_a - b_from_a;
    store_manifold(c, manifold, world, a, b, std::min(0.05f, 0.2f * scale));
    c.reusable = manifold.count >= 3 && !c.sensor;  // sensors report in the step in which shapes part
    c.a_rolls = is_curved(shape_a.shape);
    c.b_rolls = is_curved(shape_b.shape);
    return false;
}

/// Collides the resting pairs that began or were edited. Contacts that were freed or woken meanwhile are left out.
void check_resting(WorldState& state) {
    state.checked.clear();
    state.checked.swap(state.contacts_to_check);
    std::erase_if(state.checked, [&](std::uint32_t c) { return state.contact_graph.resting_at(c) == no_index; });
    sort_by_pair(state, state.checked);
    parallel_ranges(*state.tasks, state.checked.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) update_contact(state, state.contacts[state.checked[i]]);
    });
}

}  // namespace

void collide(WorldState& state, float) {
    check_resting(state);
    state.reused.assign(state.active.size(), 0);
    parallel_ranges(*state.tasks, state.active.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Contact& c = state.contacts[state.active.values[i]];
            if (!c.sensor) state.reused[i] = update_contact(state, c) ? 1 : 0;
        }
    });
    state.touching.clear();
    state.sensors.clear();
    StepReport& report = state.report;
    for (std::size_t i = 0; i < state.active.size(); ++i) {
        const std::uint32_t index = state.active.values[i];
        const Contact& c = state.contacts[index];
        if (c.sensor) state.sensors.push_back(index);
        if (c.count == 0 || c.sensor) continue;
        ++report.manifolds;
        report.manifolds_reused += state.reused[i];
        report.contact_points += c.count;
        state.touching.push_back(index);
    }
}

void collide_sensors(WorldState& state) {
    parallel_ranges(*state.tasks, state.sensors.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) update_contact(state, state.contacts[state.sensors[i]]);
    });
    for (const std::uint32_t index : state.sensors) {
        const Contact& c = state.contacts[index];
        state.report.manifolds += c.count > 0 ? 1 : 0;
        state.report.contact_points += c.count;
    }
}

}  // namespace fase
