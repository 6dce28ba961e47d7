#pragma once
/// The rigid motion in double, its rotation as a matrix: for exact distances and for the insides of the narrow phase.
#include "fase/math/pose.hpp"

namespace fase {

/// First turn by `rotation` (orthonormal, determinant 1), then move by `position`. "b_in_a" takes b's points to a's
/// frame.
struct TransformD {
    Mat3d rotation = Mat3d::identity();
    Vec3d position;
    friend constexpr bool operator==(const TransformD&, const TransformD&) = default;
};

constexpr Vec3d transform(const TransformD& t, Vec3d point) { return t.position + t.rotation * point; }
constexpr Vec3d transform_back(const TransformD& t, Vec3d point) {
    return transpose_times(t.rotation, point - t.position);
}
/// First b, then a.
constexpr TransformD operator*(const TransformD& a, const TransformD& b) {
    return {a.rotation * b.rotation, transform(a, b.position)};
}
constexpr TransformD inverse(const TransformD& t) {
    return {transpose(t.rotation), -transpose_times(t.rotation, t.position)};
}
/// The same motion in double; the quaternion is normalised again, so that the matrix is orthonormal to double
/// precision.
inline TransformD to_double(const LocalPose& pose) {
    return {to_matrix(normalized(to_double(pose.rotation))), to_double(pose.position)};
}

/// b seen from a, exact to double: both quaternions are normalised in it.
inline TransformD exactly_relative(const Pose& a, const Pose& b) {
    const Mat3d of_a = to_matrix(normalized(to_double(a.rotation)));
    const Mat3d of_b = to_matrix(normalized(to_double(b.rotation)));
    return {transpose(of_a) * of_b, transpose_times(of_a, b.position - a.position)};
}

}  // namespace fase
