/// Transforms a shape cast to the frame of its target, and the touch back to the world.
#include "fase/narrow/cast_shape.hpp"

#include "fase/narrow/detail/advance.hpp"

namespace fase::narrow {

std::optional<ShapeOnShape> cast_shape(const Shape& moving, const Pose& from, Vec3 direction, float length,
                                       const Shape& target, const Pose& target_pose) {
    const Mat3d rotation = to_matrix(normalized(to_double(target_pose.rotation)));
    const Vec3d local_direction = transpose_times(rotation, to_double(direction));
    const auto stop = advance(target, moving, exactly_relative(target_pose, from), local_direction, double(length));
    if (!stop) return std::nullopt;
    return ShapeOnShape{stop->distance, target_pose.position + rotation * stop->on_target,
                        to_float(rotation * stop->normal), stop->triangle};
}

}  // namespace fase::narrow
