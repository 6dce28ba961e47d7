// Editing bodies between steps.
#include "fase/world/detail/state_access.hpp"
#include "tests/world/worlds.hpp"

namespace fase {
namespace {

using namespace test;

TEST(Edit, a_collider_off_the_centre_moves_the_centre_of_mass_and_not_the_frame) {
    World world = make_world();
    const auto body = world.add_body({.position = {1, 2, 3}});
    ASSERT_TRUE(body);
    ASSERT_TRUE(world.add_collider(*body, Box{}, {.pose = {{1, 0, 0}, {}}}));
    EXPECT_EQ(state(world, *body).pose.position, (Vec3d{1, 2, 3}));
    EXPECT_NEAR(state(world, *body).centre.x, 2, 1e-6);
    EXPECT_NEAR(state(world, *body).mass, 1000, 1e-3);
    ASSERT_TRUE(world.add_collider(*body, Box{}, {.pose = {{-1, 0, 0}, {}}}));
    EXPECT_NEAR(state(world, *body).centre.x, 1, 1e-6);
    EXPECT_NEAR(state(world, *body).mass, 2000, 1e-3);
}

TEST(Edit, a_compound_rests_on_all_its_parts) {
    World world = make_world();
    add_ground(world);
    const auto table = world.add_body({.position = {0, 1, 0}});
    ASSERT_TRUE(table);
    ASSERT_TRUE(world.add_collider(*table, Box{{1, 0.1f, 1}}));
    for (const float x : {-0.8f, 0.8f})
        for (const float z : {-0.8f, 0.8f})
            ASSERT_TRUE(world.add_collider(*table, Cylinder{0.1f, 0.5f}, {.pose = {{x, -0.5f, z}, {}}}));
    run(world, 3);
    const BodyState s = state(world, *table);
    EXPECT_FALSE(s.awake);
    EXPECT_NEAR(s.pose.position.y, 1, 0.01);
    EXPECT_NEAR(std::abs(s.pose.rotation.w), 1, 1e-4);
}

TEST(Edit, filters_groups_and_exclusions_let_bodies_through) {
    World world = make_world();
    add_ground(world);
    add(world, {.kind = BodyKind::Static, .position = {0, 2, 0}}, Box{{3, 0.1f, 3}},
        {.filter = {.category = 2, .mask = ~4ull}});
    const BodyId other = world.bodies().back();
    const BodyId held = add(world, {.position = {-2, 3, 0}}, Sphere{0.2f});
    const BodyId filtered = add(world, {.position = {-1, 3, 0}}, Sphere{0.2f}, {.filter = {.category = 4}});
    const BodyId excluded = add(world, {.position = {1, 3, 0}}, Sphere{0.2f});
    ASSERT_TRUE(world.exclude_pair(other, excluded));
    run(world, 2);
    EXPECT_NEAR(state(world, held).pose.position.y, 2.3, 0.02);
    EXPECT_NEAR(state(world, filtered).pose.position.y, 0.2, 0.02);
    EXPECT_NEAR(state(world, excluded).pose.position.y, 0.2, 0.02);
}

TEST(Edit, bodies_of_one_negative_group_pass_each_other) {
    World world = make_world();
    add_ground(world);
    const BodyId a = add(world, {.position = {0, 0.2, 0}}, Sphere{0.2f}, {.filter = {.group = -3}});
    const BodyId b = add(world, {.position = {0, 2, 0}}, Sphere{0.2f}, {.filter = {.group = -3}});
    run(world, 2);
    EXPECT_NEAR(state(world, a).pose.position.y, 0.2, 0.02);
    EXPECT_NEAR(state(world, b).pose.position.y, 0.2, 0.02);
}

TEST(Edit, a_changed_filter_lets_a_resting_body_fall) {
    World world = make_world();
    const BodyId floor = add(world, {.kind = BodyKind::Static}, Box{{3, 0.5f, 3}});
    const BodyId box = add(world, {.position = {0, 1, 0}}, Box{});
    run(world, 2);
    EXPECT_FALSE(state(world, box).awake);
    ASSERT_TRUE(world.set_filter(world.colliders_of(floor)[0], {.category = 1, .mask = 0}));
    run(world, 1);
    EXPECT_LT(state(world, box).pose.position.y, -1);
}

TEST(Edit, axis_locks_hold) {
    World world = make_world();
    add_ground(world);
    const BodyId box = add(world,
                           {.position = {0, 2, 0},
                            .linear_velocity = {1, 0, 1},
                            .angular_velocity = {1, 1, 1},
                            .locks = {.linear_z = true, .angular_x = true, .angular_y = true, .angular_z = true}},
                           Box{});
    run(world, 0.5);
    const BodyState s = state(world, box);
    EXPECT_NEAR(s.pose.position.x, 0.5, 1e-3);
    EXPECT_EQ(s.pose.position.z, 0);
    EXPECT_EQ(s.pose.rotation, Quat{});
    run(world, 2);
    EXPECT_EQ(state(world, box).pose.position.z, 0);
}

TEST(Edit, a_kinematic_body_reaches_its_target_and_carries_others) {
    World world = make_world();
    const BodyId lift = add(world, {.kind = BodyKind::Kinematic}, Box{{2, 0.5f, 2}});
    const BodyId box = add(world, {.position = {0, 1, 0}}, Box{});
    for (int i = 1; i <= 60; ++i) {
        const float angle = 0.01f * static_cast<float>(i);
        ASSERT_TRUE(world.move_kinematic(lift, {{0, 0.02 * i, 0}, rotation_about(Vec3{0, 1, 0}, angle)}, 1.0f / 60));
        ASSERT_TRUE(world.step());
    }
    EXPECT_NEAR(state(world, lift).pose.position.y, 1.2, 1e-4);
    EXPECT_NEAR(state(world, lift).pose.rotation.y, std::sin(0.3), 1e-4);
    EXPECT_NEAR(state(world, box).pose.position.y, 2.2, 0.02);
    EXPECT_NEAR(state(world, box).pose.rotation.y, std::sin(0.3), 0.01);
}

TEST(Edit, a_body_changes_its_kind) {
    World world = make_world();
    add_ground(world);
    const BodyId box = add(world, {.kind = BodyKind::Static, .position = {0, 3, 0}}, Box{});
    run(world, 0.5);
    EXPECT_EQ(state(world, box).pose.position.y, 3);
    ASSERT_TRUE(world.set_kind(box, BodyKind::Dynamic));
    run(world, 2);
    EXPECT_NEAR(state(world, box).pose.position.y, 0.5, 0.02);
    ASSERT_TRUE(world.set_kind(box, BodyKind::Static));
    const BodyId ball = add(world, {.position = {0, 3, 0}}, Sphere{});
    run(world, 2);
    EXPECT_NEAR(state(world, ball).pose.position.y, 1.5, 0.02);
    ASSERT_TRUE(world.set_kind(box, BodyKind::Kinematic));
    ASSERT_TRUE(world.set_velocity(box, {0, 1, 0}, {}));
    run(world, 1);
    EXPECT_NEAR(state(world, ball).pose.position.y, 2.5, 0.05);
}

TEST(Edit, forces_and_impulses_follow_newtons_laws) {
    Settings settings;
    settings.gravity = {};
    World world = make_world(settings);
    const BodyId a = add(world, {}, Box{});  // 1000 kg, moments 1000 / 6
    for (int i = 0; i < 60; ++i) {
        ASSERT_TRUE(world.apply_force(a, {1000, 0, 0}));
        ASSERT_TRUE(world.step());
    }
    EXPECT_NEAR(state(world, a).linear_velocity.x, 1, 1e-4);
    EXPECT_NEAR(state(world, a).pose.position.x, 0.5, 1e-3);
    const BodyId b = add(world, {.position = {10, 0, 0}}, Box{});
    ASSERT_TRUE(world.apply_impulse_at(b, {0, 100, 0}, {10.5, 0, 0}));
    EXPECT_NEAR(state(world, b).linear_velocity.y, 0.1, 1e-6);
    EXPECT_NEAR(state(world, b).angular_velocity.z, 50 / (1000.0 / 6), 1e-5);
    const BodyId c = add(world, {.position = {20, 0, 0}}, Box{});
    ASSERT_TRUE(world.apply_force_at(c, {0, 600, 0}, {20.5, 0, 0}));
    ASSERT_TRUE(world.step());
    EXPECT_NEAR(state(world, c).linear_velocity.y, 0.01, 1e-6);
    EXPECT_NEAR(state(world, c).angular_velocity.z, 300.0 / 60 / (1000.0 / 6), 1e-5);
    const BodyId d = add(world, {.position = {30, 0, 0}, .linear_velocity = {1, 0, 0}, .linear_damping = 1}, Sphere{});
    run(world, 1);
    EXPECT_NEAR(state(world, d).linear_velocity.x, std::exp(-1.0), 0.002);
}

TEST(Edit, material_modes_combine_as_named) {
    EXPECT_FLOAT_EQ(combined(0.2f, CombineMode::Average, 0.6f, CombineMode::Average), 0.4f);
    EXPECT_FLOAT_EQ(combined(0.1f, CombineMode::GeometricMean, 0.9f, CombineMode::GeometricMean), 0.3f);
    EXPECT_FLOAT_EQ(combined(0.2f, CombineMode::Minimum, 0.6f, CombineMode::Average), 0.4f);
    EXPECT_FLOAT_EQ(combined(0.2f, CombineMode::Minimum, 0.6f, CombineMode::Multiply), 0.2f);
    EXPECT_FLOAT_EQ(combined(0.2f, CombineMode::Maximum, 0.6f, CombineMode::Multiply), 0.6f);
    EXPECT_FLOAT_EQ(combined(0.2f, CombineMode::GeometricMean, 0.6f, CombineMode::Multiply), 0.12f);
}

TEST(Edit, adding_and_removing_a_thousand_bodies_leaks_nothing) {
    World world = make_world();
    add_ground(world);
    const std::size_t shapes = WorldStateAccess::of(world).colliders.shapes.size();
    Random random(9);
    std::vector<BodyId> bodies;
    for (int step = 0; step < 100; ++step) {
        for (int i = 0; i < 10; ++i)
            bodies.push_back(add(world,
                                 {.position = {random.between(-4, 4), random.between(1, 4), random.between(-4, 4)}},
                                 Box{{0.3f, 0.2f, random.between(0.1f, 0.4f)}}));
        ASSERT_TRUE(world.step());
        while (bodies.size() > 60) {
            const auto at = random.below(bodies.size());
            ASSERT_TRUE(world.remove_body(bodies[at]));
            bodies.erase(bodies.begin() + static_cast<long>(at));
        }
        ASSERT_TRUE(world.step());
        broad::AnyStructure awake = WorldStateAccess::of(world).broad_phase.sets.of(
            MotionState::Awake);  // erases of bodies that fell asleep may still be pending
        awake.commit();
        ASSERT_EQ(awake.broken_invariant(), "");
    }
    for (const BodyId body : bodies) ASSERT_TRUE(world.remove_body(body));
    ASSERT_TRUE(world.step());
    EXPECT_EQ(world.body_count(), 1u);
    EXPECT_EQ(WorldStateAccess::of(world).contacts.active.size() + WorldStateAccess::of(world).contacts.resting.size(),
              0u);
    EXPECT_EQ(WorldStateAccess::of(world).contacts.all.size(), WorldStateAccess::of(world).contacts.free.size());
    EXPECT_EQ(
        WorldStateAccess::of(world).colliders.shapes.size() - WorldStateAccess::of(world).colliders.free_shapes.size(),
        shapes);
}

TEST(Edit, equal_shapes_are_stored_once) {
    World world = make_world();
    for (int i = 0; i < 10; ++i) add(world, {.position = {3.0 * i, 0, 0}}, Box{});
    EXPECT_EQ(WorldStateAccess::of(world).colliders.shapes.size(), 1u);
}

TEST(Edit, forces_are_forgotten_when_a_body_changes_its_kind) {
    Settings settings;
    settings.gravity = {};
    for (const BodyKind kind : {BodyKind::Static, BodyKind::Kinematic}) {
        World world = make_world(settings);
        const BodyId ball = add(world, {}, Sphere{});
        opened(world.apply_force(ball, {1e5f, 0, 0}));
        opened(world.apply_torque(ball, {1e5f, 0, 0}));
        opened(world.set_kind(ball, kind));
        run(world, 0.5);
        opened(world.set_kind(ball, BodyKind::Dynamic));
        ASSERT_TRUE(world.step());
        EXPECT_EQ(state(world, ball).linear_velocity, Vec3{});
        EXPECT_EQ(state(world, ball).angular_velocity, Vec3{});
    }
}

TEST(Edit, a_compound_made_at_once_is_the_one_made_part_by_part) {
    std::vector<ColliderShape> parts;
    for (int i = 0; i < 30; ++i)
        parts.push_back(
            {Box{{0.2f, 0.1f + 0.01f * i, 0.3f}},
             {.pose = {{0.3f * i, 0.1f * (i % 3), 0}, {}}, .sensor = i % 7 == 3, .user = std::uint64_t(i)}});
    const BodyDef def{.position = {0, 2, 0}, .linear_velocity = {1, 0, 0}};
    World at_once = make_world(), by_part = make_world();
    add_ground(at_once);
    add_ground(by_part);
    const auto whole = at_once.add_body(def, parts);
    ASSERT_TRUE(whole);
    const BodyId built = add(by_part, def, parts[0].shape, parts[0].def);
    for (std::size_t i = 1; i < parts.size(); ++i)
        ASSERT_TRUE(by_part.add_collider(built, parts[i].shape, parts[i].def));
    opened(by_part.set_velocity(built, {1, 0, 0}, {}));
    ASSERT_EQ(at_once.colliders_of(*whole).size(), parts.size());
    for (std::size_t i = 0; i < parts.size(); ++i)
        EXPECT_EQ(at_once.collider(at_once.colliders_of(*whole)[i])->def.user, i);
    EXPECT_EQ(state(at_once, *whole).mass, state(by_part, built).mass);
    run(at_once, 1);
    run(by_part, 1);
    EXPECT_LT(length(state(at_once, *whole).pose.position - state(by_part, built).pose.position), 1e-3);
}

TEST(Edit, a_compound_with_one_bad_part_adds_nothing) {
    World world = make_world();
    add_ground(world);
    const std::uint64_t before = world.hash();
    const std::vector<ColliderShape> parts{{Box{}}, {Sphere{-1}}};
    EXPECT_FALSE(world.add_body({}, parts));
    EXPECT_EQ(world.hash(), before);
    EXPECT_EQ(world.body_count(), 1u);
}

}  // namespace
}  // namespace fase
