/// Tests that the error of encoded poses is within the limits of the format.
#include "fase/record/recording/pose_code.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/record/artificial_run.hpp"

namespace fase::record {
namespace {

Quat any_rotation(std::uint64_t i) {
    return to_float(
        normalized(Quatd{noise(i, 1, 0) - 0.5, noise(i, 2, 0) - 0.5, noise(i, 3, 0) - 0.5, noise(i, 4, 0) - 0.5}));
}

TEST(PoseCode, RotationErrorIsBelowTwoHundredthsOfADegree) {
    double worst = 0;
    for (std::uint64_t i = 0; i < 200000; ++i) {
        const Quat q = any_rotation(i);
        worst = std::max(worst, degrees_between(q, decode_rotation(encode_rotation(q))));
    }
    for (const Quat q : {Quat{0.5f, 0.5f, 0.5f, 0.5f}, Quat{-0.5f, 0.5f, -0.5f, 0.5f}, Quat{}, Quat{1, 0, 0, 0},
                         Quat{0, 0.70710678f, 0.70710678f, 0}, Quat{0, 0, -0.70710678f, 0.70710678f}}) {
        worst = std::max(worst, degrees_between(q, decode_rotation(encode_rotation(q))));
    }
    RecordProperty("worst_degrees", std::to_string(worst));
    EXPECT_LT(worst, 0.02);
    EXPECT_GT(worst, 0.001);  // the measurement is not trivially 0
}

TEST(PoseCode, ARotationAndItsNegativeHaveTheSameCode) {
    for (std::uint64_t i = 0; i < 1000; ++i) {
        const Quat q = any_rotation(i);
        EXPECT_EQ(encode_rotation(q), encode_rotation(Quat{-q.x, -q.y, -q.z, -q.w}));
    }
}

TEST(PoseCode, PositionErrorIsBelowAMillimetreFarFromTheOrigin) {
    for (std::uint64_t i = 0; i < 10000; ++i) {
        const double far = i % 2 == 0 ? 1e6 : 1e7;
        const Pose pose{{far + noise(i, 1, 0), -far * noise(i, 2, 0), noise(i, 3, 0)}, {}};
        const Pose back = decode_pose(encode_pose(pose, 2048), 2048);
        EXPECT_LT(length(back.position - pose.position), 0.0005);
    }
}

TEST(PoseCode, EveryCodeDecodesToAUnitQuaternion) {
    for (const int a : {0, 1, 8192, 16383}) {
        for (const int b : {0, 8192, 16383}) {
            for (std::uint8_t largest = 0; largest < 4; ++largest) {
                const RotationCode code{{static_cast<std::uint16_t>(a), static_cast<std::uint16_t>(b), 16383}, largest};
                EXPECT_NEAR(length_squared(decode_rotation(code)), 1, 1e-5);
            }
        }
    }
}

}  // namespace
}  // namespace fase::record
