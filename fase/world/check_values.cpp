/// Checks of numbers that a world receives.
#include "fase/world/check_values.hpp"

#include <cmath>

#include "fase/core/detail/text.hpp"
#include "fase/world/detail/edit.hpp"

namespace fase {
namespace {

constexpr const char* axis_names[] = {".x", ".y", ".z"};

}  // namespace

Result<void> check_number(float value, float min, float max, const std::string& where) {
    if (value >= min && value <= max) return {};
    return refused(where, detail::found_text(value), detail::text_of(min) + " to " + detail::text_of(max));
}

Result<void> check_vector(Vec3 value, float max, const std::string& where) {
    for (int axis = 0; axis < 3; ++axis)
        if (!(value[axis] >= -max && value[axis] <= max))
            return check_number(value[axis], -max, max, where + axis_names[axis]);
    return {};
}

namespace {

bool is_coordinate(double v) { return v >= -limits::coordinate && v <= limits::coordinate; }

/// Checks the length of a velocity.
Result<void> check_speed(Vec3 velocity, float max, const std::string& where, const char* unit, const char* expected) {
    const double squared = length_squared(to_double(velocity));
    if (squared <= double(max) * double(max)) return {};
    for (int axis = 0; axis < 3; ++axis)
        if (!std::isfinite(velocity[axis]))
            return refused(where + axis_names[axis], detail::found_text(velocity[axis]), expected);
    return refused(where, detail::text_of(static_cast<float>(std::sqrt(squared))) + unit, expected);
}

}  // namespace

bool is_in_world(Vec3d p) { return is_coordinate(p.x) && is_coordinate(p.y) && is_coordinate(p.z); }

Result<void> check_position(Vec3d p, const std::string& where) {
    for (int axis = 0; axis < 3; ++axis)
        if (!is_coordinate(p[axis]))
            return refused(where + axis_names[axis], detail::found_text(p[axis]), "-1e7 to 1e7 m");
    return {};
}

Result<Quat> check_rotation(Quat q, const std::string& where) {
    const float length = std::sqrt(length_squared(q));
    if (!is_finite(q) || !(length > 0.99f && length < 1.01f))
        return refused(where, "a quaternion of length " + detail::found_text(length), "length 1", "normalise it");
    return normalized(q);
}

Result<void> check_velocity(Vec3 linear, Vec3 angular, const std::string& where) {
    if (auto r = check_speed(linear, limits::speed, where + "linear_velocity", " m/s", "at most 1e7 m/s"); !r) return r;
    return check_speed(angular, limits::spin, where + "angular_velocity", " rad/s", "at most 1e6 rad/s");
}

Result<void> check_combined_mass(const MassProperties& mass, Vec3 moments, const std::string& where) {
    if (mass.mass == 0 && moments == Vec3{} && mass.centre == Vec3{}) return {};
    if (auto r = check_number(mass.mass, limits::min_mass, limits::max_mass, where + "mass"); !r) return r;
    if (auto r = check_vector(mass.centre, limits::offset, where + "mass: centre"); !r) return r;
    for (int axis = 0; axis < 3; ++axis)
        if (auto r = check_number(moments[axis], limits::min_moment, limits::max_moment, where + "mass: inertia"); !r)
            return r;
    return {};
}

Result<void> check_mass(const MassProperties& mass, const std::string& where) {
    if (auto checked = check(mass); !checked) {
        Error error = checked.error();
        error.where = where + (error.where == "mass" ? "mass" : "mass: " + error.where);
        return error;
    }
    return check_combined_mass(mass, principal(mass.inertia).moments, where);
}

Result<void> check(const Material& material) {
    if (auto r = check_number(material.friction, 0, limits::friction, "Material.friction"); !r) return r;
    if (auto r = check_number(material.restitution, 0, limits::restitution, "Material.restitution"); !r) return r;
    for (const CombineMode mode : {material.friction_combine, material.restitution_combine})
        if (mode > CombineMode::Average) return refused("Material", "an unknown combine mode", "a CombineMode");
    return {};
}

Result<void> check(const BodyDef& def) {
    if (def.kind > BodyKind::Dynamic) return refused("BodyDef.kind", "an unknown kind", "a BodyKind");
    if (auto r = check_position(def.position, "BodyDef.position"); !r) return r;
    if (auto rotation = check_rotation(def.rotation, "BodyDef.rotation"); !rotation) return rotation.error();
    if (auto r = check_velocity(def.linear_velocity, def.angular_velocity, "BodyDef."); !r) return r;
    if (auto r = check_number(def.linear_damping, 0, limits::damping, "BodyDef.linear_damping"); !r) return r;
    if (auto r = check_number(def.angular_damping, 0, limits::damping, "BodyDef.angular_damping"); !r) return r;
    if (auto r =
            check_number(def.gravity_scale, -limits::gravity_scale, limits::gravity_scale, "BodyDef.gravity_scale");
        !r)
        return r;
    const bool moves = !(def.linear_velocity == Vec3{} && def.angular_velocity == Vec3{});
    if (!def.awake && moves && def.kind != BodyKind::Static)
        return refused("BodyDef.awake", "false, with a velocity that is not 0", "a body at rest",
                       "leave it awake, or set the velocity when it wakes");
    return def.mass ? check_mass(*def.mass, "BodyDef.") : Result<void>();
}

Result<void> check(const ColliderDef& def) {
    if (auto r = check_vector(def.pose.position, limits::offset, "ColliderDef.pose.position"); !r) return r;
    if (auto rotation = check_rotation(def.pose.rotation, "ColliderDef.pose.rotation"); !rotation)
        return rotation.error();
    if (auto r = check_number(def.density, 0, limits::density, "ColliderDef.density"); !r) return r;
    return check(def.material);
}

std::uint8_t bits_of(AxisLocks locks) {
    return static_cast<std::uint8_t>((locks.linear_x ? 1 : 0) | (locks.linear_y ? 2 : 0) | (locks.linear_z ? 4 : 0) |
                                     (locks.angular_x ? 8 : 0) | (locks.angular_y ? 16 : 0) |
                                     (locks.angular_z ? 32 : 0));
}

}  // namespace fase
