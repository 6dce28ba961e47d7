/// Matrices.
#include "fase/math/mat3.hpp"

#include <gtest/gtest.h>

#include "tests/math/arbitrary.hpp"

namespace fase {
namespace {

double size_of(const Mat3d& m) { return length(m.x) + length(m.y) + length(m.z); }
double distance(const Mat3d& a, const Mat3d& b) { return size_of(a - b); }

TEST(Mat3, is_made_of_columns) {
    const Mat3 m{{1, 2, 3}, {4, 5, 6}, {7, 8, 10}};
    EXPECT_EQ(m * (Vec3{0, 1, 0}), (Vec3{4, 5, 6}));
    EXPECT_EQ(m[2], (Vec3{7, 8, 10}));
    EXPECT_EQ(transpose(m).x, (Vec3{1, 4, 7}));
    EXPECT_EQ(determinant(m), -3);
    EXPECT_EQ(abs(m * -1.0f), m);
    EXPECT_EQ(m + m - m, m);
}

RC_GTEST_PROP(Mat3, products_apply_the_right_one_first, (const Mat3d& a, const Mat3d& b, const Vec3d& v)) {
    const double size = size_of(a) * size_of(b) * length(v);
    RC_ASSERT(length(a * b * v - a * (b * v)) <= 1e-14 * size);
    RC_ASSERT(distance(transpose(a * b), transpose(b) * transpose(a)) <= 1e-14 * size_of(a) * size_of(b));
    RC_ASSERT(transpose_times(a, v) == transpose(a) * v ||
              length(transpose_times(a, v) - transpose(a) * v) <= 1e-14 * size_of(a) * length(v));
}

RC_GTEST_PROP(Mat3, times_its_inverse_is_the_identity, (const Mat3d& a)) {
    const double volume = std::abs(determinant(a)), size = length(a.x) * length(a.y) * length(a.z);
    RC_PRE(volume > 1e-3 * size && size > 0);
    RC_ASSERT(distance(a * inverse(a), Mat3d::identity()) <= 1e-8 * size_of(a) * size_of(inverse(a)));
    RC_ASSERT(distance(inverse(inverse(a)), a) <= 1e-9 * size_of(a) * size_of(a) * size_of(inverse(a)));
}

RC_GTEST_PROP(Mat3, determinants_multiply, (const Mat3d& a, const Mat3d& b)) {
    const double size = size_of(a) * size_of(b);
    RC_ASSERT(std::abs(determinant(a * b) - determinant(a) * determinant(b)) <= 1e-12 * size * size * size);
    RC_ASSERT(std::abs(determinant(transpose(a)) - determinant(a)) <= 1e-13 * size_of(a) * size_of(a) * size_of(a));
}

TEST(Mat3, of_determinant_0_has_the_inverse_0) {
    EXPECT_EQ(inverse(Mat3{{1, 2, 3}, {2, 4, 6}, {0, 0, 1}}), Mat3{});
    EXPECT_EQ(inverse(Mat3{}), Mat3{});
}

}  // namespace
}  // namespace fase
