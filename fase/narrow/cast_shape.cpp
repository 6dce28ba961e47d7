/// Takes a move to the frame of its target, and the touch back.
#include "fase/narrow/cast_shape.hpp"

#include "fase/narrow/detail/advance.hpp"

namespace fase::narrow {

std::optional<ShapeOnShape> cast_shape(const Shape& moving, const Pose& from, Vec3 direction, float length,
                                       const Shape& target, const Pose& at) {
    const Mat3d of_target = to_matrix(normalized(to_double(at.rotation)));
    const Vec3d way = transpose_times(of_target, to_double(direction));
    const auto stop = advance(target, moving, exactly_relative(at, from), way, double(length));
    if (!stop) return std::nullopt;
    return ShapeOnShape{stop->at, at.position + of_target * stop->on_target, to_float(of_target * stop->normal)};
}

}  // namespace fase::narrow
