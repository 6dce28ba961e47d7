#include "fase/world/fixed_step.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "fase/core/random.hpp"

namespace fase {
namespace {

TEST(FixedStep, does_as_many_steps_as_time_passes) {
    for (const double frame : {1.0 / 30, 1.0 / 59, 1.0 / 60, 1.0 / 61, 1.0 / 144, 1.0 / 1000}) {
        FixedStep loop(1.0 / 60);
        int steps = 0;
        const int frames = static_cast<int>(10 / frame + 0.5);
        for (int i = 0; i < frames; ++i) {
            steps += loop.advance(frame);
            EXPECT_GE(loop.alpha(), 0);
            EXPECT_LE(loop.alpha(), 1);
        }
        EXPECT_NEAR(steps + static_cast<double>(loop.alpha()), frames * frame * 60, 1e-3) << frame;
        EXPECT_EQ(loop.dropped(), 0);
    }
}

TEST(FixedStep, conserves_time_for_any_frames) {
    Random random(4);
    FixedStep loop(0.01, 3);
    double passed = 0, simulated = 0;
    for (int i = 0; i < 5000; ++i) {
        const double frame = static_cast<double>(random.between(0, 0.05f));
        passed += frame;
        const int steps = loop.advance(frame);
        EXPECT_GE(steps, 0);
        EXPECT_LE(steps, 3);
        simulated += steps * loop.step();
    }
    EXPECT_GT(loop.dropped(), 0);
    EXPECT_NEAR(simulated + loop.dropped() + static_cast<double>(loop.alpha()) * loop.step(), passed, 1e-6);
}

TEST(FixedStep, ignores_times_that_make_no_sense) {
    FixedStep loop(0.02, 5);
    const double infinity = std::numeric_limits<double>::infinity();
    for (const double seconds : {0.0, -1.0, infinity, -infinity, std::numeric_limits<double>::quiet_NaN()})
        EXPECT_EQ(loop.advance(seconds), 0);
    EXPECT_EQ(loop.advance(0.05), 2);
    EXPECT_NEAR(loop.alpha(), 0.5, 1e-6);
    loop.reset();
    EXPECT_EQ(loop.alpha(), 0);
    EXPECT_EQ(FixedStep(0, 0).step(), 1.0 / 60);
    EXPECT_EQ(FixedStep(0.01, 0).advance(100), 1);
}

}  // namespace
}  // namespace fase
