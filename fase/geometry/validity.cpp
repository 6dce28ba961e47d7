/// Validation of shapes and mass properties, with error messages.

#include <string>

#include "fase/core/detail/text.hpp"
#include "fase/geometry/mass.hpp"

namespace fase {
namespace {

Error wrong(std::string where, float found, const std::string& expected) {
    return {Status::BadArgument, std::move(where), detail::format("found {}; expected {}", found, expected), ""};
}

template <SizedShape S> Result<void> check_sizes(const S& shape) {
    for (const ShapeSize<S>& size : S::sizes) {
        const float found = size.in(shape);
        if (found >= min_shape_size && found <= max_shape_size) continue;
        if (found == 0 && size.zero == ZeroSize::Allowed) continue;
        return wrong(detail::format("{}.{}", S::name, size.name), found, "a length from 1e-4 to 1e5 m");
    }
    return {};
}

}  // namespace

Result<void> check(const Shape& shape) {
    return std::visit(
        []<class S>(const S& s) -> Result<void> {
            if constexpr (SizedShape<S>) {
                return check_sizes(s);
            } else {
                return detail::check_of(s);
            }
        },
        shape);
}

Result<void> check(const MassProperties& properties) {
    if (!(properties.mass > 0) || !std::isfinite(properties.mass)) {
        return wrong("mass", properties.mass, "a finite number above 0 kg");
    }
    if (!is_finite(properties.centre)) return Error{Status::BadArgument, "centre", "not finite", ""};
    const Mat3& i = properties.inertia;
    if (!is_finite(i.x) || !is_finite(i.y) || !is_finite(i.z)) {
        return Error{Status::BadArgument, "inertia", "not finite", ""};
    }
    const float trace = i.x.x + i.y.y + i.z.z;
    const float slack = 1e-4f * (trace > 0 ? trace : 0);
    const Vec3 skew = abs(Vec3{i.x.y - i.y.x, i.x.z - i.z.x, i.y.z - i.z.y});
    if (!(skew.x <= slack && skew.y <= slack && skew.z <= slack)) {
        return Error{Status::BadArgument, "inertia", "not symmetric", ""};
    }
    const Vec3 m = principal(i).moments;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(m[axis] > 0)) return wrong("inertia", m[axis], "principal moments above 0 kg m²");
        if (m[axis] > trace / 2 + slack / 2) {
            return wrong("inertia", m[axis],
                         detail::format("no principal moment above the sum of the other two, {}", trace - m[axis]));
        }
    }
    return {};
}

}  // namespace fase
