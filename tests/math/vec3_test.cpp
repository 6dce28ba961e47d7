/// Vectors.
#include "fase/math/vec3.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/math/arbitrary.hpp"

namespace fase {
namespace {

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

TEST(Vec3, has_access_by_name_and_by_index) {
    Vec3 v{1, 2, 3};
    EXPECT_EQ(v[0], v.x);
    EXPECT_EQ(v[1], v.y);
    EXPECT_EQ(v[2], v.z);
    v[1] = 9;
    EXPECT_EQ(v, (Vec3{1, 9, 3}));
    v += {1, 1, 1};
    v -= {0, 0, 1};
    v *= 2;
    EXPECT_EQ(v, (Vec3{4, 20, 6}));
}

RC_GTEST_PROP(Vec3, cross_is_perpendicular_and_right_handed, (const Vec3d& a, const Vec3d& b)) {
    const Vec3d c = cross(a, b);
    const double size = length(a) * length(b);
    RC_ASSERT(std::abs(dot(c, a)) <= 1e-14 * size * length(a));
    RC_ASSERT(std::abs(dot(c, b)) <= 1e-14 * size * length(b));
    RC_ASSERT(c == -cross(b, a));
    RC_ASSERT(std::abs(length_squared(c) + dot(a, b) * dot(a, b) - size * size) <= 1e-13 * size * size + 1e-300);
}

TEST(Vec3, cross_of_x_and_y_is_z) { EXPECT_EQ(cross(Vec3{1, 0, 0}, Vec3{0, 1, 0}), (Vec3{0, 0, 1})); }

RC_GTEST_PROP(Vec3, normalized_is_unit_and_along, (const Vec3& a)) {
    RC_PRE(length(a) > 1e-6f);
    const Vec3 n = normalized(a);
    RC_ASSERT(std::abs(length(n) - 1) < 3e-7f);
    RC_ASSERT(length(cross(n, a)) <= 1e-6f * length(a));
    RC_ASSERT(dot(n, a) > 0);
}

TEST(Vec3, of_length_0_normalizes_to_zero) {
    EXPECT_EQ(normalized(Vec3{}), Vec3{});
    EXPECT_EQ(normalized(Vec3{1e-30f, 0, 0}), Vec3{}) << "its square is 0";
}

RC_GTEST_PROP(Vec3, any_perpendicular_is_unit_and_perpendicular, (const Vec3& a)) {
    RC_PRE(length(a) > 1e-3f);
    const Vec3 n = normalized(a), p = any_perpendicular(n);
    RC_ASSERT(std::abs(length(p) - 1) < 1e-6f);
    RC_ASSERT(std::abs(dot(p, n)) < 1e-6f);
}

TEST(Vec3, any_perpendicular_is_valid_at_the_poles) {
    for (const Vec3 n : {Vec3{0, 0, 1}, Vec3{0, 0, -1}, Vec3{0, 0, -0.0f}, Vec3{0, 1, 0}, Vec3{-1, 0, 0}}) {
        if (length(n) == 0) continue;
        EXPECT_FLOAT_EQ(length(any_perpendicular(n)), 1);
        EXPECT_FLOAT_EQ(dot(any_perpendicular(n), n), 0);
    }
}

TEST(Vec3, min_and_max_return_the_second_for_NaN) {
    EXPECT_EQ(min(Vec3{nan, 1, 5}, Vec3{2, 3, 4}), (Vec3{2, 1, 4}));
    EXPECT_EQ(max(Vec3{nan, 1, 5}, Vec3{2, 3, 4}), (Vec3{2, 3, 5}));
    EXPECT_EQ(abs(Vec3{-1, 2, -3}), (Vec3{1, 2, 3}));
}

TEST(Vec3, is_finite_tests_each_component) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    EXPECT_TRUE(is_finite(Vec3{1, 2, 3}));
    for (const float bad : {nan, inf, -inf}) {
        EXPECT_FALSE(is_finite(Vec3{bad, 0, 0}));
        EXPECT_FALSE(is_finite(Vec3{0, bad, 0}));
        EXPECT_FALSE(is_finite(Vec3{0, 0, bad}));
    }
}

}  // namespace
}  // namespace fase
