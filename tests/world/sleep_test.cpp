// Sleep: what falls asleep, what wakes it, and what a sleeping world costs.
#include "tests/world/worlds.hpp"

namespace fase {
namespace {

using namespace test;

struct Tower {
    World world = make_world();
    BodyId ground = add_ground(world);
    BodyId plate = add(world, {.kind = BodyKind::Static, .position = {0, 0.5, 0}}, Box{{2, 0.5f, 2}});
    std::vector<BodyId> boxes;
    Tower() {
        for (int i = 0; i < 5; ++i) boxes.push_back(add(world, {.position = {0, 1.5 + i, 0}}, Box{}));
        run(world, 2);
        for (const BodyId box : boxes) EXPECT_FALSE(state(world, box).awake);
    }
    [[nodiscard]] bool all_awake() {
        EXPECT_TRUE(world.step());
        for (const BodyId box : boxes)
            if (!world.contains(box) || state(world, box).awake)
                continue;
            else
                return false;
        return true;
    }
};

TEST(Sleep, an_impulse_wakes_the_island) {
    Tower t;
    ASSERT_TRUE(t.world.apply_impulse(t.boxes[4], {0, 10, 0}));
    EXPECT_TRUE(t.all_awake());
}
TEST(Sleep, a_touch_wakes_the_island) {
    Tower t;
    add(t.world, {.position = {0, 8, 0}}, Sphere{0.3f});
    run(t.world, 1);
    EXPECT_TRUE(t.all_awake());
}
TEST(Sleep, a_removed_support_wakes_what_stood_on_it) {
    Tower t;
    ASSERT_TRUE(t.world.remove_body(t.plate));
    EXPECT_TRUE(t.all_awake());
    run(t.world, 2);
    EXPECT_NEAR(state(t.world, t.boxes[0]).pose.position.y, 0.5, 0.05);
}
TEST(Sleep, a_moved_support_wakes_what_stood_on_it) {
    Tower t;
    ASSERT_TRUE(t.world.set_pose(t.plate, {{0, -1, 0}, {}}));
    EXPECT_TRUE(t.all_awake());
}
TEST(Sleep, an_approaching_kinematic_body_wakes_what_it_touches) {
    Tower t;
    const BodyId pusher = add(t.world, {.kind = BodyKind::Kinematic, .position = {-3, 3, 0}}, Box{{0.5f, 2, 0.5f}});
    run(t.world, 0.5);
    ASSERT_TRUE(t.world.set_velocity(pusher, {2, 0, 0}, {}));
    run(t.world, 1.5);
    EXPECT_GT(state(t.world, t.boxes[2]).pose.position.x, 0.1);
}
TEST(Sleep, a_new_obstacle_wakes_what_it_overlaps) {
    Tower t;
    add(t.world, {.kind = BodyKind::Static, .position = {0.8, 3, 0}}, Box{{0.5f, 0.5f, 0.5f}});
    EXPECT_TRUE(t.all_awake());
}
TEST(Sleep, a_distant_body_wakes_nothing) {
    Tower t;
    add(t.world, {.position = {20, 5, 0}}, Sphere{});
    for (int i = 0; i < 100; ++i) ASSERT_TRUE(t.world.step());
    for (const BodyId box : t.boxes) EXPECT_FALSE(state(t.world, box).awake);
}
TEST(Sleep, a_sleeping_world_queries_no_pairs_and_solves_nothing) {
    Tower t;
    const std::uint64_t before = t.world.hash();
    ASSERT_TRUE(t.world.step());
    const StepReport& report = t.world.last_report();
    EXPECT_EQ(report.awake, 0u);
    EXPECT_EQ(report.pairs, 0u);
    EXPECT_EQ(report.candidates, 0u);
    EXPECT_EQ(report.manifolds, 0u);
    EXPECT_NE(t.world.hash(), before);  // time advanced
}
TEST(Sleep, a_body_that_may_not_sleep_keeps_its_island_awake) {
    World world = make_world();
    add_ground(world);
    const BodyId below = add(world, {.position = {0, 0.5, 0}}, Box{});
    add(world, {.position = {0, 1.5, 0}, .can_sleep = false}, Box{});
    const BodyId alone = add(world, {.position = {5, 0.5, 0}}, Box{});
    run(world, 3);
    EXPECT_TRUE(state(world, below).awake);
    EXPECT_FALSE(state(world, alone).awake);
}
TEST(Sleep, a_world_without_sleep_stays_awake) {
    Settings settings;
    settings.sleep = false;
    World world = make_world(settings);
    add_ground(world);
    const BodyId box = add(world, {.position = {0, 0.5, 0}}, Box{});
    run(world, 3);
    EXPECT_TRUE(state(world, box).awake);
}
TEST(Sleep, a_body_made_asleep_stays_until_it_is_touched) {
    World world = make_world();
    add_ground(world);
    const BodyId box = add(world, {.position = {0, 3, 0}, .awake = false}, Box{});
    run(world, 1);
    EXPECT_EQ(state(world, box).pose.position.y, 3);
    ASSERT_TRUE(world.wake(box));
    run(world, 0.2);
    EXPECT_LT(state(world, box).pose.position.y, 2.9);
}
TEST(Sleep, a_slow_start_on_a_slope_is_not_taken_for_rest) {
    Settings settings;
    settings.gravity = {0.1f, -9.81f, 0};
    World world = make_world(settings);
    add_ground(world, {.friction = 0});
    const BodyId box = add(world, {.position = {0, 0.5, 0}}, Box{}, {.material = {.friction = 0}});
    run(world, 4);
    EXPECT_NEAR(state(world, box).pose.position.x, 0.5 * 0.1 * 16, 0.02);
}

}  // namespace
}  // namespace fase
