#include "fase/math/interpolate.hpp"

#include <gtest/gtest.h>

#include "fase/core/random.hpp"

namespace fase {
namespace {

Quat random_rotation(Random& random) {
    Quat q;
    do {
        q = {random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)};
    } while (length_squared(q) < 0.1f);
    return normalized(q);
}
/// The angle of the rotation from a to b, radians.
float angle_between(Quat a, Quat b) {
    const Quat d = conjugate(a) * b;
    return 2 * std::atan2(length(d.vector()), std::abs(d.w));
}

TEST(Interpolate, reaches_both_ends_by_the_shorter_way) {
    Random random(1);
    for (int i = 0; i < 2000; ++i) {
        const Quat a = random_rotation(random), b = random_rotation(random);
        const float t = random.between(0, 1), whole = angle_between(a, b);
        for (const Quat q : {nlerp(a, b, t), slerp(a, b, t)}) {
            EXPECT_NEAR(length_squared(q), 1, 1e-5);
            EXPECT_NEAR(angle_between(a, q) + angle_between(q, b), whole, 2e-3) << "q lies on the way";
        }
        EXPECT_NEAR(angle_between(a, slerp(a, b, t)), t * whole, 2e-3) << "constant speed";
        EXPECT_NEAR(angle_between(nlerp(a, b, 0.5f), slerp(a, b, 0.5f)), 0, 2e-3);
        for (const auto& f : {nlerp<float>, slerp<float>}) {
            EXPECT_NEAR(angle_between(f(a, b, 0), a), 0, 2e-3);
            EXPECT_NEAR(angle_between(f(a, b, 1), b), 0, 2e-3);
        }
        EXPECT_NEAR(angle_between(slerp(a, a, t), a), 0, 2e-3);
    }
}

TEST(Interpolate, poses_move_and_rotate_together) {
    const Pose a{{1e6, 0, 0}, {}}, b{{1e6 + 1, 4, -2}, rotation_about(Vec3{0, 1, 0}, 1.0f)};
    const Pose half = interpolate(a, b, 0.5f);
    EXPECT_EQ(half.position, (Vec3d{1e6 + 0.5, 2, -1}));
    EXPECT_NEAR(angle_between(a.rotation, half.rotation), 0.5, 1e-3);
    EXPECT_EQ(interpolate(a, b, 0).position, a.position);
    EXPECT_EQ(interpolate(LocalPose{{0, 0, 0}}, LocalPose{{2, 0, 0}}, 0.25f).position, (Vec3{0.5f, 0, 0}));
}

}  // namespace
}  // namespace fase
