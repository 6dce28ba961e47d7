/// Energies and what watch() reports, in scenes with known answers.
#include "bench/checks/check_world.hpp"

#include <gtest/gtest.h>

namespace fase::checks {
namespace {

TEST(CheckWorld, energy_is_that_of_the_formulas) {
    Context context;
    CheckWorld world(context);
    world.add({.position = {3, 2, 0}, .linear_velocity = {3, 4, 0}, .angular_velocity = {0, 0, 2}},
              Box{{1, 0.5f, 0.5f}});
    const double mass = 2000, inertia = mass / 12 * (4 + 1);
    EXPECT_NEAR(world.energy().kinetic, 0.5 * mass * 25 + 0.5 * inertia * 4, 1e-2);
    EXPECT_NEAR(world.energy().potential, mass * 9.81 * 2, 1e-2);
    ASSERT_TRUE(world.step());  // the integrator is exact under constant gravity
    EXPECT_NEAR(world.energy().total(), 25000 + 0.5 * inertia * 4 + mass * 9.81 * 2, 1);
}

TEST(CheckWorld, watch_reports_a_body_that_falls_sideways) {
    Context context;
    CheckWorld world(context, awake_settings());
    world.add({.position = {0, 10, 0}, .linear_velocity = {1, 0, 0}}, Sphere{0.5f});
    world.add({.position = {10, 5, 0}, .gravity_scale = 0}, Sphere{0.5f});
    const Watched seen = watch(world, 1);
    EXPECT_NEAR(seen.sinks, 4.905, 1e-3);
    EXPECT_NEAR(seen.worst_dip, 4.905, 1e-3);
    EXPECT_NEAR(seen.drift, 1, 1e-3);
    EXPECT_EQ(seen.fallen, 1);
    EXPECT_EQ(seen.asleep_at, -1);
    EXPECT_NEAR(seen.gain, 0, 1e-3);
    EXPECT_EQ(context.error, "");
}

TEST(CheckWorld, a_refused_call_is_recorded) {
    Context context;
    CheckWorld world(context);
    world.add({.position = {0, 1e30, 0}}, Sphere{0.5f});
    EXPECT_NE(context.error, "");
    EXPECT_FALSE(world.step());
}

}  // namespace
}  // namespace fase::checks
