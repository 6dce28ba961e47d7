/// Stage "collide": updates the contact manifold of each active pair.
#include <algorithm>

#include "fase/narrow/dispatch.hpp"
#include "fase/world/detail/state.hpp"

namespace fase {

using dynamics::BodyMotion;
using dynamics::Contact;

namespace {

float dot4(Quat a, Quat b) { return a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w; }

/// Whether the manifold can be reused: since it was computed, the bodies moved less than `distance` relative to each
/// other, and neither rotated by more than about two degrees.
bool may_reuse(const Contact& c, const BodyMotion& a, const BodyMotion& b, Vec3 b_from_a, float distance) {
    constexpr float cosine_squared = 0.9997f;  // of half the angle
    const Vec3 moved = rotate_back(a.rotation, b_from_a) - c.b_in_a;
    if (length_squared(moved) > distance * distance) return false;
    const float cosine_a = dot4(a.rotation, c.rotation_a), cosine_b = dot4(b.rotation, c.rotation_b);
    if (!(cosine_a * cosine_a > cosine_squared && cosine_b * cosine_b > cosine_squared)) return false;
    const float relative = dot4(conjugate(a.rotation) * b.rotation, conjugate(c.rotation_a) * c.rotation_b);
    return relative * relative > cosine_squared;
}

/// Stores a new manifold (in the frame of collider a) in the contact, and gives each point the impulse of the nearest
/// old point for warm starting. Matching by position is more stable than by feature: features change on flush faces.
void store_manifold(Contact& c, const narrow::Manifold& manifold, const LocalPose& collider_a, const BodyMotion& a,
                    const BodyMotion& b, Vec3 b_from_a, float match_distance) {
    const Contact old = c;
    c.count = static_cast<std::uint8_t>(manifold.count);
    c.frozen = manifold.count >= 3;
    c.rotation_a = a.rotation;
    c.rotation_b = b.rotation;
    c.b_from_a = b_from_a;
    c.b_in_a = rotate_back(a.rotation, b_from_a);
    if (manifold.count == 0) {
        c.friction_impulse[0] = c.friction_impulse[1] = c.twist_impulse = 0;
        return;
    }
    c.normal = rotate(collider_a.rotation, manifold.normal);
    c.tangent = any_perpendicular(c.normal);
    const Vec3 second = cross(c.normal, c.tangent);
    Vec3 at[4], centre;
    for (int i = 0; i < manifold.count; ++i) {
        at[i] = transform(collider_a, manifold.points[static_cast<std::size_t>(i)].position);
        centre += at[i];
    }
    centre *= 1.0f / static_cast<float>(manifold.count);
    c.offset_a = centre;
    c.offset_b = centre - b_from_a;

    const Vec3 old_second = cross(old.normal, old.tangent);
    const Vec3 friction = old.tangent * old.friction_impulse[0] + old_second * old.friction_impulse[1];
    c.friction_impulse[0] = old.count == 0 ? 0 : dot(friction, c.tangent);
    c.friction_impulse[1] = old.count == 0 ? 0 : dot(friction, second);
    c.twist_impulse = old.count == 0 ? 0 : old.twist_impulse;
    Vec3 old_at[4];
    for (int j = 0; j < old.count; ++j) old_at[j] = old.offset_a + old.tangent * old.x[j] + old_second * old.y[j];
    bool used[4] = {};
    c.nearest = manifold.points[0].separation;
    const bool single = manifold.count == 1 && old.count == 1;
    for (int i = 0; i < manifold.count; ++i) {
        const narrow::ManifoldPoint& point = manifold.points[static_cast<std::size_t>(i)];
        c.x[i] = dot(at[i] - centre, c.tangent);
        c.y[i] = dot(at[i] - centre, second);
        c.separation[i] = point.separation;
        c.feature[i] = point.feature;
        c.nearest = std::min(c.nearest, point.separation);
        float nearest = single ? Aabb::infinity : match_distance * match_distance;
        int match = -1;
        for (int j = 0; j < old.count; ++j) {
            const float squared = length_squared(at[i] - old_at[j]);
            if (used[j] || !(squared < nearest)) continue;
            nearest = squared;
            match = j;
        }
        c.impulse[i] = match < 0 ? 0 : old.impulse[match];
        if (match >= 0) used[match] = true;
    }
}

/// Updates one contact. Returns true when its manifold was reused.
bool update_contact(WorldState& state, Contact& c) {
    const Collider& ca = state.colliders[c.collider_a];
    const Collider& cb = state.colliders[c.collider_b];
    const SharedShape& shape_a = state.shapes[ca.shape];
    const SharedShape& shape_b = state.shapes[cb.shape];
    const BodyMotion& a = state.bodies.motion[c.body_a];
    const BodyMotion& b = state.bodies.motion[c.body_b];
    const Vec3 b_from_a = to_float(b.position - a.position);
    // The smaller shape sets the scale; a half-space has no size.
    const float radius_a = shape_a.inner_radius > 0 ? shape_a.inner_radius : Aabb::infinity;
    const float radius_b = shape_b.inner_radius > 0 ? shape_b.inner_radius : Aabb::infinity;
    const float scale = std::min(radius_a, radius_b);
    if (c.frozen && c.count > 0 &&
        may_reuse(c, a, b, b_from_a, std::min(state.settings.contact_reuse_distance, 0.1f * scale)))
        return true;
    const LocalPose pose_a = collider_pose(state, ca), pose_b = collider_pose(state, cb);
    const Quat back = conjugate(pose_a.rotation);
    const LocalPose b_in_a{rotate(back, (pose_b.position + b_from_a) - pose_a.position), back * pose_b.rotation};
    const float margin =
        c.sensor ? 0.0f : state.settings.speculative_distance + state.sweep[c.body_a] + state.sweep[c.body_b];
    const narrow::Manifold manifold = narrow::collide(shape_a.shape, shape_b.shape, b_in_a, margin);
    store_manifold(c, manifold, pose_a, a, b, b_from_a, std::min(0.05f, 0.2f * scale));
    return false;
}

}  // namespace

void collide(WorldState& state, float) {
    state.reused.assign(state.active.size(), 0);
    parallel_ranges(*state.tasks, state.active.size(), 64, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            state.reused[i] = update_contact(state, state.contacts[state.active.values[i]]) ? 1 : 0;
    });
    state.touching.clear();
    StepReport& report = state.report;
    for (std::size_t i = 0; i < state.active.size(); ++i) {
        const std::uint32_t index = state.active.values[i];
        const Contact& c = state.contacts[index];
        if (c.count == 0) continue;
        ++report.manifolds;
        report.manifolds_reused += state.reused[i];
        report.contact_points += c.count;
        if (!c.sensor) state.touching.push_back(index);
    }
}

}  // namespace fase
