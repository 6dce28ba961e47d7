/// World: adding and removing bodies and colliders.
#include <algorithm>
#include <new>

#include "fase/world/detail/edit.hpp"

namespace fase {

namespace {

Result<void> check_collider(BodyKind kind, const Shape& shape, const ColliderDef& def, const char* where) {
    if (auto checked = check(shape); !checked) return checked;
    if (auto checked = check(def); !checked) return checked;
    if (kind == BodyKind::Dynamic && !is_solid(shape) && !def.sensor)
        return refused(where, std::string("a ") + noun_of(shape) + " on a dynamic body", "a shape with a mass",
                       "make the body static or kinematic");
    return {};
}

/// Adds a body after reserve_body(). `shape` is that of the body without colliders.
BodyId make_body(WorldState& state, const BodyDef& def, const BodyShape& shape) {
    const BodyId id = state.bodies.ids.add();
    state.bodies.resize(state.bodies.ids.size());
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
    if (traits.motion_state == MotionState::Awake) state.bodies.awake_added.push_back(id.index);
    if (traits.motion_state == MotionState::Asleep) state.bodies.asleep.add(one, state.bodies.motion);
    set_shape(state, id.index, shape);
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

/// Removes a collider from everything except the collider list of its body. `removed` has room.
void drop_collider(WorldState& state, std::uint32_t index) {
    state.contacts.removed.push_back(event_collider(state.bodies, state.colliders, index));
    release_shape(state, state.colliders[index].shape);
    state.colliders.ids.remove(*state.colliders.ids.id_at(index));
    mark_edited(state.broad_phase, state.query, index);
    state.broad_phase.removed_any = true;
}

/// Makes a collider after reserve_colliders(). It is not yet in the list of its body, and has no box.
ColliderId new_collider(WorldState& state, std::uint32_t body, std::uint32_t shared, const ColliderDef& def) {
    const ColliderId id = state.colliders.ids.add();
    const std::size_t slots = state.colliders.ids.size();
    state.colliders.all.resize(slots);
    state.broad_phase.boxes.resize(slots);
    state.broad_phase.changes.resize(slots, 0);
    state.broad_phase.set_of.resize(slots, 0);
    Collider& collider = state.colliders[id.index];
    collider = {};
    collider.body = body;
    collider.shape = shared;
    collider.sensor = def.sensor;
    collider.in_body = {def.pose.position, normalized(def.pose.rotation)};
    collider.material = def.material;
    collider.density = def.density;
    collider.filter = def.filter;
    collider.user = def.user != 0 ? def.user : state.bodies.traits[body].user;
    return id;
}

/// Adds a collider after reserve_colliders(). `shared` is its shape; `shape` that of the body with it.
ColliderId make_collider(WorldState& state, std::uint32_t body, std::uint32_t shared, const ColliderDef& def,
                         const BodyShape& shape) {
    const ColliderId id = new_collider(state, body, shared, def);
    dynamics::BodyTraits& traits = state.bodies.traits[body];
    std::uint32_t* link = &traits.first_collider;
    while (*link != no_index) link = &state.colliders[*link].next;
    *link = id.index;
    const LocalPose frame_before = traits.principal;
    set_shape(state, body, shape);
    update_box(state, id.index);
    if (!(frame_before == traits.principal)) update_boxes(state, body);
    return id;
}

/// Gives a new body all its colliders after reserve_colliders(). `shared` are their shapes; `shape` that of the body.
/// Returns the first.
ColliderId make_colliders(WorldState& state, std::uint32_t body, std::span<const ColliderShape> parts,
                          std::span<const std::uint32_t> shared, const BodyShape& shape) {
    ColliderId first, last;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const ColliderId made = new_collider(state, body, shared[i], parts[i].def);
        if (i == 0) {
            first = made;
            state.bodies.traits[body].first_collider = made.index;
        } else {
            state.colliders[last.index].next = made.index;
        }
        last = made;
    }
    set_shape(state, body, shape);
    update_boxes(state, body);
    return first;
}

/// The body of a definition, without colliders.
BodyEdit edit_of(const BodyDef& def) {
    BodyEdit edit;
    edit.kind = def.kind;
    edit.mass_given = def.mass.has_value();
    if (def.mass) edit.mass = *def.mass;
    return edit;
}

}  // namespace

Result<NewBody> World::add_body(const BodyDef& def) {
    return guarded(*state_, "World::add_body", [&]() -> Result<NewBody> {
        if (auto checked = check(def); !checked) return checked.error();
        if (state_->stepping)
            return Error{Status::Busy, "World::add_body", "called from inside a step", "call it after"};
        const auto shape =
            checked_shape_of(*state_, edit_of(def), {def.position, normalized(def.rotation)}, "BodyDef: ");
        if (!shape) return shape.error();
        reserve_body(*state_);
        return NewBody{make_body(*state_, def, *shape), {}};
    });
}

Result<NewBody> World::add_body(const BodyDef& def, const Shape& shape, const ColliderDef& collider) {
    return guarded(*state_, "World::add_body", [&]() -> Result<NewBody> {
        WorldState& state = *state_;
        if (auto checked = check_collider(def.kind, shape, collider, "World::add_body"); !checked)
            return checked.error();
        if (auto checked = check(def); !checked) return checked.error();
        if (state.stepping) return Error{Status::Busy, "World::add_body", "called from inside a step", "call it after"};
        const Pose pose{def.position, normalized(def.rotation)};
        BodyEdit edit = edit_of(def);
        const auto bare = checked_shape_of(state, edit, pose, "BodyDef: ");
        if (!bare) return bare.error();
        edit.added = &shape;
        edit.added_def = &collider;
        const auto complete = checked_shape_of(state, edit, pose, "World::add_body: ");
        if (!complete) return complete.error();
        reserve_body(state);
        reserve_colliders(state, 1);
        const std::uint32_t shared = share_shape(state, shape);
        const BodyId body = make_body(state, def, *bare);
        const ColliderId made = make_collider(state, body.index, shared, collider, *complete);
        // The collider may have moved the centre of mass; BodyDef gives the velocity of the new one.
        if (def.kind != BodyKind::Static) state.bodies.motion[body.index].linear_velocity = def.linear_velocity;
        return NewBody{body, made};
    });
}

Result<NewBody> World::add_body(const BodyDef& def, std::span<const ColliderShape> colliders) {
    return guarded(*state_, "World::add_body", [&]() -> Result<NewBody> {
        WorldState& state = *state_;
        for (std::size_t i = 0; i < colliders.size(); ++i)
            if (auto checked = check_collider(def.kind, colliders[i].shape, colliders[i].def, ""); !checked) {
                Error error = checked.error();
                error.where = "World::add_body: colliders[" + std::to_string(i) + "]" +
                              (error.where.empty() ? "" : ": " + error.where);
                return error;
            }
        if (auto checked = check(def); !checked) return checked.error();
        if (state.stepping) return Error{Status::Busy, "World::add_body", "called from inside a step", "call it after"};
        const Pose pose{def.position, normalized(def.rotation)};
        BodyEdit edit = edit_of(def);
        const auto bare = checked_shape_of(state, edit, pose, "BodyDef: ");
        if (!bare) return bare.error();
        edit.parts = colliders;
        const auto complete = checked_shape_of(state, edit, pose, "World::add_body: ");
        if (!complete) return complete.error();
        reserve_body(state);
        reserve_colliders(state, colliders.size());
        const std::vector<std::uint32_t> shared = share_shapes(state, colliders);
        const BodyId body = make_body(state, def, *bare);
        const ColliderId first = make_colliders(state, body.index, colliders, shared, *complete);
        // The colliders have moved the centre of mass; BodyDef gives the velocity of the new one.
        if (def.kind != BodyKind::Static) state.bodies.motion[body.index].linear_velocity = def.linear_velocity;
        return NewBody{body, first};
    });
}

Result<ColliderId> World::add_collider(BodyId body, const Shape& shape, const ColliderDef& def) {
    return guarded(*state_, "add_collider", [&]() -> Result<ColliderId> {
        WorldState& state = *state_;
        if (!contains(body)) return invalid_id(*state_, body, "World::add_collider");
        const dynamics::BodyTraits& traits = state.bodies.traits[body.index];
        if (auto checked = check_collider(traits.kind, shape, def, "World::add_collider"); !checked)
            return checked.error();
        BodyEdit edit = fase::edit_of(state, body.index);
        edit.added = &shape;
        edit.added_def = &def;
        const Pose pose = body_pose(traits, state.bodies.motion[body.index]);
        const auto complete = checked_shape_of(state, edit, pose, "World::add_collider: ");
        if (!complete) return complete.error();
        reserve_colliders(state, 1);
        reserve_wakes(state, 1);
        const std::uint32_t shared = share_shape(state, shape);
        disturb(state.bodies, state.settings, body.index);
        return make_collider(state, body.index, shared, def, *complete);
    });
}

Result<void> World::remove_collider(ColliderId collider) {
    return guarded(*state_, "remove_collider", [&]() -> Result<void> {
        WorldState& state = *state_;
        if (!contains(collider)) return invalid_id(*state_, collider, "World::remove_collider");
        const std::uint32_t body = state.colliders[collider.index].body;
        BodyEdit edit = fase::edit_of(state, body);
        edit.removed = collider.index;
        const Pose pose = body_pose(state.bodies.traits[body], state.bodies.motion[body]);
        const auto rest = checked_shape_of(state, edit, pose, "World::remove_collider: ");
        if (!rest) return rest.error();
        reserve_wakes(state, 1);
        reserve_for(state.contacts.removed, state.contacts.removed.size() + 1);
        disturb(state.bodies, state.settings, body);
        unlink_collider(state, collider.index);
        drop_collider(state, collider.index);
        set_shape(state, body, *rest);
        update_boxes(state, body);
        return {};
    });
}

Result<void> World::remove_body(BodyId body) {
    return guarded(*state_, "remove_body", [&]() -> Result<void> {
        if (!contains(body)) return invalid_id(*state_, body, "World::remove_body");
        WorldState& state = *state_;
        std::size_t colliders = 0;
        for (std::uint32_t c = state.bodies.traits[body.index].first_collider; c != no_index;
             c = state.colliders[c].next)
            ++colliders;
        reserve_for(state.contacts.removed, state.contacts.removed.size() + colliders);
        for (std::uint32_t c = state.bodies.traits[body.index].first_collider; c != no_index;) {
            const std::uint32_t next = state.colliders[c].next;
            drop_collider(state, c);
            c = next;
        }
        const std::span<const std::uint32_t> one(&body.index, 1);
        remove_awake(state.bodies, body.index);
        state.bodies.asleep.remove(one);
        std::erase(state.bodies.to_wake, body.index);
        std::erase(state.bodies.let_go, body.index);
        state.bodies.exclusions.remove_all_of(body.index);
        state.bodies.traits[body.index] = {};
        state.bodies.ids.remove(body);
        return {};
    });
}

}  // namespace fase
