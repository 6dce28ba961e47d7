/// Updates boxes, masses and shared shapes when bodies are edited.
#include "fase/world/detail/edit.hpp"

#include <algorithm>

#include "fase/core/hash.hpp"
#include "fase/geometry/bounds.hpp"
#include "fase/world/detail/collider_places.hpp"

namespace fase {

namespace {

/// `noun`: what the id names.
template <class Tag>
Error invalid_id(const IdPool<Tag>& ids, Id<Tag> id, const char* where, const std::string& noun, const char* source) {
    const std::string place = " (index " + std::to_string(id.index) + ")";
    if (id == Id<Tag>{})
        return {Status::BadHandle, where, "found the default id, which names no " + noun,
                std::string("use the id that ") + source + " returned"};
    if (id.owner != ids.owner())
        return {Status::BadHandle, where, "found the id of a " + noun + " of another world" + place,
                "a world that restored a snapshot knows the ids of the world that took it"};
    const bool was_issued =
        id.index < ids.newest().size() && id.generation > 0 && id.generation <= ids.newest()[id.index];
    if (!was_issued)
        return {Status::BadHandle, where, "found an id that this world never issued" + place,
                std::string("use the id that ") + source + " returned"};
    return {Status::BadHandle, where, "found the id of a " + noun + " that was removed" + place,
            "World::contains() tells whether an id is valid"};
}

}  // namespace

Error invalid_id(const WorldState& state, BodyId id, const char* where) {
    return invalid_id(state.bodies.ids, id, where, "body", "add_body()");
}

Error invalid_id(const WorldState& state, ColliderId id, const char* where) {
    return invalid_id(state.colliders.ids, id, where, "collider", "add_body() or add_collider()");
}

Error refused(std::string where, std::string found, std::string expected, std::string remedy) {
    return {Status::BadArgument, std::move(where), "found " + found + "; expected " + expected, std::move(remedy)};
}

Error broken_world(const char* where) {
    return {Status::NoMemory, where, "found a world whose last step ran out of memory; expected a complete state",
            "restore a snapshot"};
}

void reserve_body(WorldState& state) {
    const std::size_t slots = state.bodies.ids.reserve_adds(1);
    reserve_for(state.bodies.traits, slots);
    reserve_for(state.bodies.motion, slots);
    reserve_for(state.bodies.forces, slots);
    reserve_for(state.bodies.awake, slots);
    reserve_for(state.bodies.awake_added, slots);
    reserve_for(state.bodies.asleep, slots);
}

void reserve_colliders(WorldState& state, std::size_t count) {
    const std::size_t slots = state.colliders.ids.reserve_adds(count);
    reserve_for(state.colliders.all, slots);
    reserve_for(state.broad_phase.boxes, slots);
    reserve_for(state.broad_phase.changes, slots);
    reserve_for(state.broad_phase.set_of, slots);
    reserve_for(state.broad_phase.edited_colliders, slots);
}

void update_box(WorldState& state, std::uint32_t collider) {
    state.broad_phase.boxes[collider] =
        speculative_box(state.bodies, state.colliders, collider, state.settings.speculative_distance);
    mark_edited(state.broad_phase, state.query, collider);
}

void update_boxes(WorldState& state, std::uint32_t body) {
    for (std::uint32_t c = state.bodies.traits[body].first_collider; c != no_index; c = state.colliders[c].next)
        update_box(state, c);
}

BodyEdit edit_of(const WorldState& state, std::uint32_t body) {
    const dynamics::BodyTraits& traits = state.bodies.traits[body];
    return {traits.kind, traits.mass_given, traits.mass, traits.first_collider, no_index, nullptr, nullptr, {}};
}

BodyShape shape_of(const WorldState& state, const BodyEdit& edit) {
    /// Calls f(shape, pose in the body's frame, density, sensor, outer radius, inner radius) for each collider.
    const auto for_each = [&](const auto& f) {
        for (std::uint32_t c = edit.first_collider; c != no_index; c = state.colliders[c].next) {
            if (c == edit.removed) continue;
            const Collider& collider = state.colliders[c];
            const SharedShape& shared = state.colliders.shapes[collider.shape];
            f(shared.shape, collider.in_body, collider.density, collider.sensor, shared.outer_radius,
              shared.inner_radius);
        }
        const auto add = [&](const Shape& shape, const ColliderDef& def) {
            f(shape, LocalPose{def.pose.position, normalized(def.pose.rotation)}, def.density, def.sensor,
              outer_radius(shape), inner_radius(shape));
        };
        if (edit.added != nullptr) add(*edit.added, *edit.added_def);
        for (const ColliderShape& part : edit.parts) add(part.shape, part.def);
    };
    BodyShape out;
    out.mass = edit.mass;
    if (!edit.mass_given) {
        std::vector<MassProperties> parts;
        for_each([&](const Shape& shape, const LocalPose& in_body, float density, bool sensor, float, float) {
            if (!sensor && density > 0) parts.push_back(transformed(mass_properties(shape, density), in_body));
        });
        out.mass = combined(parts);
    }
    const PrincipalInertia inertia = principal(out.mass.inertia);
    out.principal = {out.mass.centre, inertia.axes};
    const bool dynamic = edit.kind == BodyKind::Dynamic && out.mass.mass > 0;
    const auto inverted = [&](float moment) { return dynamic && moment > 0 ? 1 / moment : 0.0f; };
    out.inverse_mass = dynamic ? 1 / out.mass.mass : 0;
    out.inverse_moments = {inverted(inertia.moments.x), inverted(inertia.moments.y), inverted(inertia.moments.z)};
    const LocalPose back = inverse(out.principal);
    out.inner_radius = Aabb::infinity;
    for_each([&](const Shape&, const LocalPose& in_body, float, bool sensor, float outer, float inner) {
        out.reach = std::max(out.reach, length((back * in_body).position) + outer);
        if (!sensor) out.inner_radius = std::min(out.inner_radius, inner);
    });
    return out;
}

Result<BodyShape> checked_shape_of(const WorldState& state, const BodyEdit& edit, const Pose& pose,
                                   const std::string& where) {
    const BodyShape shape = shape_of(state, edit);
    const Vec3 moments = principal(shape.mass.inertia).moments;
    if (auto checked = check_combined_mass(shape.mass, moments, where + "combined "); !checked) return checked.error();
    if (auto checked = check_position((pose * shape.principal).position, where + "centre of mass"); !checked)
        return checked.error();
    return shape;
}

void set_shape(WorldState& state, std::uint32_t body, const BodyShape& shape) {
    dynamics::BodyTraits& traits = state.bodies.traits[body];
    dynamics::BodyMotion& motion = state.bodies.motion[body];
    const Pose pose = body_pose(traits, motion);
    const Vec3d centre_before = motion.position;
    traits.mass = shape.mass;
    traits.principal = shape.principal;
    traits.inverse_mass = shape.inverse_mass;
    traits.inverse_moments = shape.inverse_moments;
    traits.reach = shape.reach;
    traits.inner_radius = shape.inner_radius;
    const Pose placed = pose * traits.principal;
    motion.position = placed.position;
    motion.rotation = normalized(placed.rotation);
    motion.linear_velocity += cross(motion.angular_velocity, to_float(motion.position - centre_before));
    const LocalPose back = inverse(traits.principal);
    for (std::uint32_t c = traits.first_collider; c != no_index; c = state.colliders[c].next)
        state.colliders[c].in_principal = back * state.colliders[c].in_body;
}

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
    if (const auto* mesh = std::get_if<Mesh>(&shape)) {
        hasher.add(mesh->data->content_hash());
        add(mesh->scale);
    }
    const Aabb box = bounds(shape, Pose{});
    add(box.lo);
    add(box.hi);
    return hasher.value();
}

