/// Rotations.
#include "fase/math/quat.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/math/arbitrary.hpp"

namespace fase {
namespace {

double difference(const Mat3d& a, const Mat3d& b) { return length(a.x - b.x) + length(a.y - b.y) + length(a.z - b.z); }
double rotation_difference(Quatd a, Quatd b) {
    const double same = length_squared(Quatd{a.x - b.x, a.y - b.y, a.z - b.z, a.w - b.w});
    const double opposite = length_squared(Quatd{a.x + b.x, a.y + b.y, a.z + b.z, a.w + b.w});
    return std::sqrt(std::min(same, opposite));
}

TEST(Quat, by_default_is_the_identity) { EXPECT_EQ(rotate(Quat{}, Vec3{1, 2, 3}), (Vec3{1, 2, 3})); }

TEST(Quat, rotates_by_the_right_hand_rule) {
    const Quatd quarter = rotation_about(Vec3d{0, 0, 1}, 1.5707963267948966);
    const Vec3d rotated = rotate(quarter, Vec3d{1, 0, 0});
    EXPECT_NEAR(rotated.x, 0, 1e-15);
    EXPECT_NEAR(rotated.y, 1, 1e-15);
}

RC_GTEST_PROP(Quat, rotation_keeps_lengths_and_angles, (const Quatd& q, const Vec3d& a, const Vec3d& b)) {
    const double size = length(a) * length(b);
    RC_ASSERT(std::abs(dot(rotate(q, a), rotate(q, b)) - dot(a, b)) <= 1e-14 * size);
    RC_ASSERT(length(cross(rotate(q, a), rotate(q, b)) - rotate(q, cross(a, b))) <= 1e-14 * size);
}

RC_GTEST_PROP(Quat, rotate_back_undoes_rotate, (const Quatd& q, const Vec3d& v)) {
    RC_ASSERT(length(rotate_back(q, rotate(q, v)) - v) <= 1e-14 * length(v));
    RC_ASSERT(rotate_back(q, v) == rotate(conjugate(q), v));
}

RC_GTEST_PROP(Quat, products_apply_the_right_one_first, (const Quatd& a, const Quatd& b, const Vec3d& v)) {
    RC_ASSERT(length(rotate(a * b, v) - rotate(a, rotate(b, v))) <= 1e-14 * length(v));
    RC_ASSERT(rotation_difference(a * conjugate(a), {}) <= 1e-14);
}

RC_GTEST_PROP(Quat, its_matrix_is_the_same_rotation_and_orthonormal, (const Quatd& q, const Vec3d& v)) {
    const Mat3d m = to_matrix(q);
    RC_ASSERT(length(m * v - rotate(q, v)) <= 1e-14 * length(v));
    RC_ASSERT(difference(m * transpose(m), Mat3d::identity()) <= 1e-14);
    RC_ASSERT(std::abs(determinant(m) - 1) <= 1e-14);
}

RC_GTEST_PROP(Quat, comes_back_from_its_matrix, (const Quatd& q)) {
    RC_ASSERT(rotation_difference(to_quat(to_matrix(q)), q) <= 1e-14);
}

TEST(Quat, comes_back_from_matrices_of_half_turns) {
    for (const Quatd q :
         {Quatd{1, 0, 0, 0}, Quatd{0, 1, 0, 0}, Quatd{0, 0, 1, 0}, normalized(Quatd{1, 1, 0, 0}),
          normalized(Quatd{0, 1, -1, 0}), normalized(Quatd{1, 1, 1, 0}), normalized(Quatd{-1, 2, 3, 1e-9})}) {
        EXPECT_LE(rotation_difference(to_quat(to_matrix(q)), q), 1e-14);
    }
}

RC_GTEST_PROP(Quat, in_float_is_accurate_to_a_few_roundings, (const Quat& q, const Vec3& v)) {
    RC_ASSERT(std::abs(length_squared(q) - 1) <= 4e-7f);
    const Vec3d exact = rotate(normalized(to_double(q)), to_double(v));
    RC_ASSERT(length(to_double(rotate(q, v)) - exact) <= 2e-6 * length(to_double(v)));
    RC_ASSERT(length(to_double(to_matrix(q) * v) - exact) <= 2e-6 * length(to_double(v)));
}

TEST(Quat, of_length_0_normalizes_to_the_identity) {
    EXPECT_EQ(normalized(Quat{0, 0, 0, 0}), Quat{});
    EXPECT_EQ(normalized(Quat{std::numeric_limits<float>::quiet_NaN(), 0, 0, 1}), Quat{});
    EXPECT_FALSE(is_finite(Quat{0, 0, 0, std::numeric_limits<float>::infinity()}));
    EXPECT_FALSE(is_finite(Quat{0, std::numeric_limits<float>::quiet_NaN(), 0, 1}));
    EXPECT_TRUE(is_finite(Quat{}));
}

}  // namespace
}  // namespace fase
