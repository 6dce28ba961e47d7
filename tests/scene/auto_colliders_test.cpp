/// Tests automatic colliders: which bodies they make, their shapes, flat and broken meshes.
#include "fase/scene/auto_colliders.hpp"

#include <cmath>

#include "fase/geometry/bounds.hpp"
#include "tests/scene/support.hpp"

namespace fase::scene::test {
namespace {

/// A flat ground, and three cubes of 1 m in a column; the lowest cube has a smaller one as a child node.
Scene yard() {
    const Result<Scene> scene = read_gltf(fixture("yard.gltf"));
    EXPECT_TRUE(scene) << (scene ? "" : scene.error().text());
    return scene ? *scene : Scene{};
}

bool is_ground(std::string_view name) { return name == "Ground"; }

Aabb box_of(const Scene& scene, const Body& body, std::size_t i) {
    const Collider& collider = body.colliders.at(i);
    return bounds(scene.shapes[collider.shape], Pose{body.def.position, body.def.rotation} * collider.def.pose);
}

void expect_bounds(const Aabb& found, Vec3 lo, Vec3 hi) {
    EXPECT_LT(length(found.lo - lo), 1e-4f) << found.lo.x << " " << found.lo.y << " " << found.lo.z;
    EXPECT_LT(length(found.hi - hi), 1e-4f) << found.hi.x << " " << found.hi.y << " " << found.hi.z;
}

TEST(AutoColliders, TheFixtureListsItsMeshNodesParentsFirst) {
    const Scene scene = yard();
    ASSERT_EQ(scene.scenery_nodes.size(), 5u);
    EXPECT_EQ(scene.scenery_nodes[0].name, "Ground");
    EXPECT_EQ(scene.scenery_nodes[2].name, "Hat");
    EXPECT_EQ(scene.scenery_nodes[2].parent, 1u);
    EXPECT_EQ(scene.scenery.size(), 5u);
}

TEST(AutoColliders, MeshNodesBecomeBodiesAndTheNodesBelowThemParts) {
    for (const AutoShape shape : {AutoShape::Hull, AutoShape::Box}) {
        Scene scene = yard();
        const AutoColliders made = add_colliders(scene, {shape, is_ground});
        EXPECT_EQ(made.colliders, 5u);
        EXPECT_EQ(made.dynamic_bodies, 3u);
        EXPECT_EQ(made.static_bodies, 1u);
        EXPECT_EQ(made.flat, 1u);
        EXPECT_EQ(made.skipped, 0u);
        EXPECT_TRUE(scene.scenery.empty());
        EXPECT_TRUE(scene.scenery_nodes.empty());
        ASSERT_EQ(scene.bodies.size(), 4u);
        EXPECT_EQ(body_named(scene, "Ground").def.kind, BodyKind::Static);
        const Body& cube = body_named(scene, "Cube.000");
        EXPECT_EQ(cube.def.kind, BodyKind::Dynamic);
        ASSERT_EQ(cube.colliders.size(), 2u);
        EXPECT_EQ(cube.visuals.size(), 2u);
        expect_bounds(box_of(scene, cube, 0), {-0.5f, 0.5f, -0.5f}, {0.5f, 1.5f, 0.5f});
        expect_bounds(box_of(scene, cube, 1), {-0.25f, 1.5f, -0.25f}, {0.25f, 2, 0.25f});
        EXPECT_EQ(cube.colliders[0].shape, body_named(scene, "Cube.002").colliders[0].shape) << "equal meshes share";
    }
}

TEST(AutoColliders, AFlatGroundBecomesThickBelowItsFaces) {
    for (const AutoShape shape : {AutoShape::Hull, AutoShape::Box}) {
        Scene scene = yard();
        add_colliders(scene, {shape, is_ground});
        expect_bounds(box_of(scene, body_named(scene, "Ground"), 0), {-10, -0.1f, -10}, {10, 0, 10});
    }
}

TEST(AutoColliders, AScaledTurnedMirroredNodeGetsABoxAlongItsAxes) {
    Scene scene = yard();
    const Visual cube = scene.scenery[1];
    const float s = std::sqrt(0.5f);
    const Mat3 turn{{s, 0, -s}, {0, 1, 0}, {s, 0, s}};
    scene.scenery = {cube};
    scene.scenery_nodes.clear();
    scene.scenery[0].position = {3, 0, 0};
    scene.scenery[0].linear = turn * Mat3::diagonal({-4, 1, 2});
    add_colliders(scene, {AutoShape::Box, {}});
    ASSERT_EQ(scene.bodies.size(), 1u);
    EXPECT_TRUE(std::holds_alternative<Box>(scene.shapes[scene.bodies[0].colliders[0].shape]));
    const float reach = s * (2 + 1);
    expect_bounds(box_of(scene, scene.bodies[0], 0), {3 - reach, -0.5f, -reach}, {3 + reach, 0.5f, reach});
}

TEST(AutoColliders, ABodyWithoutCollidersKeepsItsKindAndItsWeight) {
    Scene scene = yard();
    Body body;
    body.def.kind = BodyKind::Kinematic;
    body.visuals = {scene.scenery[1]};
    scene.bodies.push_back(body);
    body.def.kind = BodyKind::Dynamic;
    body.def.mass = MassProperties{6, {}, Mat3::diagonal({9, 9, 9})};
    body.visuals[0].position = {};
    scene.bodies.push_back(body);
    add_colliders(scene, {AutoShape::Box, is_ground});
    EXPECT_EQ(scene.bodies[0].def.kind, BodyKind::Kinematic);
    EXPECT_EQ(scene.bodies[0].colliders.size(), 1u);
    EXPECT_FLOAT_EQ(scene.bodies[1].def.mass->mass, 6);
    EXPECT_NEAR(scene.bodies[1].def.mass->inertia.x.x, 1, 1e-5) << "of a cube of 6 kg and 1 m";
}

TEST(AutoColliders, MeshesWithoutVolumeAreSkippedAndStayScenery) {
    Scene scene;
    scene.meshes = {{"line", {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {0, 1, 2}},
                    {"none", {}, {}},
                    {"far", {{2e6f, 0, 0}, {2e6f, 1, 0}, {2e6f, 0, 1}}, {0, 1, 2}}};
    for (std::uint32_t i = 0; i < 3; ++i) scene.scenery.push_back({i, {}, Mat3::identity(), {}});
    scene.meshes.push_back({"away", {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}}, {0, 2, 1}});
    scene.scenery.push_back({3, {2e7f, 0, 0}, Mat3::identity(), {}});
    for (const AutoShape shape : {AutoShape::Hull, AutoShape::Box}) {
        const AutoColliders made = add_colliders(scene, {shape, {}});
        EXPECT_EQ(made.colliders, 0u);
        EXPECT_EQ(made.skipped, 4u);
        EXPECT_TRUE(scene.bodies.empty());
        EXPECT_EQ(scene.scenery.size(), 4u);
        EXPECT_EQ(scene.scenery_nodes.size(), 4u);
    }
}

TEST(AutoColliders, TheWorldOfTheYardComesToRest) {
    for (const AutoShape shape : {AutoShape::Hull, AutoShape::Box}) {
        Scene scene = yard();
        add_colliders(scene, {shape, is_ground});
        Result<World> world = World::create(settings_for(scene));
        ASSERT_TRUE(world);
        const auto ids = instantiate(scene, *world);
        ASSERT_TRUE(ids) << ids.error().text();
        for (int i = 0; i < 600; ++i) ASSERT_TRUE(world->step());
        EXPECT_EQ(world->last_report().awake, 0u);
        for (const BodyId id : *ids) EXPECT_GT(world->body(id)->pose.position.y, -0.1);
    }
}

}  // namespace
}  // namespace fase::scene::test
