/// Manifolds from step to step: reuse, and the impulses of points that were there before.
#include "fase/world/detail/manifolds.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "fase/geometry/aabb.hpp"
#include "fase/math/detail/float4.hpp"

namespace fase {

using dynamics::BodyMotion;
using dynamics::Contact;
using dynamics::ContactManifold;

using detail::Float4;
using detail::load_four;

PairMotion pair_motion(const Contact& contact, const BodyMotion& a, const BodyMotion& b) {
    return {{a.rotation, contact.rotation_a},
            {b.rotation, contact.rotation_b},
            to_float((b.position - a.position) - contact.b_from_a)};
}

namespace {

constexpr float max_tilt = 3e-4f;

/// A manifold when it was computed.
template <class T> struct FirstFrame { Vec3Of<T> normal, tangent, offset_a, offset_b; };

/// The displacement of the points between the bodies, which is affine in the tangent coordinates.
template <class T> struct Displacement {
    Vec3Of<T> centre, slope_x, slope_y;
    T centre_n, slope_x_n, slope_y_n;  // along the normal

    Displacement(const FirstFrame<T>& first, const PairMotionOf<T>& motion) {
        const Vec3Of<T> n = first.normal, second = cross(n, first.tangent);
        centre = motion.moved + motion.b.change * first.offset_b - motion.a.change * first.offset_a;
        const Mat3Of<T> change = motion.b.change - motion.a.change;
        slope_x = change * first.tangent;
        slope_y = change * second;
        centre_n = dot(centre, n);
        slope_x_n = dot(slope_x, n);
        slope_y_n = dot(slope_y, n);
    }
    [[nodiscard]] T squared_length(T x, T y) const { return length_squared(centre + slope_x * x + slope_y * y); }
    [[nodiscard]] T separation(T first, T x, T y) const { return first + centre_n + slope_x_n * x + slope_y_n * y; }
};

/// Turns a manifold about its normal with body a; it does not tilt: the levers of a leaning tower stay those of the
/// upright one. With soft contacts, true levers make tall towers buckle
/// (docs/decisions/0014-contacts-move-with-their-bodies.md).
void turn_frame(ContactManifold& m, Quat rotation_a) {
    m.tangent = m.first_tangent;
    m.offset_a = m.first_offset_a;
    m.offset_b = m.first_offset_b;
    const float turn = dot(m.normal, rotation_a.vector());
    if (!(turn * turn > 1e-9f)) return;
    const Vec3 v = m.normal * turn;
    const Quat twist = normalized(Quat{v.x, v.y, v.z, rotation_a.w});
    m.tangent = rotate(twist, m.tangent);
    m.offset_a = rotate(twist, m.offset_a);
    m.offset_b = rotate(twist, m.offset_b);
}

bool move_manifold(ContactManifold& m, const PairMotion& motion, float distance) {
    const Displacement<float> by({m.normal, m.first_tangent, m.first_offset_a, m.first_offset_b}, motion);
    bool near = true;
    for (int i = 0; i < 4; ++i) {  // absent points lie in the centre
        near &= by.squared_length(m.x[i], m.y[i]) < distance * distance;
        m.separation[i] = by.separation(m.first_separation[i], m.x[i], m.y[i]);
    }
    if (near) turn_frame(m, motion.a.rotation);
    return near;
}

float nearest_of(std::span<const ContactManifold> manifolds) {
    float nearest = Aabb::infinity;
    for (const ContactManifold& m : manifolds)
        for (int i = 0; i < m.count; ++i) nearest = std::min(nearest, m.separation[i]);
    return nearest;
}

template <class F> QuatOf<Float4> load_quats(const F& get) {
    const auto [x, y, z, w] = load_four([&](int k) { return &get(k).x; });
    return {x, y, z, w};
}

Vec3Of<Float4> in_all_lanes(Vec3 v) { return {v.x, v.y, v.z}; }
Mat3Of<Float4> in_all_lanes(const Mat3& m) { return {in_all_lanes(m.x), in_all_lanes(m.y), in_all_lanes(m.z)}; }

/// The points of a manifold when it was computed, from the centres of mass of both bodies: one in each lane.
struct PlacedPoints {
    Vec3Of<Float4> from_a, from_b;

    PlacedPoints() = default;
    explicit PlacedPoints(const ContactManifold& m) {
        const Vec3 second = cross(m.normal, m.first_tangent);
        const Vec3Of<Float4> from_centre =
            in_all_lanes(m.first_tangent) * Float4::load(m.x) + in_all_lanes(second) * Float4::load(m.y);
        from_a = in_all_lanes(m.first_offset_a) + from_centre;
        from_b = in_all_lanes(m.first_offset_b) + from_centre;
    }
    /// Turns the points with the bodies.
    void move(const PairMotion& motion) {
        from_a = from_a + in_all_lanes(motion.a.change) * from_a;
        from_b = from_b + in_all_lanes(motion.b.change) * from_b;
    }
};

/// What a new manifold takes over from the one before it.
struct OldPoints {
    int count;
    std::uint32_t feature[4];
    float impulse[4];
    Vec3 friction;
    float twist_impulse;
    PlacedPoints placed;  ///< set by place()

