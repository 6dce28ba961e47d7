/// Tests of written scenes: they read back as the same scene, and tinygltf accepts them.
#include "fase/scene/gltf_write.hpp"

#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <algorithm>
#include <limits>

#include "fase/geometry/hull_builder.hpp"
#include "fase/scene/generate.hpp"
#include "tests/scene/support.hpp"

namespace fase::scene {
namespace {

/// A scene that uses every stored field.
Scene scene_with_all_fields() {
    Scene scene;
    scene.name = "all \"fields\"";
    scene.gravity = {0.5f, -3.7f, 0};
    scene.camera = Camera{{1, 2, 3}, {0, 0.5f, 0}, 0.7f};
    scene.settings = {1.0f / 120, 8, false};
    const std::vector<Vec3> corners{{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}};
    scene.shapes = {Sphere{0.3f},         Box{{0.1f, 0.2f, 0.3f}},     Capsule{0.1f, 0.7f},
                    Cylinder{0.3f, 0.1f}, *build_convex_hull(corners), HalfSpace{}};
    scene.meshes = {{"triangle", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 1, 2}},
                    {"square", {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 1, 2, 0, 2, 3}}};
    const Quat turn = normalized(Quat{0.1f, 0.2f, 0.3f, 0.9f});

    Body ground;
    ground.name = "ground";
    ground.def.kind = BodyKind::Static;
    ground.colliders.push_back({5, {}, ""});
    Body compound;
    compound.name = "compound";
    compound.def.position = {1.0 / 3, 1e6 + 0.1, -7};
    compound.def.rotation = turn;
    compound.def.linear_velocity = {1, 2, 3};
    compound.def.angular_velocity = {-0.1f, 0.7f, 0.3f};
    compound.def.linear_damping = 0.1f;
    compound.def.angular_damping = 0.2f;
    compound.def.gravity_scale = 0.5f;
    compound.def.locks = {true, false, false, false, true, false};
    compound.def.can_sleep = false;
    compound.def.user = std::numeric_limits<std::uint64_t>::max();
    for (std::uint32_t i = 0; i < 5; ++i) {
        Collider collider{i, {}, "part " + std::to_string(i)};
        collider.def.pose = {{0.1f * static_cast<float>(i), 0, 1}, i % 2 == 0 ? Quat{} : turn};
        collider.def.material = {0.1f * static_cast<float>(i), 0.25f, static_cast<CombineMode>(i),
                                 static_cast<CombineMode>(4 - i)};
        collider.def.density = 100 * static_cast<float>(i + 1);
        collider.def.filter = {1ull << (7 * i + 1),
                               i == 0   ? ~0ull
                               : i == 1 ? 5
                                        : ~(1ull << 60),
                               static_cast<std::int32_t>(i) - 2};
        collider.def.sensor = i == 4;
        collider.def.user = i;
        compound.colliders.push_back(collider);
    }
    compound.visuals = {{0, {}, Mat3::identity(), {1, 0, 0, 1}},
                        {1, {1, 2, 3}, Mat3{{0, 2, 0}, {1, 0, 0}, {0, 0.5f, -3}}, {0, 1, 0, 0.5f}}};
    Body massive;
    massive.name = "massive";
    massive.def.mass = MassProperties{2, {0.1f, 0, 0}, Mat3::diagonal({1, 2, 2.5f})};
    massive.def.awake = false;
    massive.colliders.push_back({1, {}, ""});
    Body turning;
    turning.name = "turning";
    turning.def.kind = BodyKind::Kinematic;
    turning.def.angular_velocity = {0, 0, 0.4363323f};
    turning.colliders.push_back({0, {}, ""});
    turning.colliders.push_back({1, {.pose = {{0, 1, 0}, {}}}, ""});
    Body walls;
    walls.name = "walls";
    walls.def.kind = BodyKind::Static;
    walls.colliders.push_back({1, {.pose = {{0, 1, 0}, {}}}, ""});
    walls.colliders.push_back({1, {.pose = {{0, 3, 0}, {}}}, ""});
    scene.bodies = {ground, compound, massive, turning, walls};
    scene.scenery = {{1, {0, 0, 5}, Mat3::diagonal({2, 2, 2}), {0.25f, 0.5f, 0.75f, 1}}};
    return scene;
}

void expect_equal_mass(const std::optional<MassProperties>& a, const std::optional<MassProperties>& b) {
    ASSERT_EQ(a.has_value(), b.has_value());
    if (!a) return;
    EXPECT_EQ(a->mass, b->mass);
    test::expect_near(a->centre, b->centre, 1e-6);
    for (int i = 0; i < 3; ++i) test::expect_near(a->inertia[i], b->inertia[i], 1e-5);
}

void expect_equal_visuals(const Scene& a, const Scene& b, std::vector<Visual> of_a, std::vector<Visual> of_b) {
    ASSERT_EQ(of_a.size(), of_b.size());
    for (std::size_t i = 0; i < of_a.size(); ++i) {
        EXPECT_EQ(a.meshes[of_a[i].mesh], b.meshes[of_b[i].mesh]);
        for (int column = 0; column < 3; ++column)
            test::expect_near(of_a[i].linear[column], of_b[i].linear[column], 1e-6);
        test::expect_near(of_a[i].position, of_b[i].position, 1e-6);
        EXPECT_EQ(of_a[i].colour, of_b[i].colour);
    }
}

/// Hulls: expects the same vertices, in any order.
void expect_equal_shapes(const Shape& a, const Shape& b) {
    ASSERT_EQ(a.index(), b.index());
    const auto* hull_a = std::get_if<ConvexHull>(&a);
    if (hull_a == nullptr) {
        EXPECT_EQ(a, b);
        return;
    }
    const ConvexHull& hull_b = std::get<ConvexHull>(b);
    ASSERT_EQ(hull_a->vertices.size(), hull_b.vertices.size());
    for (const Vec3 v : hull_a->vertices) {
        const Vec3 nearest = hull_b.vertices[hull_b.support_index(v - Vec3{})];
        float best = length(v - nearest);
        for (const Vec3 w : hull_b.vertices) best = std::min(best, length(v - w));
        EXPECT_LT(best, 1e-5f);
    }
}

void expect_equal(const Scene& a, const Scene& b) {
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.gravity, b.gravity);
    EXPECT_EQ(a.camera, b.camera);
    EXPECT_EQ(a.settings, b.settings);
    ASSERT_EQ(a.bodies.size(), b.bodies.size());
    for (std::size_t i = 0; i < a.bodies.size(); ++i) {
        const BodyDef &x = a.bodies[i].def, &y = b.bodies[i].def;
        SCOPED_TRACE(a.bodies[i].name + " " + std::to_string(i));
        EXPECT_EQ(a.bodies[i].name, b.bodies[i].name);
        EXPECT_EQ(x.kind, y.kind);
        EXPECT_EQ(x.position, y.position);
        EXPECT_EQ(x.rotation, y.rotation);
        EXPECT_EQ(x.linear_velocity, y.linear_velocity);
        EXPECT_EQ(x.angular_velocity, y.angular_velocity);
        EXPECT_EQ(x.linear_damping, y.linear_damping);
        EXPECT_EQ(x.angular_damping, y.angular_damping);
        EXPECT_EQ(x.gravity_scale, y.gravity_scale);
        EXPECT_EQ(x.locks, y.locks);
        EXPECT_EQ(x.can_sleep, y.can_sleep);
        EXPECT_EQ(x.awake, y.awake);
        EXPECT_EQ(x.user, y.user);
        expect_equal_mass(x.mass, y.mass);
        ASSERT_EQ(a.bodies[i].colliders.size(), b.bodies[i].colliders.size());
        for (std::size_t k = 0; k < a.bodies[i].colliders.size(); ++k) {
            const Collider &c = a.bodies[i].colliders[k], &d = b.bodies[i].colliders[k];
            EXPECT_EQ(c.name, d.name);
            expect_equal_shapes(a.shapes[c.shape], b.shapes[d.shape]);
            test::expect_near(c.def.pose.position, d.def.pose.position, 1e-6);
            EXPECT_LT(length(rotate(c.def.pose.rotation, Vec3{1, 2, 3}) - rotate(d.def.pose.rotation, Vec3{1, 2, 3})),
                      2e-6f);
            EXPECT_EQ(c.def.material, d.def.material);
            EXPECT_EQ(c.def.density, d.def.density);
            EXPECT_EQ(c.def.filter, d.def.filter);
            EXPECT_EQ(c.def.sensor, d.def.sensor);
            EXPECT_EQ(c.def.user, d.def.user);
        }
        expect_equal_visuals(a, b, a.bodies[i].visuals, b.bodies[i].visuals);
    }
    expect_equal_visuals(a, b, a.scenery, b.scenery);
}

