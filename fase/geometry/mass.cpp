/// Mass, centre and inertia: of shapes, and of compounds by the parallel-axis theorem.
#include "fase/geometry/mass.hpp"

#include "fase/geometry/detail/solid.hpp"

namespace fase {

MassProperties mass_properties(const Shape& shape, float density) {
    return detail::rounded(std::visit([density](const auto& s) { return detail::solid_of(s, density); }, shape));
}

MassProperties transformed(const MassProperties& properties, const LocalPose& pose) {
    const Mat3d r = to_matrix(normalized(to_double(pose.rotation)));
    const Vec3d centre = to_double(pose.position) + r * to_double(properties.centre);
    return {properties.mass, to_float(centre), to_float(r * to_double(properties.inertia) * transpose(r))};
}

MassProperties combined(std::span<const MassProperties> parts) {
    detail::Solid sum;
    for (const MassProperties& part : parts) {
        sum.mass += part.mass;
        sum.centre += to_double(part.centre) * double(part.mass);
    }
    if (!(sum.mass > 0)) return {};
    sum.centre *= 1 / sum.mass;
    for (const MassProperties& part : parts) {
        sum.inertia = sum.inertia + to_double(part.inertia) +
                      detail::point_inertia(part.mass, to_double(part.centre) - sum.centre);
    }
    return detail::rounded(sum);
}

}  // namespace fase
