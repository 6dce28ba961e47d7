// Sleep: what falls asleep, what wakes it, and what a sleeping world costs.
#include <functional>

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

TEST(Sleep, no_body_hangs_in_the_air_whenever_its_support_goes) {
    // Removed, moved aside or let through, or the body between moved: just before, while and after the body falls
    // asleep.
    for (const float gravity : {-9.81f, -1.62f})
        for (const float time_step : {1 / 60.0f, 1 / 120.0f})
            for (int way = 0; way < 4; ++way)
                for (int wait = 24; wait < 72; wait += 3) {
                    Settings settings;
                    settings.gravity.y = gravity;
                    settings.time_step = time_step;
                    World world = make_world(settings);
                    const BodyId floor =
                        add(world, {.kind = BodyKind::Static, .position = {0, -0.5, 0}}, Box{{5, 0.5f, 5}});
                    const BodyId low = add(world, {.position = {0, 0.5, 0}}, Box{});
                    const BodyId high = add(world, {.position = {0, 1.5, 0}}, Box{});
                    for (int i = 0; i < wait; ++i) ASSERT_TRUE(world.step());
                    if (way == 0) opened(world.remove_body(floor));
                    if (way == 1) opened(world.set_pose(floor, {{100, 0, 0}, {}}));
                    if (way == 2) opened(world.set_filter(world.colliders_of(floor)[0], {.category = 2, .mask = 0}));
                    if (way == 3) opened(world.set_pose(low, {{3, 0.5, 0}, {}}));
                    run(world, 1.5);
                    EXPECT_LT(state(world, high).pose.position.y, 0.8) << gravity << ' ' << way << ' ' << wait;
                }
}
TEST(Sleep, a_body_that_is_moved_into_the_air_falls) {
    for (int wait = 20; wait < 100; wait += 7) {
        Settings settings;
        settings.time_step = 1 / 120.0f;
        World world = make_world(settings);
        add_ground(world);
        const BodyId box = add(world, {.position = {0, 0.5, 0}}, Box{});
        for (int i = 0; i < wait; ++i) ASSERT_TRUE(world.step());
        opened(world.set_pose(box, {{0, 10, 0}, {}}));
        run(world, 0.5);
        EXPECT_LT(state(world, box).pose.position.y, 9.9) << wait;
    }
}
TEST(Sleep, bodies_made_asleep_fall_when_their_support_goes) {
    for (int way = 0; way < 5; ++way) {
        World world = make_world();
        const BodyId floor = add(world, {.kind = BodyKind::Static, .position = {0, -0.5, 0}}, Box{{5, 0.5f, 5}});
        const BodyId low = add(world, {.position = {0, 0.5, 0}, .awake = false}, Box{});
        const BodyId high = add(world, {.position = {0, 1.5, 0}, .awake = false}, Box{});
        run(world, 1);
        EXPECT_FALSE(state(world, low).awake || state(world, high).awake);
        if (way == 0) opened(world.remove_body(floor));
        if (way == 1) opened(world.remove_body(low));
        if (way == 2) opened(world.set_pose(floor, {{100, 0, 0}, {}}));
        if (way == 3) opened(world.exclude_pair(floor, low));
        if (way == 4) opened(world.set_pose(low, {{3, 0.5, 0}, {}}));
        run(world, 1);
        EXPECT_LT(state(world, high).pose.position.y, 0.8) << way;
    }
}
TEST(Sleep, a_platform_that_is_driven_to_where_it_stands_keeps_nobody_awake) {
    World world = make_world();
    const Quat tilt = normalized(Quat{0, 0.3f, 0, 0.95f});
    const BodyId platform = add(world, {.kind = BodyKind::Kinematic, .position = {0.3, 0.1, 7}, .rotation = tilt},
                                Box{{5, 0.5f, 5}}, {.pose = {{0.1f, 0, 0}, tilt}});
    const BodyId box = add(world, {.position = {0.3, 1.1, 7}}, Box{});
    std::size_t woke = 0;
    for (int i = 0; i < 300; ++i) {
        opened(world.move_kinematic(platform, state(world, platform).pose, 1 / 60.0f));
        ASSERT_TRUE(world.step());
        woke += world.events().woke_up.size();
    }
    EXPECT_FALSE(state(world, box).awake || state(world, platform).awake);
    EXPECT_EQ(woke, 0u);
}
TEST(Sleep, a_platform_that_creeps_arrives) {
    World world = make_world();
    const BodyId platform = add(world, {.kind = BodyKind::Kinematic}, Box{{5, 0.5f, 5}});
    for (int i = 1; i <= 600; ++i) {
        opened(world.move_kinematic(platform, {{0, 1e-7 * i, 0}, {}}, 1 / 60.0f));
        ASSERT_TRUE(world.step());
    }
    EXPECT_NEAR(state(world, platform).pose.position.y, 6e-5, 2e-6);
}