TEST(WrittenGltf, ReadsBackAsTheSameScene) {
    const Scene scene = scene_with_all_fields();
    for (const GltfForm form : {GltfForm::Text, GltfForm::Binary}) {
        const auto bytes = gltf_bytes(scene, form);
        ASSERT_TRUE(bytes) << bytes.error().text();
        const auto back = test::read_text(*bytes);
        ASSERT_TRUE(back) << back.error().text();
        EXPECT_TRUE(back->warnings.empty()) << back->warnings[0];
        expect_equal(scene, *back);
    }
}

TEST(WrittenGltf, GeneratedScenesReadBackUnchanged) {
    for (const Generator& kind : generators()) {
        SCOPED_TRACE(kind.name);
        const Scene scene = *generate(kind.name, {.count = 200});
        const auto back = test::read_text(*gltf_bytes(scene, GltfForm::Binary));
        ASSERT_TRUE(back) << back.error().text();
        EXPECT_TRUE(back->warnings.empty()) << back->warnings[0];
        expect_equal(scene, *back);
    }
}

TEST(WrittenGltf, IsAcceptedByTinygltf) {
    const Scene scene = scene_with_all_fields();
    tinygltf::TinyGLTF loader;
    tinygltf::Model model;
    std::string error, warning;
    const std::string text = *gltf_bytes(scene, GltfForm::Text), binary = *gltf_bytes(scene, GltfForm::Binary);
    ASSERT_TRUE(
        loader.LoadASCIIFromString(&model, &error, &warning, text.data(), static_cast<unsigned>(text.size()), ""))
        << error;
    EXPECT_EQ(warning, "");
    EXPECT_EQ(model.scenes.at(0).nodes.size(), scene.bodies.size() + scene.scenery.size() + 1);
    EXPECT_EQ(model.nodes.at(0).name, "ground");
    ASSERT_TRUE(loader.LoadBinaryFromMemory(&model, &error, &warning,
                                            reinterpret_cast<const unsigned char*>(binary.data()),
                                            static_cast<unsigned>(binary.size()), ""))
        << error;
    EXPECT_EQ(model.extensionsUsed.at(0), "KHR_implicit_shapes");
    EXPECT_EQ(model.cameras.size(), 1u);
}

