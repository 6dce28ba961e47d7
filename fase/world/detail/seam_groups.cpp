/// The contacts of each moving collider with what does not move, so that one pass can correct all of them together.
#include "fase/world/detail/seam_groups.hpp"

#include <algorithm>

#include "fase/world/detail/collider_places.hpp"

namespace fase {

using dynamics::BodyMotion;
using dynamics::BodyTraits;
using dynamics::Contact;
using dynamics::ContactManifold;

namespace {

bool is_mover(const BodyTraits& body) {
    return body.kind == BodyKind::Dynamic && body.motion_state == MotionState::Awake && !body.quarantined;
}

/// The moving collider of a contact between it and a body that nothing pushes; no_index for others.
std::uint32_t mover_of(const BodyTable& bodies, const Contact& c) {
    if (c.sensor || c.on_mesh) return no_index;
    const BodyTraits &a = bodies.traits[c.body_a], &b = bodies.traits[c.body_b];
    if (is_mover(a) && b.kind != BodyKind::Dynamic) return c.collider_a;
    if (is_mover(b) && a.kind != BodyKind::Dynamic) return c.collider_b;
    return no_index;
}

/// Static and resting kinematic pieces have number 0; those of a moving body move together.
std::uint32_t frame_of(const BodyTable& bodies, std::uint32_t body) {
    const BodyMotion& motion = bodies.motion[body];
    const bool rests = bodies.traits[body].kind == BodyKind::Static ||
                       (motion.linear_velocity == Vec3{} && motion.angular_velocity == Vec3{});
    return rests ? 0 : body + 1;
}

/// Returns the pose of a collider relative to `origin`, world axes.
TransformD pose_near(const BodyTable& bodies, const Collider& collider, Vec3d origin) {
    const Pose pose = world_pose(bodies, collider);
    return {to_matrix(normalized(to_double(pose.rotation))), pose.position - origin};
}

/// Metres by which a body's surface may leave its straight path in a step: by gravity, forces and spin; all of its path
/// when it may hit other dynamic bodies, or has several colliders, which may hit something by themselves.
double detour_of(const SeamTables& tables, const ContactTable& contacts, std::uint32_t mover, float path) {
    const std::uint32_t body = tables.colliders[mover].body;
    const BodyTraits& traits = tables.bodies.traits[body];
    bool may_be_hit = tables.colliders[traits.first_collider].next != no_index;
    contacts.graph.for_each_of(mover, [&](std::uint32_t index) {
        const Contact& c = contacts[index];
        may_be_hit = may_be_hit || (!c.sensor && tables.bodies.traits[c.body_a].kind == BodyKind::Dynamic &&
                                    tables.bodies.traits[c.body_b].kind == BodyKind::Dynamic && c.manifolds > 0);
    });
    if (may_be_hit) return double(path) + double(traits.reach);
    const float acceleration = length(tables.settings.gravity) * std::abs(traits.gravity_scale) +
                               length(tables.bodies.forces[body].force) * traits.inverse_mass;
    const SharedShape& shape = tables.colliders.shapes[tables.colliders[mover].shape];
    const float turn = std::min(length(tables.bodies.motion[body].angular_velocity) * tables.seconds, 2.0f);
    const float rim = shape.outer_radius - shape.inner_radius;  // what turns about the centre of a ball does not move
    return double(acceleration * tables.seconds * tables.seconds) + double(turn * rim);
}

/// Reads the first manifold of a contact, relative to the centre of mass of the mover, its normal towards the mover.
narrow::Manifold read_manifold(const Contact& c, const ContactManifold& m, bool mover_is_b) {
    narrow::Manifold manifold;
    manifold.count = c.manifolds > 0 ? m.count : 0;
    manifold.normal = mover_is_b ? m.normal : -m.normal;
    const Vec3 offset = mover_is_b ? m.offset_b : m.offset_a, second = cross(m.normal, m.tangent);
    for (std::size_t i = 0; i < static_cast<std::size_t>(manifold.count); ++i)
        manifold.points[i] = {offset + m.tangent * m.x[i] + second * m.y[i], m.separation[i], m.feature[i]};
    return manifold;
}

/// Converts back.
WorldManifold world_manifold(const narrow::Manifold& manifold, bool mover_is_b, Vec3 b_from_a) {
    Vec3 centre;
    WorldManifold world = around_centre(
        manifold, [](Vec3 v) { return v; }, centre);
    if (world.count == 0) return world;
    world.normal = mover_is_b ? manifold.normal : -manifold.normal;
    world.offset_a = mover_is_b ? centre + b_from_a : centre;
    world.offset_b = mover_is_b ? centre : centre - b_from_a;
    return world;
}

/// Stores a corrected manifold in the place of the computed one. Impulses come from the manifold of the last step.
void store_correction(const SeamTables& tables, ContactTable& contacts, const SeamEntry& entry,
                      const narrow::Manifold& manifold, std::uint32_t mover) {
    Contact& c = contacts[entry.contact];
    const bool mover_is_b = c.collider_b == mover;
    ContactManifold& m = contacts.manifolds.places(c)[0];
    const BodyMotion &a = tables.bodies.motion[c.body_a], &b = tables.bodies.motion[c.body_b];
    const float reuse_distance = c.reuse_distance;
    c.manifolds = entry.before.manifolds;
    c.b_from_a = entry.before.b_from_a;
    c.rotation_a = entry.before.rotation_a;
    c.rotation_b = entry.before.rotation_b;
    const bool a_rolls = m.a_rolls, b_rolls = m.b_rolls;
    m = entry.manifold_before;
    m.a_rolls = a_rolls;
    m.b_rolls = b_rolls;
    store_manifold(c, m, world_manifold(manifold, mover_is_b, to_float(b.position - a.position)), a, b,
                   std::min(0.05f, 2 * reuse_distance));
    c.reusable = false;
}

}  // namespace

void find_seam_groups(const BodyTable& bodies, const ColliderTable& colliders, float min_speed,
                      const ContactTable& contacts, SeamGroups& groups) {
    const auto moves = [&](std::uint32_t collider) {
        return length_squared(bodies.motion[colliders[collider].body].linear_velocity) > min_speed * min_speed;
    };
    const std::vector<std::uint32_t>& active = contacts.active.values;
    groups.movers.resize(active.size());
    groups.is_grouped.assign(active.size(), 0);
    groups.count_of.assign(colliders.all.size(), 0);
    groups.all.clear();
    for (std::size_t i = 0; i < active.size(); ++i) {
        groups.movers[i] = mover_of(bodies, contacts[active[i]]);
        if (groups.movers[i] != no_index) ++groups.count_of[groups.movers[i]];
    }
    std::size_t entries = 0;
    groups.place_of.resize(colliders.all.size());
    for (std::size_t i = 0; i < active.size(); ++i) {
        const std::uint32_t mover = groups.movers[i];
        if (mover == no_index) continue;
        std::uint32_t& count = groups.count_of[mover];
        if (count == 0 || (count == 1 && !moves(mover))) continue;
        if ((count & SeamGroups::placed) == 0) {
            groups.all.push_back({mover, static_cast<std::uint32_t>(entries), count});
            groups.place_of[mover] = static_cast<std::uint32_t>(entries);
            entries += count;
            count |= SeamGroups::placed;
            if (groups.entries.size() < entries) groups.entries.resize(entries);
        }
        groups.is_grouped[i] = 1;
        groups.entries[groups.place_of[mover]].active = static_cast<std::uint32_t>(i);
        groups.entries[groups.place_of[mover]++].contact = active[i];
    }
    if (groups.contacts.size() < entries) groups.contacts.resize(entries);
}

void correct_group(const SeamTables& tables, ContactTable& contacts, std::uint32_t mover,
                   std::span<const SeamEntry> entries, std::span<narrow::SeamContact> seams) {
    const Collider& collider = tables.colliders[mover];
    const SharedShape& shape = tables.colliders.shapes[collider.shape];
    if (std::holds_alternative<HalfSpace>(shape.shape)) return;
    const bool any = std::any_of(entries.begin(), entries.end(), [&](const SeamEntry& entry) {
        return !entry.reused && contacts[entry.contact].manifolds > 0;
    });
    if (!any) return;
    const BodyMotion& motion = tables.bodies.motion[collider.body];
    narrow::SeamMover moving;
    moving.shape = &shape.shape;
    moving.pose = pose_near(tables.bodies, collider, motion.position);
    moving.path = to_double(motion.linear_velocity * tables.seconds);
    moving.margin = double(tables.settings.speculative_distance) + double(tables.sweep[collider.body]);
    moving.is_fast = tables.sweep[collider.body] > 0;
    moving.inner_radius = shape.inner_radius;
    moving.detour = detour_of(tables, contacts, mover, length(motion.linear_velocity) * tables.seconds);
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const Contact& c = contacts[entries[i].contact];
        const bool mover_is_b = c.collider_b == mover;
        const Collider& other = tables.colliders[mover_is_b ? c.collider_a : c.collider_b];
        narrow::SeamContact& seam = seams[i];
        seam.piece = {&tables.colliders.shapes[other.shape].shape, pose_near(tables.bodies, other, motion.position),
                      frame_of(tables.bodies, other.body)};
        seam.manifold = read_manifold(c, contacts.manifolds.places(c)[0], mover_is_b);
        seam.is_kept = entries[i].reused || c.manifolds > 1;
    }
    narrow::correct_seams(moving, seams);
    for (std::size_t i = 0; i < entries.size(); ++i)
        if (seams[i].changed) store_correction(tables, contacts, entries[i], seams[i].manifold, mover);
}

}  // namespace fase