/// A change of a world that may move a sleeping box on a ramp, or what touches it.
struct Change {
    const char* name;
    std::function<Result<void>(World&, BodyId ramp, BodyId box)> make;
};
std::vector<Change> changes_that_wake() {
    const auto ramp_collider = [](World& w, BodyId ramp) { return w.colliders_of(ramp)[0]; };
    const auto with = [](auto change) {
        return [change](World& w, BodyId, BodyId) {
            Settings s = w.settings();
            change(s);
            return w.set_settings(s);
        };
    };
    return {
        {"gravity", with([](Settings& s) {
             s.gravity = {0, 1, 0};
         })},
        {"contact frequency", with([](Settings& s) { s.contact_frequency = 10; })},
        {"contact damping", with([](Settings& s) { s.contact_damping_ratio = 1; })},
        {"push-out speed", with([](Settings& s) { s.push_out_speed = 1; })},
        {"no sleep", with([](Settings& s) { s.sleep = false; })},
        {"gravity scale", [](World& w, BodyId, BodyId box) { return w.set_gravity_scale(box, 0.5f); }},
        {"damping", [](World& w, BodyId, BodyId box) { return w.set_damping(box, 1, 1); }},
        {"locks", [](World& w, BodyId, BodyId box) { return w.set_locks(box, {.linear_x = true}); }},
        {"mass",
         [](World& w, BodyId, BodyId box) {
             return w.set_mass(box, MassProperties{2, {}, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}});
         }},
        {"may not sleep", [](World& w, BodyId, BodyId box) { return w.set_can_sleep(box, false); }},
        {"wake", [](World& w, BodyId, BodyId box) { return w.wake(box); }},
        {"velocity",
         [](World& w, BodyId, BodyId box) {
             return w.set_velocity(box, {0, 1, 0}, {});
         }},
        {"pose",
         [](World& w, BodyId, BodyId box) {
             return w.set_pose(box, {{0, 9, 0}, {}});
         }},
        {"force",
         [](World& w, BodyId, BodyId box) {
             return w.apply_force(box, {1, 0, 0});
         }},
        {"force at a point",
         [](World& w, BodyId, BodyId box) {
             return w.apply_force_at(box, {1, 0, 0}, {});
         }},
        {"torque",
         [](World& w, BodyId, BodyId box) {
             return w.apply_torque(box, {1, 0, 0});
         }},
        {"impulse",
         [](World& w, BodyId, BodyId box) {
             return w.apply_impulse(box, {1, 0, 0});
         }},
        {"impulse at a point",
         [](World& w, BodyId, BodyId box) {
             return w.apply_impulse_at(box, {1, 0, 0}, {});
         }},
        {"angular impulse",
         [](World& w, BodyId, BodyId box) {
             return w.apply_angular_impulse(box, {1, 0, 0});
         }},
        {"own material",
         [](World& w, BodyId, BodyId box) { return w.set_material(w.colliders_of(box)[0], {.friction = 0}); }},
        {"own filter",
         [](World& w, BodyId, BodyId box) { return w.set_filter(w.colliders_of(box)[0], {.category = 2}); }},
        {"own collider added",
         [](World& w, BodyId, BodyId box) {
             const auto added = w.add_collider(box, Sphere{0.1f});
             return added ? Result<void>{} : Result<void>{added.error()};
         }},
        {"own collider removed",
         [](World& w, BodyId, BodyId box) { return w.remove_collider(w.colliders_of(box)[0]); }},
        {"material of the support",
         [=](World& w, BodyId ramp, BodyId) { return w.set_material(ramp_collider(w, ramp), {.friction = 0}); }},
        {"filter of the support",
         [=](World& w, BodyId ramp, BodyId) { return w.set_filter(ramp_collider(w, ramp), {.category = 2}); }},
        {"exclusion", [](World& w, BodyId ramp, BodyId box) { return w.exclude_pair(ramp, box); }},
        {"kind of the support", [](World& w, BodyId ramp, BodyId) { return w.set_kind(ramp, BodyKind::Dynamic); }},
        {"pose of the support",
         [](World& w, BodyId ramp, BodyId) {
             return w.set_pose(ramp, {{0, -1, 0}, {}});
         }},
        {"support gone", [](World& w, BodyId ramp, BodyId) { return w.remove_body(ramp); }},
        {"collider of the support gone",
         [=](World& w, BodyId ramp, BodyId) { return w.remove_collider(ramp_collider(w, ramp)); }},
    };
}
TEST(Sleep, whatever_may_move_a_body_wakes_it) {
    const Quat tilt = normalized(Quat{0, 0, 0.15f, 0.98f});
    for (const BodyKind kind : {BodyKind::Static, BodyKind::Kinematic})
        for (const Change& change : changes_that_wake()) {
            World world = make_world();
            const BodyId ramp = add(world, {.kind = kind, .rotation = tilt}, Box{{5, 0.5f, 5}});
            const BodyId box =
                add(world, {.position = to_double(rotate(tilt, Vec3{0, 1, 0})), .rotation = tilt}, Box{});
            run(world, 3);
            ASSERT_FALSE(state(world, box).awake);
            opened(change.make(world, ramp, box));
            ASSERT_TRUE(world.step());
            EXPECT_TRUE(state(world, box).awake) << change.name;
        }
}
TEST(Sleep, what_is_let_collide_again_wakes) {
    World world = make_world();
    const BodyId floor = add(world, {.kind = BodyKind::Static}, Box{{5, 0.5f, 5}});
    const BodyId box = add(world, {.position = {0, 0.9, 0}, .gravity_scale = 0}, Box{});
    opened(world.exclude_pair(floor, box));
    run(world, 2);
    ASSERT_FALSE(state(world, box).awake);
    opened(world.include_pair(floor, box));
    run(world, 0.5);
    EXPECT_GT(state(world, box).pose.position.y, 0.95);
}
TEST(Sleep, forces_of_nothing_wake_nobody) {
    Tower t;
    opened(t.world.apply_force(t.boxes[0], {}));
    opened(t.world.apply_torque(t.boxes[0], {}));
    ASSERT_TRUE(t.world.step());
    EXPECT_FALSE(state(t.world, t.boxes[0]).awake);
}
TEST(Sleep, a_resting_kinematic_body_that_is_moved_into_a_sleeper_wakes_it) {
    Tower t;
    const BodyId wall = add(t.world, {.kind = BodyKind::Kinematic, .position = {9, 3, 0}}, Box{});
    run(t.world, 1);
    opened(t.world.set_pose(wall, {{0.9, 2.5, 0}, {}}));
    run(t.world, 0.5);
    EXPECT_LT(state(t.world, t.boxes[1]).pose.position.x, -0.05);
}

