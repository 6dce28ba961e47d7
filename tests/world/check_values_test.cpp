// The ranges of numbers: the same at every door, for single values and for what follows from several.
#include "fase/world/check_values.hpp"

#include "tests/world/worlds.hpp"

namespace fase {
namespace {

using namespace test;

class Ranges : public testing::Test {
protected:
    World world = make_world();
    BodyId box = add(world, {}, Box{});
    BodyId platform = add(world, {.kind = BodyKind::Kinematic, .position = {5, 0, 0}}, Box{});
    /// Expects a refusal that names the field and changes nothing.
    template <class F> void expect_refused(const F& call, const char* field) {
        const std::uint64_t before = world.hash();
        const auto result = call();
        ASSERT_FALSE(result) << field;
        EXPECT_EQ(result.status(), Status::BadArgument) << field;
        EXPECT_NE(result.error().text().find(field), std::string::npos) << result.error().text();
        EXPECT_EQ(world.hash(), before) << field;
    }
};

TEST_F(Ranges, speeds_are_the_same_at_every_door) {
    const Vec3 fast{1.1e7f, 0, 0}, spin{0, 1.1e6f, 0};
    expect_refused([&] { return world.add_body({.linear_velocity = fast}); }, "linear_velocity");
    expect_refused([&] { return world.add_body({.angular_velocity = spin}, Sphere{}); }, "angular_velocity");
    expect_refused([&] { return world.set_velocity(box, fast, {}); }, "linear_velocity");
    expect_refused([&] { return world.set_velocity(platform, {}, spin); }, "angular_velocity");
    expect_refused([&] { return world.apply_impulse(box, {1.1e10f, 0, 0}); }, "linear_velocity");
    expect_refused([&] { return world.apply_angular_impulse(box, {0, 1e9f, 0}); }, "angular_velocity");
    expect_refused([&] { return world.move_kinematic(platform, {{1e6, 0, 0}, {}}, 1e-3f); }, "linear_velocity");
    EXPECT_TRUE(world.set_velocity(box, {9e6f, 0, 0}, {}));
}

TEST_F(Ranges, combined_masses_are_checked) {
    expect_refused([&] { return world.add_body({}, Box{{1e5f, 1e5f, 1e5f}}, {.density = 1e6f}); }, "combined mass");
    expect_refused([&] { return world.add_body({}, Sphere{}, {.density = 1e-20f}); }, "combined mass");
    expect_refused([&] { return world.add_body({}, Sphere{}, {.density = 1e20f}); }, "density");
    expect_refused(
        [&] {
            return world.add_collider(box, Box{{1e5f, 1e5f, 1e5f}}, {.density = 1e9f});
        },
        "combined mass");
    expect_refused([&] { return world.add_collider(box, Sphere{}, {.pose = {{3e38f, 0, 0}, {}}}); }, "pose.position");
    MassProperties mass{1, {1e20f, 0, 0}, Mat3::identity()};
    expect_refused([&] { return world.set_mass(box, mass); }, "centre");
    expect_refused([&] { return world.add_body({.mass = mass}); }, "centre");
    mass = {1e-39f, {}, Mat3::diagonal({1e-39f, 1e-39f, 1e-39f})};
    expect_refused([&] { return world.set_mass(box, mass); }, "mass");
    mass = {1, {1e5f, 0, 0}, Mat3::identity()};
    expect_refused([&] { return world.add_body({.position = {9.95e6, 0, 0}, .mass = mass}); }, "centre of mass");
}

TEST_F(Ranges, forces_add_up_within_their_range) {
    expect_refused([&] { return world.apply_force(box, {2e20f, 0, 0}); }, "newtons");
    ASSERT_TRUE(world.apply_force(box, {6e19f, 0, 0}));
    expect_refused([&] { return world.apply_force(box, {6e19f, 0, 0}); }, "sum of forces");
    expect_refused([&] { return world.apply_torque(box, {0, 2e28f, 0}); }, "torque");
}

TEST_F(Ranges, other_values) {
    expect_refused([&] { return world.add_body({.gravity_scale = 1e7f}); }, "gravity_scale");
    expect_refused([&] { return world.set_gravity_scale(box, -1e7f); }, "gravity_scale");
    expect_refused([&] { return world.set_damping(box, 1e7f, 0); }, "linear");
    expect_refused([&] { return world.set_material(world.colliders_of(box)[0], {.friction = 1e7f}); }, "friction");
    expect_refused(
        [&] {
            return world.set_material(world.colliders_of(box)[0], {.friction_combine = static_cast<CombineMode>(9)});
        },
        "combine mode");
    Settings settings;
    settings.gravity = {0, -1e7f, 0};
    expect_refused([&] { return world.set_settings(settings); }, "gravity");
}

TEST(Limits, hold_before_anything_moves) {
    for (const BodyKind kind : {BodyKind::Dynamic, BodyKind::Kinematic}) {
        for (const float speed : {2000.0f, 1e6f, 1e7f}) {
            World world = make_world();
            const BodyId ball = add(world, {.kind = kind, .gravity_scale = 0}, Sphere{});
            ASSERT_TRUE(world.set_velocity(ball, {speed, 0, 0}, {}));
            const auto report = world.step();
            ASSERT_TRUE(report);
            EXPECT_EQ(report->speed_clamped, 1u);
            EXPECT_LE(state(world, ball).pose.position.x, 1000.0 / 60 + 0.01) << speed;
            EXPECT_LE(state(world, ball).linear_velocity.x, 1000.01f);
        }
    }
}

TEST(Limits, a_kinematic_target_too_far_for_a_step_takes_several) {
    World world = make_world();
    const BodyId lift = add(world, {.kind = BodyKind::Kinematic}, Box{});
    int steps = 0;
    for (; state(world, lift).pose.position.x < 99.9 && steps < 100; ++steps) {
        ASSERT_TRUE(world.move_kinematic(lift, {{100, 0, 0}, {}}, world.settings().time_step));
        const auto report = world.step();
        ASSERT_TRUE(report);
        EXPECT_EQ(report->speed_clamped, steps < 5 ? 1u : 0u);  // 16.7 m in a step
    }
    EXPECT_EQ(steps, 6);
}

TEST(Limits, a_body_that_leaves_the_world_stays_at_its_border_and_is_reported) {
    World world = make_world();
    const BodyId ball =
        add(world, {.position = {9.99999e6, 0, 0}, .linear_velocity = {1000, 0, 0}, .gravity_scale = 0}, Sphere{});
    std::uint32_t left = 0;
    for (int i = 0; i < 10; ++i) {
        const auto report = world.step();
        ASSERT_TRUE(report);
        left += report->left_world;
        EXPECT_EQ(report->quarantined, report->left_world);
    }
    EXPECT_EQ(left, 1u);
    EXPECT_TRUE(state(world, ball).quarantined);
    EXPECT_LE(state(world, ball).pose.position.x, 1e7);
    EXPECT_TRUE(world.set_pose(ball, state(world, ball).pose));
    EXPECT_TRUE(make_world().restore(world.snapshot()));
}

}  // namespace
}  // namespace fase
