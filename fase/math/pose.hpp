#pragma once
/// Position and rotation: LocalPose in float (within a body or between two), Pose in the world.
#include "fase/math/quat.hpp"

namespace fase {

/// A rigid transform in float: rotates by `rotation`, then translates by `position`. "b_in_a" maps b's frame to a's.
struct LocalPose {
    Vec3 position{};
    Quat rotation{};
    friend constexpr bool operator==(const LocalPose&, const LocalPose&) = default;
};
/// A pose in the world: position in double, so that it resolves a micrometre at 1e7 m from the origin.
struct Pose {
    Vec3d position{};
    Quat rotation{};
    friend constexpr bool operator==(const Pose&, const Pose&) = default;
};

constexpr Vec3 transform(const LocalPose& pose, Vec3 point) { return pose.position + rotate(pose.rotation, point); }
constexpr Vec3 transform_back(const LocalPose& pose, Vec3 point) {
    return rotate_back(pose.rotation, point - pose.position);
}
constexpr Vec3d transform(const Pose& pose, Vec3 point) {
    return pose.position + to_double(rotate(pose.rotation, point));
}
constexpr Vec3 transform_back(const Pose& pose, Vec3d point) {
    return rotate_back(pose.rotation, to_float(point - pose.position));
}
/// Applies b, then a. The rotation is not renormalised.
constexpr LocalPose operator*(const LocalPose& a, const LocalPose& b) {
    return {transform(a, b.position), a.rotation * b.rotation};
}
constexpr Pose operator*(const Pose& a, const LocalPose& b) {
    return {transform(a, b.position), a.rotation * b.rotation};
}
constexpr LocalPose inverse(const LocalPose& pose) {
    const Quat back = conjugate(pose.rotation);
    return {-rotate(back, pose.position), back};
}
/// Returns b in a's frame: maps points of b's frame to a's. Subtracts the positions in double.
constexpr LocalPose relative(const Pose& a, const Pose& b) {
    const Quat back = conjugate(a.rotation);
    return {rotate(back, to_float(b.position - a.position)), back * b.rotation};
}

}  // namespace fase
