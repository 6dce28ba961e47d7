/// Stage "collide": updates the contact manifold of each active pair.
#include <algorithm>
#include <iterator>
#include <numeric>

#include "fase/core/detail/prefetch.hpp"
#include "fase/narrow/dispatch.hpp"
#include "fase/world/detail/collide_tables.hpp"
#include "fase/world/detail/collider_places.hpp"
#include "fase/world/detail/manifolds.hpp"
#include "fase/world/detail/seam_groups.hpp"
#include "fase/world/detail/stages.hpp"

namespace fase {

using dynamics::BodyMotion;
using dynamics::Contact;
using dynamics::ContactManifold;

namespace {

bool is_half_space(const Shape& shape) { return std::holds_alternative<HalfSpace>(shape); }

constexpr std::uint8_t not_reused = 0, on_mesh = 2;  // values of Constraints::reused, beside 1

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

WorldManifold in_world_axes(const narrow::Manifold& manifold, const LocalPose& pose_a, const LocalPose& pose_b,
                            const NearbyFrames& frames, bool a_is_half_space, Vec3 b_from_a) {
    if (manifold.count == 0) return {};
    const Mat3 axes = to_matrix(pose_a.rotation);
    Vec3 centre;
    WorldManifold world = around_centre(
        manifold, [&](Vec3 v) { return axes * v; }, centre);
    world.normal = axes * manifold.normal;
    world.offset_a = frames.origin_a + axes * centre;
    // The place relative to a body on a half-space is exact; that relative to the far origin of the half-space is not.
    world.offset_b =
        a_is_half_space ? pose_b.position + axes * (centre - frames.b_in_a.position) : world.offset_a - b_from_a;
    return world;
}

/// Loads what update_active() will read of the active contacts after number i. Those from `end` on may belong to
/// another thread: of these it reads only what no contact changes in this stage.
void prefetch_contact(const BodyTable& bodies, const ContactTable& contacts, std::size_t i, std::size_t end) {
    constexpr std::size_t near = 4, far = 8;
    const std::vector<std::uint32_t>& active = contacts.active.values;
    if (i + far < active.size()) detail::prefetch(contacts[active[i + far]]);
    if (i + near >= active.size()) return;
    const Contact& next = contacts[active[i + near]];
    if (i + near >= end || next.manifolds != 0) detail::prefetch(contacts.manifolds[next.first_manifold]);
    detail::prefetch(bodies.motion[next.body_a]);
    detail::prefetch(bodies.motion[next.body_b]);
}

ReuseInput reuse_input(const CollideTables& tables, Contact& c) {
    return {&c, &tables.contacts.manifolds[c.first_manifold], &tables.bodies.motion[c.body_a],
            &tables.bodies.motion[c.body_b], std::min(tables.settings.contact_reuse_distance, c.reuse_distance)};
}

/// Computes the manifolds of a contact from its shapes.
void compute_manifolds(const CollideTables& tables, Contact& c) {
    const auto& [settings, bodies, colliders, sweep, contacts] = tables;
    const BodyMotion& a = bodies.motion[c.body_a];
    const BodyMotion& b = bodies.motion[c.body_b];
    const Collider& ca = colliders[c.collider_a];
    const Collider& cb = colliders[c.collider_b];
    const SharedShape& shape_a = colliders.shapes[ca.shape];
    const SharedShape& shape_b = colliders.shapes[cb.shape];
    const Vec3d exact_b_from_a = b.position - a.position;
    const Vec3 b_from_a = to_float(exact_b_from_a);
    // The smaller shape sets the scale; a half-space has no size.
    const float radius_a = shape_a.inner_radius > 0 ? shape_a.inner_radius : Aabb::infinity;
    const float radius_b = shape_b.inner_radius > 0 ? shape_b.inner_radius : Aabb::infinity;
    const float scale = std::min({radius_a, radius_b, 1e6f});
    const bool was_computed = c.reuse_distance > 0;
    c.reuse_distance = 0.1f * scale;
    const LocalPose pose_a = collider_pose(bodies, ca), pose_b = collider_pose(bodies, cb);
    const NearbyFrames frames(pose_a, pose_b, shape_a.shape, shape_b.shape, exact_b_from_a);
    const float margin = tables.margin(c);
    const narrow::Manifold manifold = narrow::collide(shape_a.shape, shape_b.shape, frames.b_in_a, margin);
    c.reusable = manifold.count >= 3 && !c.sensor;  // sensors report in the step in which shapes part
    if (manifold.count == 0 && c.manifolds == 0 && was_computed) return;  // nothing changes: does not load the manifold
    ContactManifold& m = contacts.manifolds.places(c)[0];
    store_manifold(c, m, in_world_axes(manifold, pose_a, pose_b, frames, is_half_space(shape_a.shape), b_from_a), a, b,
                   std::min(0.05f, 0.2f * scale));
    m.a_rolls = is_curved(shape_a.shape);
    m.b_rolls = is_curved(shape_b.shape);
}

/// Reuses or computes the manifolds of contacts, in any order.
void update_contacts(const CollideTables& tables, std::span<const std::uint32_t> list, TaskRunner& tasks) {
    ContactTable& contacts = tables.contacts;
    parallel_ranges(tasks, list.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) {
            Contact& c = contacts[list[i]];
            if (c.on_mesh || (c.reusable && reuse_manifolds(reuse_input(tables, c)))) continue;
            compute_manifolds(tables, c);
        }
    });
    std::vector<std::uint32_t> meshes;
    std::ranges::copy_if(list, std::back_inserter(meshes), [&](std::uint32_t c) { return contacts[c].on_mesh; });
    collide_with_meshes(tables, meshes, tasks);
}

