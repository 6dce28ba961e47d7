/// Tests of filling worlds from scenes.
#include "fase/scene/scene.hpp"

#include <gtest/gtest.h>

#include "fase/scene/generate.hpp"
#include "tests/scene/support.hpp"

namespace fase::scene {
namespace {

TEST(Instantiate, AddsEveryBodyInOrder) {
    const Scene scene = *generate("pile", {.count = 20});
    World world = *World::create(settings_for(scene));
    const auto ids = instantiate(scene, world);
    ASSERT_TRUE(ids) << ids.error().text();
    ASSERT_EQ(ids->size(), scene.bodies.size());
    EXPECT_EQ(world.body_count(), scene.bodies.size());
    for (std::size_t i = 0; i < ids->size(); ++i) {
        const BodyState state = *world.body((*ids)[i]);
        EXPECT_EQ(state.kind, scene.bodies[i].def.kind);
        test::expect_near(state.pose.position, scene.bodies[i].def.position, 1e-6);
        EXPECT_EQ(world.colliders_of((*ids)[i]).size(), scene.bodies[i].colliders.size());
    }
}

TEST(Instantiate, ARefusalLeavesTheWorldUnchanged) {
    Scene scene = *generate("pile", {.count = 20});
    World world = *World::create();
    ASSERT_TRUE(world.add_body({}, Sphere{1}));
    const std::uint64_t before = world.hash();
    scene.bodies[7].def.linear_velocity.x = std::numeric_limits<float>::quiet_NaN();
    const auto ids = instantiate(scene, world);
    ASSERT_FALSE(ids);
    EXPECT_NE(ids.error().where.find("bodies[7]"), std::string::npos) << ids.error().text();
    EXPECT_EQ(world.hash(), before);
    EXPECT_EQ(world.body_count(), 1u);
    scene.bodies[7].def.linear_velocity.x = 0;
    scene.bodies[9].colliders[0].shape = 1000;
    EXPECT_EQ(instantiate(scene, world).status(), Status::OutOfRange);
    EXPECT_EQ(world.hash(), before);
}

TEST(Instantiate, KeepsSleepingBodiesAsleep) {
    const Scene scene = *generate("sleepers", {.count = 50});
    World world = *World::create(settings_for(scene));
    const auto ids = instantiate(scene, world);
    ASSERT_TRUE(ids) << ids.error().text();
    std::size_t asleep = 0;
    for (const BodyId id : *ids) {
        const BodyState state = *world.body(id);
        if (state.kind == BodyKind::Dynamic && !state.awake) ++asleep;
    }
    EXPECT_EQ(asleep, 50u);
}

TEST(Instantiate, ExcludesPairsConnectedByAJoint) {
    const Result<Scene> scene = read_gltf(test::fixture("joints.gltf"));
    ASSERT_TRUE(scene);
    World world = *World::create();
    EXPECT_TRUE(instantiate(*scene, world));
}

TEST(SettingsOfAScene, TakeItsGravityAndHints) {
    Scene scene;
    scene.gravity = {0, -1.6f, 0};
    scene.settings.sub_steps = 9;
    const Settings settings = settings_for(scene);
    EXPECT_EQ(settings.gravity, scene.gravity);
    EXPECT_EQ(settings.sub_steps, 9);
    EXPECT_EQ(settings.time_step, Settings{}.time_step);
}

}  // namespace
}  // namespace fase::scene
