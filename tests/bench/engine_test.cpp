/// Every engine of the list simulates the same scene alike.
#include "bench/engine.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fase/geometry/hull_builder.hpp"
#include "fase/scene/generate.hpp"

namespace fase::bench {
namespace {

scene::Scene one_body(const Shape& shape, BodyDef def, const ColliderDef& collider = {}) {
    scene::Scene scene;
    scene.shapes = {shape, Box{{50, 1, 50}}};
    BodyDef ground;
    ground.kind = BodyKind::Static;
    ground.position = {0, -1, 0};
    scene.bodies = {scene::Body{"ground", ground, {{1, {}, "ground"}}, {}},
                    scene::Body{"one", def, {{0, collider, "one"}}, {}}};
    return scene;
}

/// Returns the centre of the only dynamic body after some steps.
Vec3d centre_after(const EngineInfo& info, const scene::Scene& scene, int steps) {
    EngineOptions options{scene::settings_for(scene)};
    options.settings.sleep = false;
    Result<std::unique_ptr<Engine>> engine = info.make(scene, options);
    if (!engine) {
        ADD_FAILURE() << info.name << ": " << engine.error().text();
        return {};
    }
    for (int i = 0; i < steps; ++i) EXPECT_TRUE((*engine)->step());
    std::vector<Vec3d> centres;
    (*engine)->read_centres(centres);
    EXPECT_EQ(centres.size(), 1u);
    EXPECT_FALSE((*engine)->settings().empty());
    return centres.at(0);
}

TEST(Engines, FaseIsFirstInTheList) { EXPECT_EQ(engines().front().name, "fase"); }

TEST(Engines, AFallingBodyCoversOneTimeStepPerStep) {
    for (const EngineInfo& info : engines()) {
        const Vec3d centre = centre_after(info, one_body(Sphere{0.5f}, {.position = {3, 100, 2}}), 60);
        EXPECT_NEAR(centre.x, 3, 1e-5) << info.name;
        // Tolerance: the difference between semi-implicit Euler and the parabola.
        EXPECT_NEAR(centre.y, 100 - 9.81 / 2, 0.09) << info.name;
    }
}

TEST(Engines, EveryShapeRestsOnTheGroundAtItsHeight) {
    struct Case {
        Shape shape;
        double height;
    };
    for (const Case& one :
         {Case{Sphere{0.5f}, 0.5}, Case{Box{{0.3f, 0.4f, 0.5f}}, 0.4}, Case{Cylinder{0.5f, 0.25f}, 0.25}}) {
        for (const EngineInfo& info : engines()) {
            const Vec3d centre = centre_after(info, one_body(one.shape, {.position = {0, one.height + 0.1, 0}}), 120);
            EXPECT_NEAR(centre.y, one.height, 0.01) << info.name << " " << name_of(one.shape);
        }
    }
}

TEST(Engines, AShapeOffsetMovesTheCentreOfMass) {
    ColliderDef offset;
    offset.pose.position = {2, 0, 0};
    for (const EngineInfo& info : engines()) {
        const scene::Scene scene = one_body(Box{{0.5f, 0.5f, 0.5f}}, {.position = {0, 0.5, 0}}, offset);
        const Vec3d centre = centre_after(info, scene, 60);
        EXPECT_NEAR(centre.x, 2, 0.01) << info.name;
        EXPECT_NEAR(centre.y, 0.5, 0.01) << info.name;
    }
}

TEST(Engines, FrictionIsEqualInAllEngines) {
    // A box of friction a that slides on ground of friction b stops after v² / (2 g sqrt(a b)).
    for (const EngineInfo& info : engines()) {
        ColliderDef low_friction;
        low_friction.material.friction = 0.4f;
        scene::Scene scene =
            one_body(Box{{0.5f, 0.2f, 0.5f}}, {.position = {0, 0.2, 0}, .linear_velocity = {4, 0, 0}}, low_friction);
        scene.bodies[0].colliders[0].def.material.friction = 0.9f;
        EXPECT_NEAR(centre_after(info, scene, 120).x, 16 / (2 * 9.81 * std::sqrt(0.4 * 0.9)), 0.08) << info.name;
    }
}

TEST(Engines, AKinematicDrumTurnsInAllEngines) {
    const Result<scene::Scene> scene = scene::generate("washer", {.count = 64});
    ASSERT_TRUE(scene);
    EngineOptions options{scene::settings_for(*scene)};
    options.settings.sleep = false;
    const double min_mean_offset = 0.02;  // metres; about 0 if the drum does not turn
    for (const EngineInfo& info : engines()) {
        Result<std::unique_ptr<Engine>> engine = info.make(*scene, options);
        ASSERT_TRUE(engine) << engine.error().text();
        for (int i = 0; i < 120; ++i) ASSERT_TRUE((*engine)->step());
        std::vector<Vec3d> centres;
        (*engine)->read_centres(centres);
        ASSERT_EQ(centres.size(), 64u);
        double sum = 0;
        for (const Vec3d& centre : centres) {
            sum += centre.x;
            EXPECT_GT(centre.y, 0) << info.name << " lost a cube";
        }
        EXPECT_GT(sum / 64, min_mean_offset) << info.name << ": the drum turns towards +x and moves the cubes";
    }
}

}  // namespace
}  // namespace fase::bench
