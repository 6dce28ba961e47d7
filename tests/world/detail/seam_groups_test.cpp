// Bodies on a ground of several bodies: they move as on one, with the same bits for any number of threads.
#include "fase/world/detail/seam_groups.hpp"

#include "fase/world/detail/state_access.hpp"
#include "tests/world/worlds.hpp"

namespace fase::test {
namespace {

/// Adds tiles of 1 m, `side` in each direction about the origin, whose tops are y = 0.
void add_tiles(World& world, int side, BodyKind kind = BodyKind::Static, float friction = 0.5f) {
    for (int x = -side; x < side; ++x)
        for (int z = -side; z < side; ++z)
            add(world, {.kind = kind, .position = {x + 0.5, -0.25, z + 0.5}}, Box{{0.5f, 0.25f, 0.5f}},
                {.material = {.friction = friction, .restitution = 0}});
}

/// The largest change of velocity of a body that slides over tiles without friction for half a second.
float change_over_tiles(const Shape& shape, double height, Vec3 velocity, BodyKind tiles = BodyKind::Static) {
    World world = make_world();
    add_tiles(world, 8, tiles, 0);
    BodyDef def;
    def.position = {-3.3, height, -2.7};
    def.linear_velocity = velocity;
    const BodyId body = add(world, def, shape, {.material = {.friction = 0}});
    float change = 0;
    for (int i = 0; i < 15; ++i) {
        EXPECT_TRUE(world.step());
        change = std::max(change, length(state(world, body).linear_velocity - velocity));
    }
    return change;
}

TEST(SeamGroups, tiles_do_not_kick_what_slides_over_them) {
    for (const Vec3 velocity : {Vec3{0.3f, 0, 0.2f}, Vec3{4, 0, 3}, Vec3{30, 0, 21}}) {
        EXPECT_LT(change_over_tiles(Box{{0.25f, 0.15f, 0.35f}}, 0.15, velocity), 1e-3f) << velocity.x;
        EXPECT_LT(change_over_tiles(Sphere{0.25f}, 0.25, velocity), 1e-3f) << velocity.x;
        EXPECT_LT(change_over_tiles(Capsule{0.2f, 0.3f}, 0.5, velocity), 1e-3f) << velocity.x;
        EXPECT_LT(change_over_tiles(Cylinder{0.3f, 0.1f}, 0.1, velocity), 1e-3f) << velocity.x;
    }
}

TEST(SeamGroups, kinematic_tiles_at_rest_are_ground_as_well) {
    EXPECT_LT(change_over_tiles(Box{{0.25f, 0.15f, 0.35f}}, 0.15, {12, 0, 9}, BodyKind::Kinematic), 1e-3f);
}

TEST(SeamGroups, a_wall_that_moves_hits_what_would_pass_it) {
    Settings settings;
    settings.gravity = {};
    World world = make_world(settings);
    add(world, {.kind = BodyKind::Kinematic, .position = {3, 0, 3}, .linear_velocity = {0, 0, -30}},
        Box{{4, 1, 0.05f}});
    const BodyId ball = add(world, {.position = {0, 0, 0.3}, .linear_velocity = {30, 0, 0}}, Sphere{0.25f});
    run(world, 0.2);
    EXPECT_LT(state(world, ball).linear_velocity.z, -29);
}

TEST(SeamGroups, a_body_touches_each_tile_below_it) {
    World world = make_world();
    add_tiles(world, 2);
    add(world, {.position = {0, 0.2, 0}}, Box{{0.4f, 0.2f, 0.4f}});
    std::size_t begun = 0, ended = 0;
    for (int i = 0; i < 60; ++i) {
        ASSERT_TRUE(world.step());
        begun += world.events().contacts_begun.size();
        ended += world.events().contacts_ended.size();
    }
    EXPECT_EQ(begun, 4u);
    EXPECT_EQ(ended, 0u);
}

TEST(SeamGroups, bodies_on_tiles_fall_asleep_and_wake_when_a_tile_goes) {
    World world = make_world();
    add_tiles(world, 4);
    const BodyId tile = add(world, {.kind = BodyKind::Static, .position = {8.5, -0.25, 0}}, Box{{0.5f, 0.25f, 0.5f}});
    const BodyId alone = add(world, {.position = {8.5, 0.2, 0}}, Box{{0.2f, 0.2f, 0.2f}});
    std::vector<BodyId> bodies;
    for (int i = 0; i < 6; ++i) {
        const double x = i * 0.9 - 2.5;
        bodies.push_back(add(world, {.position = {x, 0.2, 0.1}}, Box{{0.3f, 0.2f, 0.3f}}));
        bodies.push_back(add(world, {.position = {x, 0.6, 0.1}}, Box{{0.3f, 0.2f, 0.3f}}));
    }
    run(world, 3);
    for (const BodyId body : bodies) EXPECT_FALSE(state(world, body).awake);
    EXPECT_FALSE(state(world, alone).awake);
    opened(world.remove_body(tile));
    run(world, 0.5);
    EXPECT_LT(state(world, alone).centre.y, -0.5);
}

/// Moves shapes of all kinds over tiles and against blocks that stand on them.
void add_traffic(World& world) {
    add_tiles(world, 6);
    for (int i = 0; i < 8; ++i)
        add(world, {.kind = BodyKind::Static, .position = {i % 4 * 3 - 4.5, 0.5, i / 4 * 5 - 2.5}},
            Box{{0.5f, 0.5f, 0.5f}});
    Random random(3);
    for (int i = 0; i < 80; ++i) {
        BodyDef def;
        def.position = {i % 9 * 1.2 - 5, 0.8 + i / 9 * 0.3, i / 9 % 8 * 1.3 - 5};
        def.rotation = random_rotation(random);
        const float speed = i % 7 == 0 ? 40.0f : 5.0f;
        def.linear_velocity = {random.between(-speed, speed), -2, random.between(-speed, speed)};
        const Shape shapes[]{Box{{0.2f, 0.15f, 0.25f}}, Sphere{0.2f}, Capsule{0.15f, 0.2f}, Cylinder{0.2f, 0.15f}};
        add(world, def, shapes[i % 4], {.material = {.friction = 0.4f, .restitution = 0.2f}});
    }
}

std::uint64_t traffic_hash(const Setup& setup) {
    World world = make_world({}, setup);
    add_traffic(world);
    run(world, 2);
    return world.hash();
}

TEST(SeamGroups, traffic_on_tiles_hashes_the_same_for_any_threads_and_structure) {
    const std::uint64_t one = traffic_hash({.threads = 1});
    EXPECT_EQ(traffic_hash({.threads = 2}), one);
    EXPECT_EQ(traffic_hash({.threads = 4}), one);
    EXPECT_EQ(traffic_hash({.structure = "brute_force"}), one);
}

TEST(SeamGroups, traffic_on_tiles_has_its_golden_hash) {
    // A new value means that the simulation changed, on every machine; the changelog must say why.
    EXPECT_EQ(traffic_hash({}), 0x5261265a1385d48dull);
}

TEST(SeamGroups, a_restored_snapshot_continues_with_the_same_bits) {
    World world = make_world();
    add_traffic(world);
    run(world, 0.5);
    World other = make_world({}, {.threads = 2});
    ASSERT_TRUE(other.restore(world.snapshot()));
    for (int i = 0; i < 60; ++i) {
        ASSERT_TRUE(world.step());
        ASSERT_TRUE(other.step());
        ASSERT_EQ(other.hash(), world.hash()) << i;
    }
}

TEST(SeamGroups, nothing_of_the_traffic_falls_through_the_tiles) {
    World world = make_world();
    add_traffic(world);
    std::vector<BodyState> bodies;
    for (int i = 0; i < 120; ++i) {
        ASSERT_TRUE(world.step());
        bodies.clear();
        world.read_bodies(bodies);
        for (const BodyState& body : bodies) {
            if (body.kind != BodyKind::Dynamic) continue;
            const Vec3d at = body.centre;
            EXPECT_TRUE(at.y > 0 || std::max(std::abs(at.x), std::abs(at.z)) > 5.5) << "step " << i;
        }
    }
}

TEST(SeamGroups, only_movers_with_several_pieces_or_speed_make_a_group) {
    World world = make_world();
    add_tiles(world, 2);
    const BodyId one = add(world, {.position = {0.5, 0.2, 0.5}}, Box{{0.2f, 0.2f, 0.2f}});
    const BodyId four = add(world, {.position = {-1, 0.2, -1}}, Box{{0.2f, 0.2f, 0.2f}});
    ASSERT_TRUE(world.step());
    const SeamGroups& groups = WorldStateAccess::of(world).constraints.seams;
    ASSERT_EQ(groups.all.size(), 1u);
    EXPECT_EQ(groups.all[0].count, 4u);
    EXPECT_EQ(groups.all[0].mover, world.colliders_of(four)[0].index);
    opened(world.set_velocity(one, {5, 0, 0}, {}));
    ASSERT_TRUE(world.step());
    EXPECT_EQ(groups.all.size(), 2u);
}

}  // namespace
}  // namespace fase::test