/// Updates the active contacts [begin, end) and sets reused[i] for each, save those of groups. Those that may be reused
/// wait until there are four.
void update_active(const CollideTables& tables, std::size_t begin, std::size_t end, const SeamGroups& seams,
                   std::span<std::uint8_t> reused) {
    ContactTable& contacts = tables.contacts;
    ReuseInput inputs[reused_together];
    std::size_t at[reused_together], waiting = 0;
    const auto finish = [&](std::size_t i, Contact& c, bool was_reused) {
        reused[i] = was_reused ? 1 : not_reused;
        if (!was_reused) compute_manifolds(tables, c);
    };
    for (std::size_t i = begin; i < end; ++i) {
        prefetch_contact(tables.bodies, contacts, i, end);
        Contact& c = contacts[contacts.active.values[i]];
        reused[i] = c.on_mesh && !c.sensor ? on_mesh : not_reused;
        if (c.sensor || c.on_mesh || seams.is_grouped[i]) continue;
        if (!c.reusable || c.manifolds != 1) {
            finish(i, c, c.reusable && reuse_manifolds(reuse_input(tables, c)));
            continue;
        }
        at[waiting] = i;
        inputs[waiting++] = reuse_input(tables, c);
        if (waiting < reused_together) continue;
        waiting = 0;
        const unsigned bits = reuse_four(inputs);
        for (std::size_t k = 0; k < reused_together; ++k) finish(at[k], *inputs[k].contact, (bits >> k & 1) != 0);
    }
    for (std::size_t k = 0; k < waiting; ++k) finish(at[k], *inputs[k].contact, reuse_manifolds(inputs[k]));
}

/// Updates the contacts of a group, and corrects them together.
void update_group(const CollideTables& tables, float seconds, const SeamGroup& group, Constraints& constraints) {
    const std::span<SeamEntry> entries = std::span(constraints.seams.entries).subspan(group.first, group.count);
    ContactTable& contacts = tables.contacts;
    for (SeamEntry& entry : entries) {
        Contact& c = contacts[entry.contact];
        entry.before = c;
        entry.manifold_before = contacts.manifolds.places(c)[0];
        entry.reused = c.reusable && reuse_manifolds(reuse_input(tables, c));
        if (!entry.reused) compute_manifolds(tables, c);
        constraints.reused[entry.active] = entry.reused ? 1 : not_reused;
    }
    correct_group({tables.settings, tables.bodies, tables.colliders, tables.sweep, seconds}, contacts, group.mover,
                  entries, std::span(constraints.seams.contacts).subspan(group.first, group.count));
}

/// Collides the resting pairs that began or were edited. Contacts that were freed or woken meanwhile are left out.
void check_resting(const CollideTables& tables, std::vector<std::uint32_t>& checked, TaskRunner& tasks) {
    ContactTable& contacts = tables.contacts;
    checked.clear();
    checked.swap(contacts.to_check);
    std::erase_if(checked, [&](std::uint32_t c) { return contacts.graph.resting_at(c) == no_index; });
    sort_by_pair(contacts, checked);
    update_contacts(tables, checked, tasks);
}

/// Collides the active contacts that update_active() left out.
void update_meshes(const CollideTables& tables, std::vector<std::uint8_t>& reused, TaskRunner& tasks) {
    std::vector<std::uint32_t> list;
    for (std::size_t i = 0; i < reused.size(); ++i) {
        if (reused[i] != on_mesh) continue;
        reused[i] = not_reused;
        list.push_back(tables.contacts.active.values[i]);
    }
    collide_with_meshes(tables, list, tasks);
}

}  // namespace

void collide(const StepContext& context, const BodyTable& bodies, const ColliderTable& colliders, const Moved& moved,
             ContactTable& contacts, Constraints& constraints) {
    const CollideTables tables{context.settings, bodies, colliders, moved.sweep, contacts};
    check_resting(tables, constraints.checked, context.tasks);
    constraints.reused.assign(contacts.active.size(), 0);
    const SeamGroups& seams = constraints.seams;
    // What moves less than a quarter of the distance at which contacts are made cannot miss a lone piece by much.
    const float min_speed = context.seconds > 0 ? 0.25f * context.settings.speculative_distance / context.seconds : 0;
    find_seam_groups(bodies, colliders, min_speed, contacts, constraints.seams);
    parallel_ranges(context.tasks, contacts.active.size(), 64, [&](std::size_t begin, std::size_t end) {
        update_active(tables, begin, end, seams, constraints.reused);
    });
    parallel_ranges(context.tasks, seams.all.size(), 16, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) update_group(tables, context.seconds, seams.all[i], constraints);
    });
    update_meshes(tables, constraints.reused, context.tasks);
    note_middles(context.seconds, bodies, colliders, moved, contacts, constraints);
    gather_constraints(bodies, context.settings.linear_slop, contacts, constraints);
    StepReport& report = context.report;
    report.manifolds += static_cast<std::uint32_t>(constraints.all.size());
    report.contact_points += constraints.points;
    report.manifolds_reused += static_cast<std::uint32_t>(
        std::accumulate(constraints.reused.begin(), constraints.reused.end(), std::size_t{0}));
}

void collide_sensors(const StepContext& context, const BodyTable& bodies, const ColliderTable& colliders,
                     const Moved& moved, const Constraints& constraints, ContactTable& contacts) {
    const CollideTables tables{context.settings, bodies, colliders, moved.sweep, contacts};
    update_contacts(tables, constraints.sensors, context.tasks);
    for (const std::uint32_t index : constraints.sensors) {
        const Contact& c = contacts[index];
        context.report.manifolds += c.manifolds;
        context.report.contact_points += c.points;
    }
}

}  // namespace fase
