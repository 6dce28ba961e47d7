/// Tests of the generators: sizes, no overlaps, small gaps, reproducible bits.
#include "fase/scene/generate.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fase/geometry/bounds.hpp"
#include "fase/narrow/dispatch.hpp"
#include "fase/scene/generate/angles.hpp"
#include "fase/scene/gltf_write.hpp"

namespace fase::scene {
namespace {

struct Placed {
    Aabb box;
    std::uint32_t body = 0;
    const Collider* collider = nullptr;
};

/// All colliders, sorted by the lower x of their box.
std::vector<Placed> placed_colliders(const Scene& scene) {
    std::vector<Placed> all;
    for (std::uint32_t i = 0; i < scene.bodies.size(); ++i) {
        const Body& body = scene.bodies[i];
        for (const Collider& c : body.colliders) {
            all.push_back(
                {bounds(scene.shapes[c.shape], Pose{body.def.position, body.def.rotation} * c.def.pose), i, &c});
        }
    }
    std::sort(all.begin(), all.end(), [](const Placed& a, const Placed& b) { return a.box.lo.x < b.box.lo.x; });
    return all;
}

/// Calls f(a, b, manifold) for each pair of colliders of different bodies within `margin`; at least one body is
/// dynamic.
template <class F> void for_each_near(const Scene& scene, float margin, F&& f) {
    const std::vector<Placed> all = placed_colliders(scene);
    for (std::size_t i = 0; i < all.size(); ++i) {
        for (std::size_t j = i + 1; j < all.size() && all[j].box.lo.x <= all[i].box.hi.x + margin; ++j) {
            const Body &a = scene.bodies[all[i].body], &b = scene.bodies[all[j].body];
            const bool moves = a.def.kind == BodyKind::Dynamic || b.def.kind == BodyKind::Dynamic;
            if (all[i].body == all[j].body || !moves || !overlaps(enlarged(all[i].box, margin), all[j].box)) continue;
            const LocalPose b_in_a = relative(Pose{a.def.position, a.def.rotation} * all[i].collider->def.pose,
                                              Pose{b.def.position, b.def.rotation} * all[j].collider->def.pose);
            f(all[i].body, all[j].body,
              narrow::collide(scene.shapes[all[i].collider->shape], scene.shapes[all[j].collider->shape], b_in_a,
                              margin));
        }
    }
}

float min_separation(const narrow::Manifold& manifold) {
    float smallest = 1e9f;
    for (int i = 0; i < manifold.count; ++i)
        smallest = std::min(smallest, manifold.points[static_cast<std::size_t>(i)].separation);
    return smallest;
}

TEST(Generate, NoBodiesOverlapInitially) {
    for (const Generator& kind : generators()) {
        const Scene scene = *generate(kind.name);
        std::size_t overlapping = 0;
        for_each_near(scene, 0, [&](std::uint32_t a, std::uint32_t b, const narrow::Manifold& manifold) {
            if (min_separation(manifold) >= -2e-6f) return;
            if (overlapping++ < 3)
                ADD_FAILURE() << kind.name << ": " << scene.bodies[a].name << " " << a << " and "
                              << scene.bodies[b].name << " " << b << " overlap by " << -min_separation(manifold);
        });
        EXPECT_EQ(overlapping, 0u) << kind.name;
    }
}

TEST(Generate, EveryStoneOfTheCastleRestsOnSomething) {
    const Scene scene = *generate("castle");
    std::vector<bool> rests(scene.bodies.size(), false);
    for_each_near(scene, 0.001f, [&](std::uint32_t a, std::uint32_t b, const narrow::Manifold& manifold) {
        if (manifold.count == 0) return;
        // The normal is in a's frame and points from a to b: the upper body rests. Arch stones and round bodies lean.
        const float up = rotate(scene.bodies[a].def.rotation, manifold.normal).y;
        if (up > 0.02f) rests[b] = true;
        if (up < -0.02f) rests[a] = true;
    });
    for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
        const std::string& name = scene.bodies[i].name;
        if (name == "rock" || name == "ball" || name == "boulder") continue;
        EXPECT_TRUE(rests[i]) << name << " " << i;
    }
}

TEST(Generate, KindsHaveTheirNumberOfBodies) {
    const auto count = [](std::string_view kind, std::size_t bodies = 0) {
        return dynamic_bodies(*generate(kind, {.count = bodies}));
    };
    EXPECT_EQ(count("large_pyramid"), 5050u);
    EXPECT_EQ(count("many_pyramids"), 14u * 14 * 55);
    EXPECT_EQ(count("washer"), 8000u);
    EXPECT_EQ(count("stack", 7), 7u);
    EXPECT_EQ(count("hull_pile", 333), 333u);
    EXPECT_EQ(count("pile", 100), 100u);
    EXPECT_NEAR(static_cast<double>(count("castle")), 3000, 150);
    EXPECT_NEAR(static_cast<double>(count("castle", 9000)), 9000, 450);
    for (const Generator& kind : generators()) {
        for (const std::size_t bodies : {1u, 2u, 50u}) EXPECT_GE(count(kind.name, bodies), 1u) << kind.name;
    }
}

TEST(Generate, TheLargePyramidIsAWallOfTouchingUnitBoxes) {
    const Scene scene = *generate("large_pyramid");
    for (std::size_t i = 1; i < scene.bodies.size(); ++i) {
        EXPECT_EQ(std::get<Box>(scene.shapes[scene.bodies[i].colliders[0].shape]).half, (Vec3{0.5f, 0.5f, 0.5f}));
        EXPECT_EQ(scene.bodies[i].colliders[0].def.density, 100);
        EXPECT_EQ(scene.bodies[i].def.position.z, 0);
    }
    EXPECT_EQ(scene.bodies.back().def.position, (Vec3d{0, 99.5, 0}));
}

TEST(Generate, TheDrumRotatesAtTwentyFiveDegreesPerSecond) {
    const Scene scene = *generate("washer");
    EXPECT_EQ(scene.bodies[0].def.kind, BodyKind::Kinematic);
    EXPECT_NEAR(scene.bodies[0].def.angular_velocity.z, 0.4363323f, 1e-6f);
}

TEST(Generate, TheVolleyHitsTheCastle) {
    const Scene scene = *generate("castle");
    std::size_t balls = 0;
    for (const Body& body : scene.bodies) {
        if (body.name != "ball" && body.name != "boulder") continue;
        ++balls;
        // The smallest distance of its flight from the keep's axis, in steps of 10 ms.
        double nearest = 1e9;
        for (double t = 0; t < 12; t += 0.01) {
            const Vec3d p =
                body.def.position + to_double(body.def.linear_velocity) * t + to_double(scene.gravity) * (t * t / 2);
            if (p.y > 0) nearest = std::min(nearest, std::hypot(p.x, p.z));
        }
        EXPECT_LT(nearest, 18) << "a ball misses the castle";
    }
    EXPECT_GE(balls, 10u);
}

TEST(Generate, EqualSeedsGiveEqualScenesAndOthersDoNot) {
    for (const std::string_view kind : {"castle", "hull_pile", "pile", "sleepers"}) {
        const auto bytes = [&](std::uint64_t seed) {
            return *gltf_bytes(*generate(kind, {.count = 100, .seed = seed}), GltfForm::Binary);
        };
        EXPECT_EQ(bytes(1), bytes(1));
        EXPECT_NE(bytes(1), bytes(2)) << kind;
    }
}

TEST(Generate, RefusesUnknownKindsAndHugeCounts) {
    EXPECT_EQ(generate("palace").status(), Status::BadArgument);
    EXPECT_NE(generate("palace").error().text().find("castle"), std::string::npos);
    EXPECT_EQ(generate("pile", {.count = 1000001}).status(), Status::OutOfRange);
}

TEST(Generate, SineAndCosineAreAccurate) {
    for (int i = -2000; i <= 2000; ++i) {
        const double angle = i * 0.05;
        EXPECT_NEAR(sin_cos(angle).sin, std::sin(angle), 1e-13);
        EXPECT_NEAR(sin_cos(angle).cos, std::cos(angle), 1e-13);
    }
}

}  // namespace
}  // namespace fase::scene