TEST(WrittenGltf, EqualScenesGiveEqualBytes) {
    EXPECT_EQ(*gltf_bytes(scene_with_all_fields(), GltfForm::Binary),
              *gltf_bytes(scene_with_all_fields(), GltfForm::Binary));
}

TEST(WrittenGltf, RefusesInconsistentScenes) {
    Scene shape = scene_with_all_fields(), mesh = scene_with_all_fields(), number = scene_with_all_fields(),
          index = scene_with_all_fields();
    shape.bodies[0].colliders[0].shape = 99;
    EXPECT_EQ(gltf_bytes(shape, GltfForm::Text).status(), Status::OutOfRange);
    mesh.scenery[0].mesh = 99;
    EXPECT_EQ(gltf_bytes(mesh, GltfForm::Text).status(), Status::OutOfRange);
    index.meshes[0].indices[0] = 99;
    EXPECT_EQ(gltf_bytes(index, GltfForm::Text).status(), Status::OutOfRange);
    number.bodies[1].def.position.x = std::numeric_limits<double>::infinity();
    EXPECT_EQ(gltf_bytes(number, GltfForm::Text).status(), Status::BadArgument);
    number = scene_with_all_fields();
    number.bodies[1].def.linear_damping = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(gltf_bytes(number, GltfForm::Text).status(), Status::BadArgument);
    mesh = scene_with_all_fields();
    mesh.meshes[0] = {};
    EXPECT_EQ(gltf_bytes(mesh, GltfForm::Text).status(), Status::BadArgument);
}

TEST(WrittenGltf, ASleepingBodyIsReadAtRest) {
    Scene scene = scene_with_all_fields();
    std::size_t dynamic = 0;
    for (Body& body : scene.bodies) {
        if (body.def.kind == BodyKind::Static) continue;
        dynamic += body.def.kind == BodyKind::Dynamic ? 1 : 0;
        body.def.awake = false;
        body.def.linear_velocity = {1, 0, 0};
    }
    ASSERT_GT(dynamic, 0u);
    const auto bytes = gltf_bytes(scene, GltfForm::Text);
    ASSERT_TRUE(bytes) << bytes.error().text();
    const Result<Scene> read = test::read_text(*bytes);
    ASSERT_TRUE(read) << read.error().text();
    for (const Body& body : read->bodies) {
        EXPECT_EQ(body.def.awake, body.def.kind != BodyKind::Dynamic) << body.name;
        EXPECT_EQ(length(body.def.linear_velocity) > 0, body.def.kind == BodyKind::Kinematic) << body.name;
    }
    EXPECT_TRUE(std::any_of(read->warnings.begin(), read->warnings.end(), [](const std::string& text) {
        return text.starts_with("velocities of sleeping bodies are skipped");
    }));
    Result<World> world = World::create(settings_for(*read));
    ASSERT_TRUE(world);
    EXPECT_TRUE(instantiate(*read, *world));
}

TEST(WrittenGltf, TheExtensionSelectsTheForm) {
    const test::TemporaryFolder folder;
    const Scene scene = scene_with_all_fields();
    ASSERT_TRUE(write_gltf(scene, folder / "a.glb"));
    ASSERT_TRUE(write_gltf(scene, folder / "a.gltf"));
    EXPECT_EQ(test::content_of(folder / "a.glb").substr(0, 4), "glTF");
    EXPECT_EQ(test::content_of(folder / "a.gltf").substr(0, 1), "{");
    EXPECT_EQ(write_gltf(scene, folder / "a.txt").status(), Status::BadArgument);
    EXPECT_EQ(write_gltf(scene, folder / "none/a.glb").status(), Status::Io);
}

TEST(WrittenGltf, AnEmptySceneGivesAValidFile) {
    const auto back = test::read_text(*gltf_bytes({}, GltfForm::Binary));
    ASSERT_TRUE(back) << back.error().text();
    EXPECT_TRUE(back->bodies.empty());
}

}  // namespace
}  // namespace fase::scene
