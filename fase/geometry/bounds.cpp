/// World bounds of shapes, and their outer and inner radii.
#include "fase/geometry/bounds.hpp"

namespace fase {

Aabb bounds(const Shape& shape, const Pose& pose) {
    return std::visit([&pose](const auto& s) { return detail::bounds_of(s, pose); }, shape);
}

float outer_radius(const Shape& shape) {
    return std::visit([](const auto& s) { return detail::outer_radius_of(s); }, shape);
}

float inner_radius(const Shape& shape) {
    return std::visit([](const auto& s) { return detail::inner_radius_of(s); }, shape);
}

}  // namespace fase