    explicit OldPoints(const ContactManifold& m)
        : count(m.count),
          friction(m.tangent * m.friction_impulse[0] + cross(m.normal, m.tangent) * m.friction_impulse[1]),
          twist_impulse(m.twist_impulse) {
        std::copy_n(m.feature, 4, feature);
        std::copy_n(m.impulse, 4, impulse);
    }
    /// Places the points where they are now.
    void place(const ContactManifold& m, const PairMotion& motion) {
        placed = PlacedPoints(m);
        placed.move(motion);
    }
};

/// Gives each new point the impulses of an old one for warm starting: first of one with the same feature nearby, then
/// of the nearest one. A place counts as near when it is near on either body: points of a sliding box move with it.
/// Features alone do not suffice: they change on flush faces.
void match_points(ContactManifold& m, const OldPoints& old, float match_distance) {
    const PlacedPoints now(m);
    float distance_squared[4][4];
    for (int i = 0; i < m.count; ++i) {
        const auto squared = [i](const Vec3Of<Float4>& here, const Vec3Of<Float4>& there) {
            return length_squared(Vec3Of<Float4>{here.x.v[i], here.y.v[i], here.z.v[i]} - there);
        };
        const Float4 on_a = squared(now.from_a, old.placed.from_a), on_b = squared(now.from_b, old.placed.from_b);
        select(on_b < on_a, on_b, on_a).store(distance_squared[i]);
    }
    bool used[4] = {}, matched[4] = {};
    for (const bool by_feature : {true, false})
        for (int i = 0; i < m.count; ++i) {
            if (matched[i]) continue;
            float nearest = match_distance * match_distance;
            int match = -1;
            for (int j = 0; j < old.count; ++j) {
                if (used[j] || (by_feature && old.feature[j] != m.feature[i])) continue;
                if (!(distance_squared[i][j] < nearest)) continue;
                nearest = distance_squared[i][j];
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

/// Gives a manifold the friction and the impulses of an old one. `single`: both have one point.
void take_over(ContactManifold& m, const OldPoints& old, bool single, float match_distance) {
    m.friction_impulse[0] = dot(old.friction, m.tangent);
    m.friction_impulse[1] = dot(old.friction, cross(m.normal, m.tangent));
    m.twist_impulse = old.twist_impulse;
    if (single) {
        m.impulse[0] = old.impulse[0];
    } else {
        match_points(m, old, match_distance);
    }
}

/// Stores how the bodies stand where the manifolds are computed.
void set_motion(Contact& c, std::span<const ContactManifold> manifolds, const BodyMotion& a, const BodyMotion& b) {
    c.b_from_a = b.position - a.position;
    c.rotation_a = a.rotation;
    c.rotation_b = b.rotation;
    c.nearest = nearest_of(manifolds);
}

/// Returns the old manifold that goes on as the new one, of those that no other takes; null: none.
ContactManifold* match_of(const KeyedManifold& world, std::span<ContactManifold> old) {
    constexpr float similar = 0.97f;
    ContactManifold* best = nullptr;
    float largest = similar;
    for (ContactManifold& m : old) {
        if (m.count == 0) continue;
        if (m.key == world.key && dot(m.normal, world.normal) > 0) return &m;
        const float cosine = dot(m.normal, world.normal);
        if (!(cosine > largest)) continue;
        largest = cosine;
        best = &m;
    }
    return best;
}

}  // namespace

bool reuse_manifolds(const ReuseInput& input) {
    const PairMotion motion = pair_motion(*input.contact, *input.a, *input.b);
    const std::span<ContactManifold> manifolds(input.manifold, input.contact->manifolds);
    for (ContactManifold& m : manifolds)
        if (!(motion.a.tilt(m.normal) < max_tilt && motion.b.tilt(m.normal) < max_tilt) ||
            !move_manifold(m, motion, input.distance))
            return false;
    input.contact->nearest = nearest_of(manifolds);
    return true;
}

unsigned reuse_four(const ReuseInput (&inputs)[reused_together]) {
    PairMotionOf<Float4> motion;
    motion.a = {load_quats([&](int k) -> const Quat& { return inputs[k].a->rotation; }),
                load_quats([&](int k) -> const Quat& { return inputs[k].contact->rotation_a; })};
    motion.b = {load_quats([&](int k) -> const Quat& { return inputs[k].b->rotation; }),
                load_quats([&](int k) -> const Quat& { return inputs[k].contact->rotation_b; })};
    float moved[3][4], distance[4];
    for (int k = 0; k < 4; ++k) {
        const ReuseInput& in = inputs[k];
        const Vec3 by = to_float((in.b->position - in.a->position) - in.contact->b_from_a);
        moved[0][k] = by.x;
        moved[1][k] = by.y;
        moved[2][k] = by.z;
        distance[k] = in.distance * in.distance;
    }
    motion.moved = {Float4::load(moved[0]), Float4::load(moved[1]), Float4::load(moved[2])};
    // The normal, the first tangent and both offsets follow each other.
    const auto first = [&](int part) {
        return load_four([&](int k) { return &inputs[k].manifold->normal.x + 4 * part; });
    };
    const auto [nx, ny, nz, tx] = first(0);
    const auto [ty, tz, ax, ay] = first(1);
    const auto [az, bx, by, bz] = first(2);
    const FirstFrame<Float4> frame{{nx, ny, nz}, {tx, ty, tz}, {ax, ay, az}, {bx, by, bz}};
    const Float4::Mask upright =
        (motion.a.tilt(frame.normal) < Float4(max_tilt)) & (motion.b.tilt(frame.normal) < Float4(max_tilt));
    const Displacement<Float4> by_points(frame, motion);
    const auto xs = load_four([&](int k) { return inputs[k].manifold->x; });
    const auto ys = load_four([&](int k) { return inputs[k].manifold->y; });
    const auto first_separation = load_four([&](int k) { return inputs[k].manifold->first_separation; });
    Float4 separation[4];
    Float4::Mask reused = upright;
    for (std::size_t i = 0; i < 4; ++i) {
        reused &= by_points.squared_length(xs[i], ys[i]) < Float4::load(distance);
        separation[i] = by_points.separation(first_separation[i], xs[i], ys[i]);
    }
    transpose(separation);
    Quat rotation_a[4];
    const auto& [qx, qy, qz, qw] = motion.a.rotation;
    store_four(qx, qy, qz, qw, [&](int k) { return &rotation_a[k].x; });
    unsigned bits = 0;
    for (int k = 0; k < 4; ++k) {
        ContactManifold& m = *inputs[k].manifold;
        if (upright[k] != 0) separation[k].store(m.separation);
        if (reused[k] == 0) continue;
        bits |= 1u << k;
        turn_frame(m, rotation_a[k]);
        inputs[k].contact->nearest = nearest_of({&m, 1});
    }
    return bits;
}

// Inlines all that it calls: most contacts of scenes in motion come here in every step.
[[gnu::flatten]] void store_manifold(Contact& c, ContactManifold& m, const WorldManifold& world, const BodyMotion& a,
                                     const BodyMotion& b, float match_distance) {
    const bool had_points = c.manifolds != 0;
    OldPoints old(m);
    const bool single = world.count == 1 && old.count == 1;  // matches at any distance
    if (had_points && world.count > 0 && !single) old.place(m, pair_motion(c, a, b));
    set_points(m, world, a.rotation);
    c.manifolds = world.count > 0 ? 1 : 0;
    c.points = m.count;
    if (c.manifolds == 0) return;
    set_motion(c, {&m, 1}, a, b);
    if (had_points) take_over(m, old, single, match_distance);
}

void store_manifolds(Contact& c, std::span<ContactManifold> places, std::span<const KeyedManifold> worlds,
                     const BodyMotion& a, const BodyMotion& b, float match_distance) {
    std::vector<ContactManifold> old(places.begin(), places.begin() + c.manifolds);
    const PairMotion motion = old.empty() ? PairMotion() : pair_motion(c, a, b);
    c.manifolds = static_cast<std::uint16_t>(worlds.size());
    c.points = 0;
    for (std::size_t i = 0; i < worlds.size(); ++i) {
        ContactManifold& m = places[i];
        const dynamics::ConstraintColour colour = m.colour;
        m = {};  // a place may hold what an ended manifold left, which snapshots do not
        m.colour = colour;
        set_points(m, worlds[i], a.rotation);
        m.key = worlds[i].key;
        c.points = static_cast<std::uint16_t>(c.points + m.count);
        ContactManifold* before = match_of(worlds[i], old);
        if (before == nullptr) continue;
        OldPoints points(*before);
        const bool single = m.count == 1 && points.count == 1;
        if (!single) points.place(*before, motion);
        take_over(m, points, single, match_distance);
        before->count = 0;
    }
    if (c.manifolds != 0) set_motion(c, places.first(worlds.size()), a, b);
}

}  // namespace fase