std::uint32_t awake_after(World& world, double seconds) {
    run(world, seconds);
    return world.last_report().awake;
}
TEST(Sleep, one_restless_stone_keeps_only_its_neighbours_awake) {
    World world = make_world();
    add_ground(world);
    for (int layer = 0; layer < 6; ++layer)
        for (int i = 0; i < 100; ++i)
            add(world, {.position = {i % 10 * 1.001, 0.5 + layer, i / 10 * 1.001}}, Box{},
                {.material = {.friction = 0.3f}});
    add(world, {.position = {4.5, 6.5, 4.5}, .can_sleep = false}, Box{});
    const std::uint32_t awake = awake_after(world, 4);
    EXPECT_GE(awake, 2u);
    EXPECT_LE(awake, 60u);
}
TEST(Sleep, a_heap_in_which_one_stone_is_pushed_sleeps_again_and_wakes_no_more_than_it_must) {
    World world = make_world();
    add_ground(world);
    Random random(3);
    for (int i = 0; i < 300; ++i)
        add(world, {.position = {(i % 6) - 3.0, 1.0 + i / 36, (i / 6 % 6) - 3.0}, .rotation = random_rotation(random)},
            Box{{0.4f, 0.3f, 0.35f}});
    run(world, 20);
    ASSERT_EQ(world.last_report().awake, 0u);
    const BodyId box = add(world, {.position = {0, 6, 0}}, Box{{0.2f, 0.2f, 0.2f}});
    std::size_t woken = 0;
    for (int i = 0; i < 600; ++i) {
        ASSERT_TRUE(world.step());
        woken += world.events().woke_up.size();
    }
    EXPECT_EQ(world.last_report().awake, 0u);
    EXPECT_LT(woken, 900u);
    EXPECT_FALSE(state(world, box).awake);
}

