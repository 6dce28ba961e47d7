/// World: adding and removing bodies and colliders.
#include <algorithm>
#include <new>

#include "fase/world/detail/edit.hpp"

namespace fase {

namespace {

Result<void> check_def(const BodyDef& def) {
    if (auto r = check_position(def.position, "BodyDef.position"); !r) return r;
    if (auto rotation = check_rotation(def.rotation, "BodyDef.rotation"); !rotation) return rotation.error();
    if (!is_finite(def.linear_velocity))
        return refused("BodyDef.linear_velocity", "a number that is not finite", "m/s");
    if (!is_finite(def.angular_velocity))
        return refused("BodyDef.angular_velocity", "a number that is not finite", "rad/s");
    if (auto r = check_number(def.linear_damping, 0, "BodyDef.linear_damping"); !r) return r;
    if (auto r = check_number(def.angular_damping, 0, "BodyDef.angular_damping"); !r) return r;
    if (auto r = check_number(def.gravity_scale, -Aabb::infinity, "BodyDef.gravity_scale"); !r) return r;
    if (def.kind > BodyKind::Dynamic) return refused("BodyDef.kind", "an unknown kind", "a BodyKind");
    if (def.mass)
        if (auto checked = check(*def.mass); !checked) {
            Error error = checked.error();
            error.where = "BodyDef.mass: " + error.where;
            return error;
        }
    return {};
}

Result<void> check_def(const ColliderDef& def) {
    if (!is_finite(def.pose.position)) return refused("ColliderDef.pose", "a number that is not finite", "metres");
    if (auto rotation = check_rotation(def.pose.rotation, "ColliderDef.pose.rotation"); !rotation)
        return rotation.error();
    if (auto r = check_number(def.density, 0, "ColliderDef.density"); !r) return r;
    return check(def.material);
}

Result<void> check_collider(BodyKind kind, const Shape& shape, const ColliderDef& def) {
    if (auto checked = check(shape); !checked) return checked;
    if (auto checked = check_def(def); !checked) return checked;
    if (kind == BodyKind::Dynamic && std::holds_alternative<HalfSpace>(shape) && !def.sensor)
        return refused("World::add_collider", "a half-space on a dynamic body", "a shape with a mass",
                       "make the body static or kinematic");
    return {};
}

BodyId make_body(WorldState& state, const BodyDef& def) {
    // Allocate first, so that nothing has changed when memory runs out.
    const std::size_t slots = state.body_ids.size() + 1;
    const auto reserve_slot = [&](auto& array) {  // doubles, for amortised O(1)
        if (array.capacity() < slots) array.reserve(2 * slots);
    };
    reserve_slot(state.bodies.traits);
    reserve_slot(state.bodies.motion);
    reserve_slot(state.bodies.forces);
    reserve_slot(state.awake);
    reserve_slot(state.asleep);
    const BodyId id = state.body_ids.add();
    state.bodies.resize(state.body_ids.size());
    dynamics::BodyTraits traits;
    traits.kind = def.kind;
    traits.locks = bits_of(def.locks);
    traits.can_sleep = def.can_sleep;
    traits.linear_damping = def.linear_damping;
    traits.angular_damping = def.angular_damping;
    traits.gravity_scale = def.gravity_scale;
    traits.user = def.user;
    traits.mass_given = def.mass.has_value();
    if (def.mass) traits.mass = *def.mass;
    const bool moves = def.kind == BodyKind::Dynamic ||
                       (def.kind == BodyKind::Kinematic &&
                        (length_squared(def.linear_velocity) > 0 || length_squared(def.angular_velocity) > 0));
    if (def.kind != BodyKind::Static)
        traits.motion_state =
            moves && (def.awake || def.kind == BodyKind::Kinematic) ? MotionState::Awake : MotionState::Asleep;
    dynamics::BodyMotion motion;
    motion.position = def.position;
    motion.rotation = normalized(def.rotation);
    motion.island = id.index;
    state.bodies.traits[id.index] = traits;
    state.bodies.motion[id.index] = motion;
    state.bodies.forces[id.index] = {};
    const std::span<const std::uint32_t> one(&id.index, 1);
    if (traits.motion_state == MotionState::Awake) insert_ascending(state.awake, one);
    if (traits.motion_state == MotionState::Asleep) state.asleep.add(one, state.bodies.motion);
    update_mass(state, id.index);
    if (def.kind != BodyKind::Static) {  // BodyDef gives the velocity of the centre of mass
        state.bodies.motion[id.index].linear_velocity = def.linear_velocity;
        state.bodies.motion[id.index].angular_velocity = def.angular_velocity;
    }
    return id;
}

void unlink_collider(WorldState& state, std::uint32_t index) {
    dynamics::BodyTraits& traits = state.bodies.traits[state.colliders[index].body];
    std::uint32_t* link = &traits.first_collider;
    while (*link != index) link = &state.colliders[*link].next;
    *link = state.colliders[index].next;
}

/// Removes a collider from everything except the collider list of its body.
void drop_collider(WorldState& state, std::uint32_t index) {
    const Collider& collider = state.colliders[index];
    broad::AnyStructure& boxes = state.box_sets.of(state.bodies.traits[collider.body].motion_state);
    boxes.erase(std::span(&index, 1));
    release_shape(state, collider.shape);
    state.collider_ids.remove(*state.collider_ids.id_at(index));
    mark_edited(state, index);
    state.removed_any = true;
}

ColliderId make_collider(WorldState& state, std::uint32_t body, const Shape& shape, const ColliderDef& def) {
    const std::uint32_t shared = share_shape(state, shape);
    const ColliderId id = state.collider_ids.add();
    const std::size_t slots = state.collider_ids.size();
    state.colliders.resize(slots);
    state.boxes.resize(slots);
    state.changes.resize(slots, 0);
    Collider& collider = state.colliders[id.index];
    collider = {};
    collider.body = body;
    collider.shape = shared;
    collider.sensor = def.sensor;
    collider.in_body = {def.pose.position, normalized(def.pose.rotation)};
    collider.material = def.material;
    collider.density = def.density;
    collider.filter = def.filter;
    collider.user = def.user;
    dynamics::BodyTraits& traits = state.bodies.traits[body];
    std::uint32_t* link = &traits.first_collider;
    while (*link != no_index) link = &state.colliders[*link].next;
    *link = id.index;
    const LocalPose frame_before = traits.principal;
    update_mass(state, body);
    state.boxes[id.index] = speculative_box(state, id.index, 0, 0);
    const broad::Move move{id.index, state.boxes[id.index]};
    broad::AnyStructure& boxes = state.box_sets.of(traits.motion_state);
    boxes.insert(std::span(&move, 1));
    mark_edited(state, id.index);
    if (!(frame_before == traits.principal)) update_boxes(state, body);
    return id;
}

}  // namespace

Result<BodyId> World::add_body(const BodyDef& def) {
    if (auto checked = check_def(def); !checked) return checked.error();
    if (state_->stepping) return Error{Status::Busy, "World::add_body", "called from inside a step", "call it after"};
    try {
        return make_body(*state_, def);
    } catch (const std::bad_alloc&) {
        return Error{Status::NoMemory, "World::add_body", "out of memory for a body", ""};
    }
}

Result<BodyId> World::add_body(const BodyDef& def, const Shape& shape, const ColliderDef& collider) {
    if (auto checked = check_collider(def.kind, shape, collider); !checked) return checked.error();
    const auto body = add_body(def);
    if (!body) return body;
    if (auto added = add_collider(*body, shape, collider); !added) {
        static_cast<void>(remove_body(*body));
        return added.error();
    }
    // The collider may have moved the centre of mass; BodyDef gives the velocity of the new one.
    if (def.kind != BodyKind::Static) state_->bodies.motion[body->index].linear_velocity = def.linear_velocity;
    if (!def.awake) std::erase(state_->bodies_to_wake, body->index);
    return body;
}

Result<ColliderId> World::add_collider(BodyId body, const Shape& shape, const ColliderDef& def) {
    if (!contains(body)) return stale_id("World::add_collider");
    const BodyKind kind = state_->bodies.traits[body.index].kind;
    if (auto checked = check_collider(kind, shape, def); !checked) return checked.error();
    try {
        request_wake(*state_, body.index);
        return make_collider(*state_, body.index, shape, def);
    } catch (const std::bad_alloc&) {
        return Error{Status::NoMemory, "World::add_collider", "out of memory for a collider", ""};
    }
}

Result<void> World::remove_collider(ColliderId collider) {
    if (!contains(collider)) return stale_id("World::remove_collider");
    const std::uint32_t body = state_->colliders[collider.index].body;
    request_wake(*state_, body);
    unlink_collider(*state_, collider.index);
    drop_collider(*state_, collider.index);
    update_mass(*state_, body);
    update_boxes(*state_, body);
    return {};
}

Result<void> World::remove_body(BodyId body) {
    if (!contains(body)) return stale_id("World::remove_body");
    WorldState& state = *state_;
    for (std::uint32_t c = state.bodies.traits[body.index].first_collider; c != no_index;) {
        const std::uint32_t next = state.colliders[c].next;
        drop_collider(state, c);
        c = next;
    }
    const std::span<const std::uint32_t> one(&body.index, 1);
    erase_ascending(state.awake, one);
    state.asleep.remove(one);
    std::erase(state.bodies_to_wake, body.index);
    state.exclusions.remove_all_of(body.index);
    state.bodies.traits[body.index] = {};
    state.body_ids.remove(body);
    return {};
}

}  // namespace fase
