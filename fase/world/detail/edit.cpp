/// Updates boxes, masses and shared shapes when bodies are edited.
#include "fase/world/detail/edit.hpp"

#include <algorithm>

#include "fase/core/hash.hpp"
#include "fase/geometry/bounds.hpp"

namespace fase {

Error stale_id(const char* where) {
    return {Status::BadHandle, where, "found an id that is stale or of another world",
            "an id is valid until its body or collider is removed, and only in its own world"};
}

Error refused(std::string where, std::string found, std::string expected, std::string remedy) {
    return {Status::BadArgument, std::move(where), "found " + found + "; expected " + expected, std::move(remedy)};
}

void mark_edited(WorldState& state, std::uint32_t collider) {
    mark_box_changed(state, collider);
    if (!(state.changes[collider] & edited)) state.edited_colliders.push_back(collider);
    state.changes[collider] |= edited;
}

void update_box(WorldState& state, std::uint32_t collider) {
    state.boxes[collider] = speculative_box(state, collider, 0, 0);
    const broad::Move move{collider, state.boxes[collider]};
    broad::AnyStructure& boxes = state.box_sets.of(state.bodies.traits[state.colliders[collider].body].motion_state);
    boxes.move(std::span(&move, 1));
    mark_edited(state, collider);
}

void update_boxes(WorldState& state, std::uint32_t body) {
    for (std::uint32_t c = state.bodies.traits[body].first_collider; c != no_index; c = state.colliders[c].next)
        update_box(state, c);
}

void update_mass(WorldState& state, std::uint32_t body) {
    dynamics::BodyTraits& traits = state.bodies.traits[body];
    dynamics::BodyMotion& motion = state.bodies.motion[body];
    const Pose pose = body_pose(traits, motion);
    const Vec3d centre_before = motion.position;
    if (!traits.mass_given) {
        std::vector<MassProperties> parts;
        for (std::uint32_t c = traits.first_collider; c != no_index; c = state.colliders[c].next) {
            const Collider& collider = state.colliders[c];
            if (!collider.sensor && collider.density > 0)
                parts.push_back(transformed(mass_properties(state.shapes[collider.shape].shape, collider.density),
                                            collider.in_body));
        }
        traits.mass = combined(parts);
    }
    const PrincipalInertia inertia = principal(traits.mass.inertia);
    traits.principal = {traits.mass.centre, inertia.axes};
    const bool dynamic = traits.kind == BodyKind::Dynamic && traits.mass.mass > 0;
    const auto inverted = [&](float moment) { return dynamic && moment > 0 ? 1 / moment : 0.0f; };
    traits.inverse_mass = dynamic ? 1 / traits.mass.mass : 0;
    traits.inverse_moments = {inverted(inertia.moments.x), inverted(inertia.moments.y), inverted(inertia.moments.z)};
    const Pose placed = pose * traits.principal;
    motion.position = placed.position;
    motion.rotation = normalized(placed.rotation);
    motion.linear_velocity += cross(motion.angular_velocity, to_float(motion.position - centre_before));

    const LocalPose back = inverse(traits.principal);
    traits.reach = 0;
    traits.inner_radius = Aabb::infinity;
    for (std::uint32_t c = traits.first_collider; c != no_index; c = state.colliders[c].next) {
        Collider& collider = state.colliders[c];
        collider.in_principal = back * collider.in_body;
        const SharedShape& shape = state.shapes[collider.shape];
        traits.reach = std::max(traits.reach, length(collider.in_principal.position) + shape.outer_radius);
        if (!collider.sensor) traits.inner_radius = std::min(traits.inner_radius, shape.inner_radius);
    }
}

namespace {

std::uint64_t content_key(const Shape& shape) {
    Hasher hasher;
    hasher.add(shape.index());
    const auto add = [&](Vec3 v) {
        hasher.add(v.x);
        hasher.add(v.y);
        hasher.add(v.z);
    };
    if (const auto* hull = std::get_if<ConvexHull>(&shape))
        for (const Vec3 v : hull->vertices) add(v);
    const Aabb box = bounds(shape, Pose{});
    add(box.lo);
    add(box.hi);
    return hasher.value();
}

}  // namespace

std::uint32_t share_shape(WorldState& state, const Shape& shape) {
    const std::uint64_t key = content_key(shape);
    const auto [begin, end] = state.shape_of_key.equal_range(key);
    for (auto at = begin; at != end; ++at)
        if (state.shapes[at->second].shape == shape) {
            ++state.shapes[at->second].users;
            return at->second;
        }
    SharedShape shared{shape, 1, outer_radius(shape), inner_radius(shape), key};
    std::uint32_t index = static_cast<std::uint32_t>(state.shapes.size());
    if (state.free_shapes.empty()) {
        state.shapes.push_back(std::move(shared));
    } else {
        index = state.free_shapes.back();
        state.free_shapes.pop_back();
        state.shapes[index] = std::move(shared);
    }
    state.shape_of_key.emplace(key, index);
    return index;
}

void release_shape(WorldState& state, std::uint32_t index) {
    SharedShape& shared = state.shapes[index];
    if (--shared.users != 0) return;
    const auto [begin, end] = state.shape_of_key.equal_range(shared.key);
    for (auto at = begin; at != end; ++at)
        if (at->second == index) {
            state.shape_of_key.erase(at);
            break;
        }
    shared = {};
    state.free_shapes.push_back(index);
}

}  // namespace fase