/// Something to rock on: adds bodies, and returns where the stone stands.
struct Building {
    const char* name;
    Vec3d (*build)(World&);
    std::uint32_t awake;  ///< bodies that may stay awake below the stone, and it
};
Vec3d build_pyramid(World& world) {
    for (int row = 0; row < 10; ++row)
        for (int i = 0; i < 10 - row; ++i) add(world, {.position = {i - 0.5 * (9 - row), 0.5 + row, 0}}, Box{});
    return {0, 10.3, 0};
}
Vec3d build_wall(World& world) {
    for (int row = 0; row < 6; ++row)
        for (int i = 0; i < 12; ++i) add(world, {.position = {i + 0.5 * (row % 2) - 5.5, 0.5 + row, 0}}, Box{});
    return {0, 6.3, 0};
}
Vec3d build_block(World& world) {
    for (int layer = 0; layer < 4; ++layer)
        for (int i = 0; i < 64; ++i) add(world, {.position = {i % 8 * 1.0, 0.5 + layer, i / 8 * 1.0}}, Box{});
    return {4, 4.3, 4};
}
Vec3d build_plank_tower(World& world) {
    for (int layer = 0; layer < 20; ++layer)
        for (const double aside : {-1.2, 0.0, 1.2}) {
            const double y = 0.1 + 0.2 * layer;
            const bool turned = layer % 2 == 1;
            add(world, {.position = turned ? Vec3d{aside, y, 0} : Vec3d{0, y, aside}},
                turned ? Box{{0.3f, 0.1f, 1.5f}} : Box{{1.5f, 0.1f, 0.3f}});
        }
    return {0, 4.3, 0};
}
TEST(Sleep, a_rocking_stone_keeps_awake_only_what_it_may_move) {
    for (const Building& building : {Building{"pyramid", build_pyramid, 2}, Building{"wall", build_wall, 3},
                                     Building{"block", build_block, 2}, Building{"planks", build_plank_tower, 8}}) {
        World world = make_world();
        add_ground(world);
        const BodyId stone = add(world, {.position = building.build(world)}, Box{{0.3f, 0.3f, 0.3f}});
        std::uint32_t awake = 0;
        float turns = 0;
        for (int i = 0; i < 600; ++i) {
            if (i % 30 < 5) opened(world.apply_torque(stone, {0, 0, i / 30 % 2 == 0 ? 900.0f : -900.0f}));
            ASSERT_TRUE(world.step());
            if (i < 300) continue;
            awake = std::max(awake, world.last_report().awake);
            turns = std::max(turns, length(state(world, stone).angular_velocity));
        }
        EXPECT_LE(awake, building.awake) << building.name;
        EXPECT_GT(turns, 0.05f) << building.name;
    }
}
TEST(Sleep, a_row_of_sleepers_gives_way_to_a_steady_push_each_time) {
    World world = make_world();
    add_ground(world, {.friction = 0});
    std::vector<BodyId> row;
    for (int i = 0; i < 4; ++i)
        row.push_back(add(world, {.position = {1.0 * i, 0.5, 0}}, Box{}, {.material = {.friction = 0}}));
    for (int time = 0; time < 4; ++time) {
        run(world, 3);
        ASSERT_EQ(world.last_report().awake, 0u);
        const double before = state(world, row.back()).pose.position.x;
        for (int i = 0; i < 90; ++i) {
            opened(world.apply_force(row.front(), {1200, 0, 0}));  // 0.3 m/s² for the row
            ASSERT_TRUE(world.step());
        }
        EXPECT_NEAR(state(world, row.back()).pose.position.x - before, 0.5 * 0.3 * 1.5 * 1.5, 0.05) << time;
        for (const BodyId box : row) opened(world.set_velocity(box, {}, {}));
    }
}
TEST(Sleep, a_body_does_not_move_when_its_support_falls_asleep) {
    World world = make_world();
    add_ground(world);
    std::vector<BodyId> stack;
    for (int i = 0; i < 12; ++i) stack.push_back(add(world, {.position = {0, 0.5 + i, 0}, .can_sleep = i < 11}, Box{}));
    std::vector<double> before(stack.size());
    double moved = 0;
    for (int i = 0; i < 150; ++i) {
        for (std::size_t k = 0; k < stack.size(); ++k) before[k] = state(world, stack[k]).pose.position.y;
        ASSERT_TRUE(world.step());
        if (i < 55) continue;  // the stack settles
        for (std::size_t k = 0; k < stack.size(); ++k)
            moved = std::max(moved, std::abs(state(world, stack[k]).pose.position.y - before[k]));
    }
    EXPECT_LT(world.last_report().awake, 12u);
    EXPECT_LT(moved, 1e-4);
}
TEST(Sleep, a_load_taken_off_a_seesaw_lets_its_other_end_fall) {
    World world = make_world();
    add_ground(world);
    add(world, {.kind = BodyKind::Static, .position = {0, 1, 0}}, Box{{0.1f, 1, 1}});
    const BodyId plank = add(world, {.position = {0, 2.1, 0}}, Box{{4, 0.1f, 0.5f}});
    const BodyId left = add(world, {.position = {-3, 2.7, 0}}, Box{});
    const BodyId on_left = add(world, {.position = {-3, 3.7, 0}}, Box{});
    const BodyId right = add(world, {.position = {3, 2.7, 0}}, Box{});
    const BodyId on_right = add(world, {.position = {3, 3.7, 0}}, Box{});
    run(world, 3);
    for (const BodyId body : {plank, left, on_left, right, on_right}) ASSERT_FALSE(state(world, body).awake);
    opened(world.set_velocity(on_right, {4, 3, 0}, {}));  // it hops off
    run(world, 3);
    EXPECT_LT(state(world, left).pose.position.y, 2);
    EXPECT_LT(state(world, on_left).pose.position.y, 3);
}
TEST(Sleep, a_blow_passes_through_a_row_of_sleeping_balls) {
    Settings settings;
    settings.gravity = {};
    World world = make_world(settings);
    const ColliderDef elastic{.material = {.friction = 0, .restitution = 1}};
    std::vector<BodyId> row;
    for (int i = 0; i < 12; ++i) row.push_back(add(world, {.position = {0.5 * i, 0, 0}}, Sphere{0.25f}, elastic));
    run(world, 2);
    for (const BodyId ball : row) ASSERT_FALSE(state(world, ball).awake);
    add(world, {.position = {-2, 0, 0}, .linear_velocity = {3, 0, 0}}, Sphere{0.25f}, elastic);
    run(world, 1);
    EXPECT_NEAR(state(world, row.back()).linear_velocity.x, 3, 0.3);
}
TEST(Sleep, a_tower_comes_down_when_its_lowest_stone_is_shot_away) {
    World world = make_world();
    add_ground(world, {.friction = 0});
    std::vector<BodyId> tower;
    for (int i = 0; i < 12; ++i)
        tower.push_back(add(world, {.position = {0, 0.5 + i, 0}}, Box{}, {.material = {.friction = 0.1f}}));
    run(world, 3);
    for (const BodyId stone : tower) ASSERT_FALSE(state(world, stone).awake);
    opened(world.set_velocity(tower[0], {30, 0, 0}, {}));
    run(world, 2);
    EXPECT_LT(state(world, tower.back()).pose.position.y, 11);
}

}  // namespace
}  // namespace fase
