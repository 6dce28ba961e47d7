/// Poses: composition and inversion of rigid transforms.
#include "fase/math/pose.hpp"

#include <gtest/gtest.h>

#include "tests/math/arbitrary.hpp"

namespace fase {
namespace {

float size_of(const LocalPose& p) { return length(p.position); }

RC_GTEST_PROP(LocalPose, transform_back_undoes_transform, (const LocalPose& pose, const Vec3& p)) {
    RC_ASSERT(length(transform_back(pose, transform(pose, p)) - p) <= 4e-6f * (size_of(pose) + length(p)));
    RC_ASSERT(length(transform(inverse(pose), transform(pose, p)) - p) <= 4e-6f * (size_of(pose) + length(p)));
}

RC_GTEST_PROP(LocalPose, products_apply_the_right_one_first, (const LocalPose& a, const LocalPose& b, const Vec3& p)) {
    const float size = size_of(a) + size_of(b) + length(p);
    RC_ASSERT(length(transform(a * b, p) - transform(a, transform(b, p))) <= 4e-6f * size);
}

RC_GTEST_PROP(Pose, relative_takes_points_of_one_body_to_the_other, (const Pose& a, const Pose& b, const Vec3& p)) {
    const LocalPose b_in_a = relative(a, b);
    const double size = length(a.position) + length(b.position) + length(p);
    RC_ASSERT(length(transform(a, transform(b_in_a, p)) - transform(b, p)) <= 4e-6 * size);
    RC_ASSERT(length(transform_back(a, transform(b, p)) - transform(b_in_a, p)) <= 4e-6 * size);
    const Pose again = a * b_in_a;
    RC_ASSERT(length(again.position - b.position) <= 4e-6 * size);
}

TEST(Pose, resolves_a_tenth_of_a_millimetre_at_ten_thousand_kilometres) {
    const Pose a{{1e7, -1e7, 1e7}, {}}, b{{1e7 + 1e-4, -1e7, 1e7}, {}};
    EXPECT_NEAR(relative(a, b).position.x, 1e-4f, 1e-8f);
    EXPECT_NEAR(transform_back(a, transform(b, Vec3{0.5f, 0, 0})).x, 0.5001f, 1e-7f);
}

TEST(Pose, relative_to_itself_is_exactly_zero) {
    const Pose a{{1e7 / 3, 2, 3}, normalized(Quat{1, 2, 3, 4})};
    EXPECT_EQ(relative(a, a).position, Vec3{});
}

}  // namespace
}  // namespace fase
