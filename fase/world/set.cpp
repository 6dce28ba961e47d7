/// World: changing bodies, applying forces and impulses.
#include <algorithm>

#include "fase/core/detail/text.hpp"
#include "fase/world/detail/edit.hpp"

namespace fase {

namespace {

/// Checks the sum of all forces and torques since the last step.
Result<void> check_forces(const dynamics::BodyForces& sum, const std::string& where) {
    if (auto checked = check_vector(sum.force, limits::force, where + ": sum of forces"); !checked) return checked;
    return check_vector(sum.torque, limits::torque, where + ": sum of torques");
}
Error not_dynamic(const std::string& where) {
    return refused(where, "a static or kinematic body", "a dynamic one", "give kinematic bodies a velocity instead");
}
Vec3 inverse_inertia_times(const dynamics::BodyTraits& traits, const dynamics::BodyMotion& motion, Vec3 torque) {
    const auto free = [&](Vec3 v) {
        return Vec3{traits.locks & 8 ? 0 : v.x, traits.locks & 16 ? 0 : v.y, traits.locks & 32 ? 0 : v.z};
    };
    const Vec3 local = rotate_back(motion.rotation, free(torque));
    return free(rotate(motion.rotation, multiply(local, traits.inverse_moments)));
}

/// Sets the velocities of a body that exists; `where` names the call.
Result<void> set_velocity(WorldState& state, std::uint32_t body, Vec3 linear, Vec3 angular, const char* where) {
    if (auto checked = check_velocity(linear, angular, where); !checked) return checked;
    reserve_wakes(state, 1);
    dynamics::BodyMotion& motion = state.bodies.motion[body];
    motion.linear_velocity = linear;
    motion.angular_velocity = angular;
    disturb(state.bodies, state.settings, body);
    return {};
}

/// Adds a force on a body that exists; `where` names the call.
Result<void> add_force(WorldState& state, std::uint32_t body, Vec3 newtons, Vec3d point, const std::string& where) {
    if (auto checked = check_vector(newtons, limits::force, where + ": newtons"); !checked) return checked;
    if (auto checked = check_position(point, where + ": point"); !checked) return checked;
    if (state.bodies.traits[body].kind != BodyKind::Dynamic) return not_dynamic(where);
    if (newtons == Vec3{}) return {};
    const Vec3 arm = to_float(point - state.bodies.motion[body].position);
    dynamics::BodyForces sum = state.bodies.forces[body];
    sum.force += newtons;
    sum.torque += cross(arm, newtons);
    if (auto checked = check_forces(sum, where); !checked) return checked;
    reserve_wakes(state, 1);
    state.bodies.forces[body] = sum;
    disturb(state.bodies, state.settings, body);
    return {};
}

/// Applies an impulse to a body that exists; `where` names the call.
Result<void> add_impulse(WorldState& state, std::uint32_t body, Vec3 newton_seconds, Vec3d point,
                         const std::string& where) {
    if (auto checked = check_vector(newton_seconds, limits::force, where + ": newton_seconds"); !checked)
        return checked;
    if (auto checked = check_position(point, where + ": point"); !checked) return checked;
    const dynamics::BodyTraits& traits = state.bodies.traits[body];
    if (traits.kind != BodyKind::Dynamic) return not_dynamic(where);
    dynamics::BodyMotion& motion = state.bodies.motion[body];
    const Vec3 linear = motion.linear_velocity + newton_seconds * traits.inverse_mass;
    const Vec3 angular =
        motion.angular_velocity +
        inverse_inertia_times(traits, motion, cross(to_float(point - motion.position), newton_seconds));
    if (auto checked = check_velocity(linear, angular, where + ": "); !checked) return checked;
    reserve_wakes(state, 1);
    motion.linear_velocity = linear;
    motion.angular_velocity = angular;
    disturb(state.bodies, state.settings, body);
    return {};
}

/// The next step looks for pairs of two bodies anew, from the side of the one that does not hold a whole world.
void update_pairs_between(WorldState& state, std::uint32_t a, std::uint32_t b) {
    update_boxes(state, state.bodies.traits[a].kind == BodyKind::Dynamic ? a : b);
}

}  // namespace

void reserve_pair_moves(WorldState& state, std::uint32_t body) {
    std::size_t contacts = 0;
    for (std::uint32_t c = state.bodies.traits[body].first_collider; c != no_index; c = state.colliders[c].next)
        state.contacts.graph.for_each_of(c, [&](std::uint32_t) { ++contacts; });
    state.contacts.active.reserve(state.contacts.active.size() + contacts);
    state.contacts.resting.reserve(state.contacts.resting.size() + contacts);
    reserve_for(state.contacts.to_check, state.contacts.to_check.size() + contacts);
    reserve_for(state.contacts.woken, contacts);
    reserve_for(state.contacts.woken_pairs, contacts);
}

void update_motion_state(WorldState& state, std::uint32_t body) {
    dynamics::BodyTraits& traits = state.bodies.traits[body];
    const dynamics::BodyMotion& motion = state.bodies.motion[body];
    const bool moves = length_squared(motion.linear_velocity) > 0 || length_squared(motion.angular_velocity) > 0;
    const MotionState now = traits.kind == BodyKind::Static    ? MotionState::Static
                            : traits.quarantined               ? MotionState::Asleep
                            : traits.kind == BodyKind::Dynamic ? MotionState::Awake
                            : moves                            ? MotionState::Awake
                                                               : MotionState::Asleep;
    if (now == traits.motion_state) return;
    const std::span<const std::uint32_t> one(&body, 1);
    remove_awake(state.bodies, body);
    state.bodies.asleep.remove(one);
    traits.motion_state = now;
    state.bodies.motion[body].island = body;
    state.bodies.motion[body].sleep_time = 0;
    if (now == MotionState::Awake) insert_ascending(state.bodies.awake, one);
    if (now == MotionState::Asleep) state.bodies.asleep.add(one, state.bodies.motion);
    update_pair_lists(state.bodies, state.colliders, state.broad_phase, state.contacts, one);
    update_boxes(state, body);
}

Result<void> World::set_settings(const Settings& settings) {
    return guarded(*state_, "set_settings", [&]() -> Result<void> {
        if (auto checked = check(settings); !checked) return checked;
        const Settings& before = state_->settings;
        const bool disturbs = !(before.gravity == settings.gravity) ||
                              before.contact_frequency != settings.contact_frequency ||
                              before.contact_damping_ratio != settings.contact_damping_ratio ||
                              before.push_out_speed != settings.push_out_speed || (before.sleep && !settings.sleep);
        if (disturbs) reserve_wakes(*state_, state_->bodies.asleep.bodies.size());
        state_->settings = settings;
        if (!disturbs) return {};
        for (const std::uint32_t body : state_->bodies.asleep.bodies) disturb(state_->bodies, state_->settings, body);
        for (const std::uint32_t body : state_->bodies.awake) disturb(state_->bodies, state_->settings, body);
        return {};
    });
}

Result<void> World::set_pose(BodyId body, const Pose& pose) {
    return guarded(*state_, "set_pose", [&]() -> Result<void> {
        if (!contains(body)) return invalid_id(*state_, body, "World::set_pose");
        if (auto checked = check_position(pose.position, "World::set_pose: position"); !checked) return checked;
        const auto rotation = check_rotation(pose.rotation, "World::set_pose: rotation");
        if (!rotation) return rotation.error();
        dynamics::BodyMotion& motion = state_->bodies.motion[body.index];
        const Pose placed = Pose{pose.position, *rotation} * state_->bodies.traits[body.index].principal;
        if (auto checked = check_position(placed.position, "World::set_pose: centre of mass"); !checked) return checked;
        reserve_wakes(*state_, 1);
        motion.position = placed.position;
        motion.rotation = normalized(placed.rotation);
        update_boxes(*state_, body.index);
        disturb(state_->bodies, state_->settings, body.index);
        return {};
    });
}

Result<void> World::set_velocity(BodyId body, Vec3 linear, Vec3 angular) {
    return guarded(*state_, "set_velocity", [&]() -> Result<void> {
        if (!contains(body)) return invalid_id(*state_, body, "World::set_velocity");
        if (state_->bodies.traits[body.index].kind == BodyKind::Static)
            return refused("World::set_velocity", "a static body", "a dynamic or kinematic one", "set its kind first");
        return fase::set_velocity(*state_, body.index, linear, angular, "World::set_velocity: ");
    });
}

Result<void> World::move_kinematic(BodyId body, const Pose& target, float seconds) {
    return guarded(*state_, "move_kinematic", [&]() -> Result<void> {
        if (!contains(body)) return invalid_id(*state_, body, "World::move_kinematic");
        if (state_->bodies.traits[body.index].kind != BodyKind::Kinematic)
            return refused("World::move_kinematic", "a body that is not kinematic", "a kinematic one");
        if (!(seconds > 0 && seconds <= 1))
            return refused("World::move_kinematic: seconds", detail::found_text(seconds), "above 0, at most 1");
        if (auto checked = check_position(target.position, "World::move_kinematic: position"); !checked) return checked;
        const auto rotation = check_rotation(target.rotation, "World::move_kinematic: rotation");
        if (!rotation) return rotation.error();
        const dynamics::BodyMotion& motion = state_->bodies.motion[body.index];
        const Pose placed = Pose{target.position, *rotation} * state_->bodies.traits[body.index].principal;
        Quat turn = normalized(placed.rotation * conjugate(motion.rotation));
        if (turn.w < 0) turn = {-turn.x, -turn.y, -turn.z, -turn.w};
        // The rotation q = (axis sin(a/2), cos(a/2)) needs the angular speed a / seconds. a / 2 = atan(tan(a/2)) is
        // computed by the series of atan, after halving the angle until it is small.
        const float sine = length(turn.vector());
        float angle = 0;
        if (sine > 0) {
            float s = sine, c = turn.w, scale = 2;
            while (s > 0.2f * c) {  // halve the angle
                const float half_c = std::sqrt(0.5f * (1 + c));
                s = s / (2 * half_c);
                c = half_c;
                scale *= 2;
            }
            const float t = s / c, t2 = t * t;
            angle = scale * t * (1 - t2 * (1.0f / 3 - t2 * (1.0f / 5 - t2 * (1.0f / 7))));
        }
        // A target read from the body itself differs by rounding. That is no motion, and must keep nobody awake.
        constexpr float rounding = 1e-6f;  // metres and radians; what is left out adds up in the next target
        const Vec3 way = to_float(placed.position - motion.position);
        const bool rests = length_squared(way) < rounding * rounding && angle < rounding;
        const Vec3 linear = rests ? Vec3{} : way * (1 / seconds);
        const Vec3 angular = rests || !(sine > 0) ? Vec3{} : turn.vector() * (angle / (sine * seconds));
        return fase::set_velocity(*state_, body.index, linear, angular, "World::move_kinematic: ");
    });
}

Result<void> World::set_kind(BodyId body, BodyKind kind) {
    return guarded(*state_, "set_kind", [&]() -> Result<void> {
        if (!contains(body)) return invalid_id(*state_, body, "World::set_kind");
        if (kind > BodyKind::Dynamic) return refused("World::set_kind", "an unknown kind", "a BodyKind");
        WorldState& state = *state_;
        dynamics::BodyTraits& traits = state.bodies.traits[body.index];
        if (kind == BodyKind::Dynamic)
            for (std::uint32_t c = traits.first_collider; c != no_index; c = state.colliders[c].next)
                if (const Shape& shape = state.colliders.shapes[state.colliders[c].shape].shape;
                    !state.colliders[c].sensor && !is_solid(shape))
                    return refused("World::set_kind", std::string("a body with a ") + noun_of(shape),
                                   "a body whose shapes have a mass");
        if (traits.kind == kind) return {};
        BodyEdit edit = edit_of(state, body.index);
        edit.kind = kind;
        const Pose pose = body_pose(traits, state.bodies.motion[body.index]);
        const auto shape = checked_shape_of(state, edit, pose, "World::set_kind: ");
        if (!shape) return shape.error();
        reserve_pair_moves(state, body.index);
        traits.kind = kind;
        state.bodies.forces[body.index] = {};  // they were meant for the body as it was
        if (kind == BodyKind::Static) {
            state.bodies.motion[body.index].linear_velocity = {};
            state.bodies.motion[body.index].angular_velocity = {};
        }
        set_shape(state, body.index, *shape);
        update_motion_state(state, body.index);
        update_boxes(state, body.index);
        return {};
    });
}

Result<void> World::set_mass(BodyId body, const std::optional<MassProperties>& mass) {
    return guarded(*state_, "set_mass", [&]() -> Result<void> {
        if (!contains(body)) return invalid_id(*state_, body, "World::set_mass");
        if (mass)
            if (auto checked = check_mass(*mass, "World::set_mass: "); !checked) return checked;
        dynamics::BodyTraits& traits = state_->bodies.traits[body.index];
        BodyEdit edit = edit_of(*state_, body.index);
        edit.mass_given = mass.has_value();
        if (mass) edit.mass = *mass;
        const Pose pose = body_pose(traits, state_->bodies.motion[body.index]);
        const auto shape = checked_shape_of(*state_, edit, pose, "World::set_mass: ");
        if (!shape) return shape.error();
        reserve_wakes(*state_, 1);
        traits.mass_given = mass.has_value();
        const LocalPose frame_before = traits.principal;
        set_shape(*state_, body.index, *shape);
        if (!(frame_before == traits.principal))
            update_boxes(*state_, body.index);  // the shapes moved, if only by rounding
        disturb(state_->bodies, state_->settings, body.index);
        return {};
    });
}

Result<void> World::set_damping(BodyId body, float linear, float angular) {
    return guarded(*state_, "set_damping", [&]() -> Result<void> {
        if (!contains(body)) return invalid_id(*state_, body, "World::set_damping");
        if (auto r = check_number(linear, 0, limits::damping, "World::set_damping: linear"); !r) return r;
        if (auto r = check_number(angular, 0, limits::damping, "World::set_damping: angular"); !r) return r;
        reserve_wakes(*state_, 1);
        state_->bodies.traits[body.index].linear_damping = linear;
        state_->bodies.traits[body.index].angular_damping = angular;
        disturb(state_->bodies, state_->settings, body.index);
        return {};
    });
}

Result<void> World::set_gravity_scale(BodyId body, float scale) {
    return guarded(*state_, "gravity_scale", [&]() -> Result<void> {
        if (!contains(body)) return invalid_id(*state_, body, "World::set_gravity_scale");
        if (auto r = check_number(scale, -limits::gravity_scale, limits::gravity_scale, "World::set_gravity_scale"); !r)
            return r;
        reserve_wakes(*state_, 1);
        state_->bodies.traits[body.index].gravity_scale = scale;
        disturb(state_->bodies, state_->settings, body.index);
        return {};
    });
}

Result<void> World::set_locks(BodyId body, AxisLocks locks) {
    return guarded(*state_, "set_locks", [&]() -> Result<void> {
        if (!contains(body)) return invalid_id(*state_, body, "World::set_locks");
        reserve_wakes(*state_, 1);
        state_->bodies.traits[body.index].locks = bits_of(locks);
        disturb(state_->bodies, state_->settings, body.index);
        return {};
    });
}

Result<void> World::set_can_sleep(BodyId body, bool can_sleep) {
    return guarded(*state_, "set_can_sleep", [&]() -> Result<void> {
        if (!contains(body)) return invalid_id(*state_, body, "World::set_can_sleep");
        reserve_wakes(*state_, 1);
        state_->bodies.traits[body.index].can_sleep = can_sleep;
        if (!can_sleep) disturb(state_->bodies, state_->settings, body.index);
        return {};
    });
}

Result<void> World::wake(BodyId body) {
    return guarded(*state_, "World::wake", [&]() -> Result<void> {
        if (!contains(body)) return invalid_id(*state_, body, "World::wake");
        reserve_wakes(*state_, 1);
        disturb(state_->bodies, state_->settings, body.index);
        return {};
    });
}

Result<void> World::set_material(ColliderId collider, const Material& material) {
    return guarded(*state_, "set_material", [&]() -> Result<void> {
        if (!contains(collider)) return invalid_id(*state_, collider, "World::set_material");
        if (auto checked = check(material); !checked) return checked;
        WorldState& state = *state_;
        std::size_t contacts = 0;
        state.contacts.graph.for_each_of(collider.index, [&](std::uint32_t) { ++contacts; });
        reserve_wakes(state, 2 * contacts + 1);
        state.colliders[collider.index].material = material;
        const std::size_t wakes_before = state.bodies.to_wake.size();
        state.contacts.graph.for_each_of(collider.index, [&](std::uint32_t index) {
            const dynamics::Contact& c = state.contacts[index];
            for (const auto& [other, generation, body] : sides_of(c))
                if (!is_current(state.colliders, other, generation))
                    return;  // its collider was removed: the next step ends it
            update_materials(state.colliders, state.contacts, index);
            if (!c.sensor && c.touching)
                for (const auto& side : sides_of(c)) disturb(state.bodies, state.settings, side.body);
        });
        disturb(state.bodies, state.settings, state.colliders[collider.index].body);
        // The order of a collider's contacts is not the same after a restore; the list is part of the hash.
        std::sort(state.bodies.to_wake.begin() + static_cast<std::ptrdiff_t>(wakes_before), state.bodies.to_wake.end());
        return {};
    });
}

Result<void> World::set_filter(ColliderId collider, const pairs::CollisionFilter& filter) {
    return guarded(*state_, "set_filter", [&]() -> Result<void> {
        if (!contains(collider)) return invalid_id(*state_, collider, "World::set_filter");
        reserve_wakes(*state_, 1);
        state_->colliders[collider.index].filter = filter;
        update_box(*state_, collider.index);
        disturb(state_->bodies, state_->settings, state_->colliders[collider.index].body);
        return {};
    });
}

Result<void> World::exclude_pair(BodyId a, BodyId b) {
    return guarded(*state_, "exclude_pair", [&]() -> Result<void> {
        if (!contains(a)) return invalid_id(*state_, a, "World::exclude_pair: a");
        if (!contains(b)) return invalid_id(*state_, b, "World::exclude_pair: b");
        if (a == b) return refused("World::exclude_pair", "the same body twice", "two bodies");
        reserve_wakes(*state_, 2);
        if (!state_->bodies.exclusions.add(a.index, b.index)) return {};
        update_pairs_between(*state_, a.index, b.index);
        disturb(state_->bodies, state_->settings, a.index);
        disturb(state_->bodies, state_->settings, b.index);
        return {};
    });
}

Result<void> World::include_pair(BodyId a, BodyId b) {
    return guarded(*state_, "include_pair", [&]() -> Result<void> {
        if (!contains(a)) return invalid_id(*state_, a, "World::include_pair: a");
        if (!contains(b)) return invalid_id(*state_, b, "World::include_pair: b");
        reserve_wakes(*state_, 2);
        if (!state_->bodies.exclusions.remove(a.index, b.index)) return {};
        update_pairs_between(*state_, a.index, b.index);
        disturb(state_->bodies, state_->settings, a.index);
        disturb(state_->bodies, state_->settings, b.index);
        return {};
    });
}

Result<void> World::apply_force(BodyId body, Vec3 newtons) {
    return guarded(*state_, "apply_force", [&]() -> Result<void> {
        if (!contains(body)) return invalid_id(*state_, body, "World::apply_force");
        const Vec3d centre = state_->bodies.motion[body.index].position;
        return add_force(*state_, body.index, newtons, centre, "World::apply_force");
    });
}

Result<void> World::apply_force_at(BodyId body, Vec3 newtons, Vec3d point) {
    return guarded(*state_, "apply_force_at", [&]() -> Result<void> {
        if (!contains(body)) return invalid_id(*state_, body, "World::apply_force_at");
        return add_force(*state_, body.index, newtons, point, "World::apply_force_at");
    });
}

Result<void> World::apply_torque(BodyId body, Vec3 newton_metres) {
    return guarded(*state_, "apply_torque", [&]() -> Result<void> {
        if (!contains(body)) return invalid_id(*state_, body, "World::apply_torque");
        if (auto checked = check_vector(newton_metres, limits::torque, "World::apply_torque: newton_metres"); !checked)
            return checked;
        if (state_->bodies.traits[body.index].kind != BodyKind::Dynamic) return not_dynamic("World::apply_torque");
        if (newton_metres == Vec3{}) return {};
        dynamics::BodyForces sum = state_->bodies.forces[body.index];
        sum.torque += newton_metres;
        if (auto checked = check_forces(sum, "World::apply_torque"); !checked) return checked;
        reserve_wakes(*state_, 1);
        state_->bodies.forces[body.index] = sum;
        disturb(state_->bodies, state_->settings, body.index);
        return {};
    });
}

Result<void> World::apply_impulse(BodyId body, Vec3 newton_seconds) {
    return guarded(*state_, "apply_impulse", [&]() -> Result<void> {
        if (!contains(body)) return invalid_id(*state_, body, "World::apply_impulse");
        const Vec3d centre = state_->bodies.motion[body.index].position;
        return add_impulse(*state_, body.index, newton_seconds, centre, "World::apply_impulse");
    });
}

Result<void> World::apply_impulse_at(BodyId body, Vec3 newton_seconds, Vec3d point) {
    return guarded(*state_, "apply_impulse", [&]() -> Result<void> {
        if (!contains(body)) return invalid_id(*state_, body, "World::apply_impulse_at");
        return add_impulse(*state_, body.index, newton_seconds, point, "World::apply_impulse_at");
    });
}

Result<void> World::apply_angular_impulse(BodyId body, Vec3 newton_metre_seconds) {
    return guarded(*state_, "angular_impulse", [&]() -> Result<void> {
        if (!contains(body)) return invalid_id(*state_, body, "World::apply_angular_impulse");
        if (auto checked = check_vector(newton_metre_seconds, limits::torque,
                                        "World::apply_angular_impulse: newton_metre_seconds");
            !checked)
            return checked;
        const dynamics::BodyTraits& traits = state_->bodies.traits[body.index];
        if (traits.kind != BodyKind::Dynamic) return not_dynamic("World::apply_angular_impulse");
        dynamics::BodyMotion& motion = state_->bodies.motion[body.index];
        const Vec3 angular = motion.angular_velocity + inverse_inertia_times(traits, motion, newton_metre_seconds);
        if (auto checked = check_velocity({}, angular, "World::apply_angular_impulse: "); !checked) return checked;
        reserve_wakes(*state_, 1);
        motion.angular_velocity = angular;
        disturb(state_->bodies, state_->settings, body.index);
        return {};
    });
}

}  // namespace fase
