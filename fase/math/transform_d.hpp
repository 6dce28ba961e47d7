#pragma once
/// A rigid transform in double with a rotation matrix: for exact distances and the internals of the narrow phase.
#include "fase/math/pose.hpp"

namespace fase {

/// Rotates by `rotation` (orthonormal, determinant 1), then translates by `position`. "b_in_a" maps b's frame to a's.
struct TransformD {
    Mat3d rotation = Mat3d::identity();
    Vec3d position;
    friend constexpr bool operator==(const TransformD&, const TransformD&) = default;
};

constexpr Vec3d transform(const TransformD& t, Vec3d point) { return t.position + t.rotation * point; }
constexpr Vec3d transform_back(const TransformD& t, Vec3d point) {
    return transpose_times(t.rotation, point - t.position);
}
/// Applies b, then a.
constexpr TransformD operator*(const TransformD& a, const TransformD& b) {
    return {a.rotation * b.rotation, transform(a, b.position)};
}
constexpr TransformD inverse(const TransformD& t) {
    return {transpose(t.rotation), -transpose_times(t.rotation, t.position)};
}
/// Converts to double; renormalises the quaternion, so that the matrix is orthonormal to double precision.
inline TransformD to_double(const LocalPose& pose) {
    return {to_matrix(normalized(to_double(pose.rotation))), to_double(pose.position)};
}

/// Returns b in a's frame to double precision: normalises both quaternions in double.
inline TransformD exactly_relative(const Pose& a, const Pose& b) {
    const Mat3d of_a = to_matrix(normalized(to_double(a.rotation)));
    const Mat3d of_b = to_matrix(normalized(to_double(b.rotation)));
    return {transpose(of_a) * of_b, transpose_times(of_a, b.position - a.position)};
}

}  // namespace fase