std::uint32_t share_shape(WorldState& state, const Shape& shape) {
    const std::uint64_t key = content_key(shape);
    const auto [begin, end] = state.colliders.shape_of_key.equal_range(key);
    for (auto at = begin; at != end; ++at)
        if (state.colliders.shapes[at->second].shape == shape) {
            ++state.colliders.shapes[at->second].users;
            return at->second;
        }
    SharedShape shared{shape, 1, outer_radius(shape), inner_radius(shape), key};
    const bool is_new_slot = state.colliders.free_shapes.empty();
    const auto index =
        is_new_slot ? static_cast<std::uint32_t>(state.colliders.shapes.size()) : state.colliders.free_shapes.back();
    if (is_new_slot) {
        reserve_for(state.colliders.shapes, state.colliders.shapes.size() + 1);
        reserve_for(state.colliders.free_shapes, state.colliders.shapes.size() + 1);  // release_shape() cannot fail
    }
    state.colliders.shape_of_key.emplace(key, index);
    if (is_new_slot) {
        state.colliders.shapes.push_back(std::move(shared));
    } else {
        state.colliders.free_shapes.pop_back();
        state.colliders.shapes[index] = std::move(shared);
    }
    state.colliders.meshes += is_mesh(shape) ? 1 : 0;
    return index;
}

std::vector<std::uint32_t> share_shapes(WorldState& state, std::span<const ColliderShape> parts) {
    const std::size_t slots = state.colliders.shapes.size();
    std::vector<std::uint32_t> shared;
    shared.reserve(parts.size());
    try {
        for (const ColliderShape& part : parts) shared.push_back(share_shape(state, part.shape));
    } catch (...) {
        // Undone backwards: a new slot is the last one again when its first user goes.
        for (; !shared.empty(); shared.pop_back()) {
            release_shape(state, shared.back());
            if (shared.back() < slots || state.colliders.shapes[shared.back()].users != 0) continue;
            state.colliders.shapes.pop_back();
            state.colliders.free_shapes.pop_back();
        }
        throw;
    }
    return shared;
}

void release_shape(WorldState& state, std::uint32_t index) {
    SharedShape& shared = state.colliders.shapes[index];
    if (--shared.users != 0) return;
    const auto [begin, end] = state.colliders.shape_of_key.equal_range(shared.key);
    for (auto at = begin; at != end; ++at)
        if (at->second == index) {
            state.colliders.shape_of_key.erase(at);
            break;
        }
    state.colliders.meshes -= is_mesh(shared.shape) ? 1 : 0;
    shared = {};
    state.colliders.free_shapes.push_back(index);
}

}  // namespace fase
