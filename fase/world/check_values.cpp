/// Checks of numbers that a world receives.
#include <cmath>

#include "fase/core/detail/text.hpp"
#include "fase/world/detail/edit.hpp"

namespace fase {

Result<Quat> check_rotation(Quat q, const std::string& where) {
    const float length = std::sqrt(length_squared(q));
    if (!is_finite(q) || !(length > 0.99f && length < 1.01f))
        return refused(where, "a quaternion of length " + detail::text_of(length), "length 1", "normalise it");
    return normalized(q);
}

Result<void> check_number(float value, float min, const std::string& where) {
    if (std::isfinite(value) && value >= min) return {};
    return refused(where, detail::text_of(value), min == 0 ? "a number of 0 or more" : "a finite number");
}

Result<void> check_position(Vec3d p, const std::string& where) {
    const auto within = [](double v) { return v >= -max_coordinate && v <= max_coordinate; };
    if (within(p.x) && within(p.y) && within(p.z)) return {};
    return refused(where, "a coordinate that is not finite or beyond 1e7 m", "-1e7 to 1e7 m");
}

Result<void> check(const Material& material) {
    if (auto r = check_number(material.friction, 0, "Material.friction"); !r) return r;
    return check_number(material.restitution, 0, "Material.restitution");
}

std::uint8_t bits_of(AxisLocks locks) {
    return static_cast<std::uint8_t>((locks.linear_x ? 1 : 0) | (locks.linear_y ? 2 : 0) | (locks.linear_z ? 4 : 0) |
                                     (locks.angular_x ? 8 : 0) | (locks.angular_y ? 16 : 0) |
                                     (locks.angular_z ? 32 : 0));
}

}  // namespace fase
