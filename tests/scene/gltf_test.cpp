/// Tests of the glTF reader with valid files: the KHR extensions, their predecessors, node hierarchies.
#include "fase/scene/gltf.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fase/geometry/bounds.hpp"
#include "fase/geometry/mass.hpp"
#include "tests/scene/support.hpp"

namespace fase::scene {
namespace {

using test::body_named;
using test::expect_near;
using test::shape_of;

Scene read(std::string_view name) {
    Result<Scene> scene = read_gltf(test::fixture(name));
    EXPECT_TRUE(scene) << (scene ? "" : scene.error().text());
    return scene ? *std::move(scene) : Scene{};
}

bool warns(const Scene& scene, std::string_view text) {
    return std::find(scene.warnings.begin(), scene.warnings.end(), text) != scene.warnings.end();
}

Aabb box_of(const Scene& scene, const Body& body, std::size_t collider = 0) {
    const Collider& c = body.colliders[collider];
    return bounds(scene.shapes[c.shape], Pose{body.def.position, body.def.rotation} * c.def.pose);
}

TEST(GltfShapes, HaveTheSizesOfTheFile) {
    const Scene scene = read("shapes.gltf");
    EXPECT_EQ(shape_of<Sphere>(scene, body_named(scene, "sphere")).radius, 0.75f);
    EXPECT_EQ(shape_of<Box>(scene, body_named(scene, "box")).half, (Vec3{0.5f, 1, 1.5f}));
    EXPECT_EQ(shape_of<Capsule>(scene, body_named(scene, "capsule")), (Capsule{0.3f, 0.75f}));
    EXPECT_EQ(shape_of<Cylinder>(scene, body_named(scene, "cylinder")), (Cylinder{0.4f, 1}));
    EXPECT_NO_FATAL_FAILURE(shape_of<HalfSpace>(scene, body_named(scene, "ground")));
}

TEST(GltfShapes, HaveTheDefaultsOfTheExtension) {
    const Scene scene = read("shapes.gltf");
    EXPECT_EQ(shape_of<Sphere>(scene, body_named(scene, "default sphere")).radius, 0.5f);
    EXPECT_EQ(shape_of<Box>(scene, body_named(scene, "default box")).half, (Vec3{0.5f, 0.5f, 0.5f}));
    EXPECT_EQ(shape_of<Capsule>(scene, body_named(scene, "default capsule")), (Capsule{0.25f, 0.25f}));
    EXPECT_EQ(shape_of<Cylinder>(scene, body_named(scene, "default cylinder")), (Cylinder{0.25f, 0.25f}));
}

TEST(GltfShapes, TaperedShapesBecomeHulls) {
    const Scene scene = read("shapes.gltf");
    const ConvexHull& cone = shape_of<ConvexHull>(scene, body_named(scene, "cone"));
    EXPECT_EQ(cone.core_support(Vec3{0, 1, 0}), (Vec3{0, 1, 0}));
    // A cone's volume; the 32 sides reduce it by less than 1 %.
    EXPECT_NEAR(mass_properties(Shape(cone), 1).mass, 3.14159f * 0.25f * 2 / 3, 0.01f);
    const ConvexHull& capsule = shape_of<ConvexHull>(scene, body_named(scene, "tapered capsule"));
    EXPECT_NEAR(capsule.core_support(Vec3{0, 1, 0}).y, 0.7f, 1e-5f);
    EXPECT_NEAR(capsule.core_support(Vec3{0, -1, 0}).y, -1, 1e-5f);
}

TEST(GltfShapes, AFinitePlaneIsABoxUnderItsSurface) {
    const Scene scene = read("shapes.gltf");
    const Aabb box = box_of(scene, body_named(scene, "table"));
    EXPECT_NEAR(box.hi.y, 0, 1e-6);
    EXPECT_NEAR(box.hi.z, 3, 1e-5);
    EXPECT_TRUE(warns(scene, "planes of finite size are replaced by boxes 0.1 m thick"));
}

TEST(GltfMotion, WithoutAMassTheDensityDeterminesIt) {
    const Scene scene = read("motions.gltf");
    const Body& body = body_named(scene, "by density");
    EXPECT_EQ(body.def.kind, BodyKind::Dynamic);
    EXPECT_FALSE(body.def.mass);
}

TEST(GltfMotion, ScalesTheInertiaToTheMass) {
    const Scene scene = read("motions.gltf");
    const Body& body = body_named(scene, "mass only");
    ASSERT_TRUE(body.def.mass);
    EXPECT_FLOAT_EQ(body.def.mass->mass, 4000);
    expect_near(body.def.mass->centre, Vec3{});
    EXPECT_NEAR(body.def.mass->inertia.x.x, 4000 * (1 + 4) / 12.0, 0.1);
    EXPECT_NEAR(body.def.mass->inertia.z.z, 4000 * (1 + 1) / 12.0, 0.1);
}

TEST(GltfMotion, KeepsGivenMassCentreAndRotatedInertia) {
    const Scene scene = read("motions.gltf");
    const Body& body = body_named(scene, "all given");
    ASSERT_TRUE(body.def.mass);
    EXPECT_EQ(body.def.mass->mass, 2);
    expect_near(body.def.mass->centre, Vec3{0.1f, 0.2f, 0.3f});
    // A quarter turn about z swaps the moments about x and y.
    EXPECT_NEAR(body.def.mass->inertia.x.x, 2, 1e-5);
    EXPECT_NEAR(body.def.mass->inertia.y.y, 1, 1e-5);
    EXPECT_NEAR(body.def.mass->inertia.z.z, 2.5, 1e-5);
    EXPECT_NEAR(body.def.mass->inertia.x.y, 0, 1e-5);
}

TEST(GltfMotion, ReadsVelocitiesInTheNodesFrame) {
    const Scene scene = read("motions.gltf");
    const Body& body = body_named(scene, "turned");
    expect_near(body.def.linear_velocity, Vec3{0, 1, 0});
    expect_near(body.def.angular_velocity, Vec3{-2, 0, 0});
    EXPECT_EQ(body.def.gravity_scale, -0.5f);
    EXPECT_EQ(body_named(scene, "kinematic").def.kind, BodyKind::Kinematic);
    expect_near(body_named(scene, "kinematic").def.angular_velocity, Vec3{0, 0, 0.5f});
}

TEST(GltfMotion, ZeroMeansInfinite) {
    const Scene scene = read("motions.gltf");
    const BodyDef& mass = body_named(scene, "endless mass").def;
    EXPECT_TRUE(mass.locks.linear_x && mass.locks.linear_y && mass.locks.linear_z && !mass.locks.angular_x);
    const BodyDef& inertia = body_named(scene, "endless inertia").def;
    EXPECT_TRUE(inertia.locks.angular_x && inertia.locks.angular_y && inertia.locks.angular_z &&
                !inertia.locks.linear_x);
    EXPECT_EQ(inertia.mass->mass, 1);
}

TEST(GltfMotion, ABodyWithoutCollidersHasTheInertiaOfABall) {
    const Scene scene = read("motions.gltf");
    const Body& body = body_named(scene, "no collider");
    ASSERT_TRUE(body.def.mass);
    EXPECT_FLOAT_EQ(body.def.mass->mass, 3);
    EXPECT_FLOAT_EQ(body.def.mass->inertia.x.x, 0.4f * 3 * 0.25f);
}

TEST(GltfSurfaces, KeepMaterials) {
    const Scene scene = read("surfaces.gltf");
    EXPECT_EQ(body_named(scene, "plain").colliders[0].def.material, Material{});
    const Material rubber = body_named(scene, "rubber").colliders[0].def.material;
    EXPECT_EQ(rubber, (Material{0.8f, 0.7f, CombineMode::Maximum, CombineMode::Multiply}));
    const Material ice = body_named(scene, "ice").colliders[0].def.material;
    EXPECT_EQ(ice, (Material{0.1f, 0, CombineMode::Minimum, CombineMode::Average}));
    EXPECT_TRUE(
        warns(scene, "static friction that differs from dynamic friction is not simulated, dynamic friction is used"));
}

TEST(GltfSurfaces, MapCollisionSystemsToBits) {
    const Scene scene = read("surfaces.gltf");
    const auto filter = [&](std::string_view name) { return body_named(scene, name).colliders[0].def.filter; };
    const auto meet = [&](std::string_view a, std::string_view b) { return pairs::may_collide(filter(a), filter(b)); };
    EXPECT_TRUE(meet("character", "landscape"));
    EXPECT_FALSE(meet("character", "debris"));
    EXPECT_FALSE(meet("character", "plain")) << "the character collides with the landscape only";
    EXPECT_TRUE(meet("debris", "landscape"));
    EXPECT_TRUE(meet("debris", "debris"));
    EXPECT_TRUE(meet("landscape", "plain"));
}

TEST(GltfSurfaces, ConvertTriggersToSensors) {
    const Scene scene = read("surfaces.gltf");
    const Body& trigger = body_named(scene, "trigger");
    ASSERT_EQ(trigger.colliders.size(), 1u);
    EXPECT_TRUE(trigger.colliders[0].def.sensor);
    EXPECT_EQ(trigger.def.kind, BodyKind::Static);
    EXPECT_EQ(trigger.colliders[0].def.filter, body_named(scene, "character").colliders[0].def.filter);
    expect_near(body_named(scene, "part").def.position, Vec3d{1, 0, 0});
}

TEST(GltfHierarchy, AddsColliderNodesToTheirBody) {
    const Scene scene = read("hierarchy.gltf");
    const Body& body = body_named(scene, "body");
    ASSERT_EQ(body.colliders.size(), 2u);
    expect_near(body.def.position, Vec3d{10, 5, 0});
    // The parent's scale of 2 applies to sizes and distances; its rotation applies to the body.
    EXPECT_EQ(shape_of<Box>(scene, body, 0).half, (Vec3{1, 1, 1}));
    expect_near(body.colliders[0].def.pose.position, Vec3{2, 0, 0});
    EXPECT_EQ(shape_of<Box>(scene, body, 1).half, (Vec3{1, 3, 0.5f}));
    expect_near(body.def.linear_velocity, Vec3{0, 1, 0});
    const Aabb left = box_of(scene, body, 0);
    expect_near(left.lo, Vec3{9, 6, -1}, 1e-4);
    expect_near(left.hi, Vec3{11, 8, 1}, 1e-4);
}

TEST(GltfHierarchy, ABodyBelowABodyIsSeparate) {
    const Scene scene = read("hierarchy.gltf");
    const Body& inner = body_named(scene, "inner body");
    expect_near(inner.def.position, Vec3d{2, 5, 0});
    ASSERT_EQ(inner.colliders.size(), 1u);
    EXPECT_FLOAT_EQ(shape_of<Sphere>(scene, inner).radius, 1);
}

TEST(GltfHierarchy, ScalesAndMirrorsShapes) {
    const Scene scene = read("hierarchy.gltf");
    const Body& mirror = body_named(scene, "mirror");
    EXPECT_EQ(mirror.def.kind, BodyKind::Static);
    const Aabb box = box_of(scene, mirror);
    expect_near(box.lo, Vec3{9.5f, -1, 6.5f}, 1e-4);
    expect_near(box.hi, Vec3{10.5f, 1, 7.5f}, 1e-4);
    const Aabb ball = box_of(scene, body_named(scene, "stretched ball"));
    expect_near(ball.hi - ball.lo, Vec3{1, 2, 1}, 0.03);
    const Aabb matrix = box_of(scene, body_named(scene, "matrix"));
    expect_near(matrix.lo, Vec3{0, 1, 2}, 1e-4);
    expect_near(matrix.hi, Vec3{2, 3, 4}, 1e-4);
    EXPECT_TRUE(warns(scene, "colliders of nodes with a zero scale are skipped"));
}

TEST(GltfMeshes, BecomeHullsAndCollisionMeshes) {
    const Scene scene = read("meshes.gltf");
    const ConvexHull& hull = shape_of<ConvexHull>(scene, body_named(scene, "hull"));
    EXPECT_EQ(hull.vertices.size(), 6u);
    EXPECT_EQ(hull.faces.size(), 8u);
    const Aabb stretched = box_of(scene, body_named(scene, "long hull"));
    expect_near(stretched.lo, Vec3{4, 1, -1}, 1e-4);
    expect_near(stretched.hi, Vec3{6, 5, 1}, 1e-4);
    const fase::Mesh& mesh = shape_of<fase::Mesh>(scene, body_named(scene, "triangles"));
    EXPECT_EQ(mesh.data->size(), 8u);
    EXPECT_TRUE(mesh.data->two_sided());
    EXPECT_EQ(mesh.data->report().open_edges, 0u);
}

TEST(GltfMeshes, AreKeptAsVisuals) {
    const Scene scene = read("meshes.gltf");
    ASSERT_EQ(scene.meshes.size(), 1u) << "one mesh shared by all";
    EXPECT_EQ(scene.meshes[0].indices.size(), 24u);
    ASSERT_EQ(scene.scenery.size(), 1u);
    const auto scaled =
        std::find_if(scene.scenery.begin(), scene.scenery.end(), [](const Visual& v) { return v.position.z == 9; });
    ASSERT_NE(scaled, scene.scenery.end());
    EXPECT_EQ(scaled->linear, Mat3::diagonal({3, 3, 3}));
    EXPECT_EQ(scaled->colour, (Colour{0.8f, 0.1f, 0.1f, 1}));
    const Body& body = body_named(scene, "body");
    ASSERT_EQ(body.visuals.size(), 1u);
    expect_near(body.visuals[0].position, Vec3{0, 0.5f, 0});
    EXPECT_EQ(body.visuals[0].linear, Mat3::diagonal({1, 1, 2}));
}

TEST(GltfJoints, AreReadWithTheirType) {
    const Scene scene = read("joints.gltf");
    ASSERT_EQ(scene.joints.size(), 2u);
    EXPECT_EQ(scene.joints[0].type, "hinge");
    EXPECT_EQ(scene.joints[0].a, 0u);
    EXPECT_EQ(scene.joints[0].b, std::nullopt) << "a static frame is the world";
    EXPECT_FALSE(scene.joints[0].collide);
    EXPECT_EQ(scene.joints[1].type, "ball");
    EXPECT_EQ(scene.bodies[*scene.joints[1].a].name, "arm");
    EXPECT_EQ(scene.bodies[*scene.joints[1].b].name, "door");
    EXPECT_TRUE(scene.joints[1].collide);
    EXPECT_TRUE(warns(scene, "joints (hinge) are not simulated yet"));
}

TEST(GltfOlderNames, KhrCollisionShapesAreRead) {
    const Scene scene = read("older_khr.gltf");
    const Body& ball = body_named(scene, "ball");
    EXPECT_EQ(ball.def.kind, BodyKind::Dynamic);
    EXPECT_EQ(ball.def.mass->mass, 2);
    EXPECT_FLOAT_EQ(shape_of<Sphere>(scene, ball).radius, 0.4f);
    EXPECT_EQ(ball.colliders[0].def.material.restitution, 0.5f);
    EXPECT_EQ(body_named(scene, "floor").def.kind, BodyKind::Static);
    EXPECT_EQ(shape_of<Box>(scene, body_named(scene, "shape only")).half, (Vec3{2, 0.5f, 2}));
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings[0];
}

TEST(GltfOlderNames, OmiBodiesOfTheFirstVersionAreRead) {
    const Scene scene = read("older_omi.gltf");
    const Body& crate = body_named(scene, "crate");
    EXPECT_EQ(crate.def.kind, BodyKind::Dynamic);
    EXPECT_EQ(crate.def.mass->mass, 5);
    expect_near(crate.def.linear_velocity, Vec3{0, -1, 0});
    EXPECT_EQ(shape_of<Capsule>(scene, crate), (Capsule{0.5f, 1})) << "the height includes the caps";
    EXPECT_EQ(body_named(scene, "floor").def.kind, BodyKind::Static);
    EXPECT_TRUE(body_named(scene, "goal shape").colliders[0].def.sensor);
    expect_near(scene.gravity, Vec3{0, -1.62f, 0});
}

TEST(GltfReader, SummarisesWarningsThatDifferOnlyInNames) {
    std::string used, textures;
    for (int i = 0; i < 1000; ++i) {
        used += (i == 0 ? "\"" : ", \"") + std::string("ACME_") + std::to_string(1000 + i) + "\"";
        textures += i == 0 ? "{}" : ", {}";
    }
    const Result<Scene> scene = test::read_text(R"({"asset": {"version": "2.0"}, "extensionsUsed": [)" + used +
                                                R"(, "KHR_materials_unlit"], "textures": [)" + textures + "]}");
    ASSERT_TRUE(scene) << scene.error().text();
    EXPECT_EQ(scene->warnings,
              (std::vector<std::string>{
                  "extension \"ACME_1000\" is not supported, and 999 more of this kind (1000 times)",
                  "extension \"KHR_materials_unlit\" is not supported", "textures are not drawn (1000 times)"}));
}

TEST(GltfReader, WarnsOfTheWorstFirst) {
    const Scene scene = read("unknown.gltf");
    const auto place = [&](std::string_view text) {
        return std::find(scene.warnings.begin(), scene.warnings.end(), text) - scene.warnings.begin();
    };
    EXPECT_LT(place("colliders without a supported shape are skipped (2 times)"),
              place("extension \"ACME_sparkles\" is not supported"));
    EXPECT_LT(place("extension \"ACME_sparkles\" is not supported"), place("animations are not played"));
}

TEST(GltfReader, WarnsOnceAboutEachUnsupportedPart) {
    const Scene scene = read("unknown.gltf");
    EXPECT_TRUE(warns(scene, "extension \"ACME_sparkles\" is not supported"));
    EXPECT_TRUE(warns(scene, "motion's \"wobble\" is not supported (2 times)"));
    EXPECT_TRUE(warns(scene, "shape type \"torus\" is not supported"));
    EXPECT_TRUE(warns(scene, "colliders without a supported shape are skipped (2 times)"));
    EXPECT_TRUE(warns(scene, "animations are not played"));
    for (std::size_t i = 1; i < scene.warnings.size(); ++i) EXPECT_NE(scene.warnings[i - 1], scene.warnings[i]);
}

TEST(GltfReader, RefusesAFileWithAnUnsupportedRequiredExtension) {
    const auto scene = test::read_text(
        R"({"asset":{"version":"2.0"},"extensionsUsed":["KHR_draco_mesh_compression"],"extensionsRequired":["KHR_draco_mesh_compression"]})");
    ASSERT_FALSE(scene);
    EXPECT_EQ(scene.status(), Status::Unsupported);
    EXPECT_TRUE(test::read_text(R"({"asset":{"version":"2.0"},"extensionsRequired":["KHR_texture_transform"]})"));
}

TEST(GltfReader, ReadsAllOmiScenes) {
    const std::filesystem::path folder = std::filesystem::path(FASE_SHARED_DATA) / "gltf" / "omi";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "skipped: no " << folder;
    std::size_t files = 0, bodies = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string ending = entry.path().extension().string();
        if (ending != ".gltf" && ending != ".glb") continue;
        const auto scene = read_gltf(entry.path().string());
        ASSERT_TRUE(scene) << scene.error().text();
        ++files;
        bodies += scene->bodies.size();
        for (const Body& body : scene->bodies) {
            for (const Collider& collider : body.colliders) {
                ASSERT_LT(collider.shape, scene->shapes.size());
                EXPECT_TRUE(check(scene->shapes[collider.shape]));
            }
        }
    }
    EXPECT_EQ(files, 31u);
    EXPECT_GT(bodies, 60u);
}

}  // namespace
}  // namespace fase::scene
