// Queries with invalid arguments, and queries of an empty world.
#include <gtest/gtest.h>

#include <limits>

#include "fase/world/query.hpp"
#include "tests/world/worlds.hpp"

namespace fase {
namespace {

using namespace test;

constexpr float inf = std::numeric_limits<float>::infinity();
constexpr float nan = std::numeric_limits<float>::quiet_NaN();

TEST(Query, rejects_invalid_numbers_and_names_the_field) {
    World world = make_world();
    add_ground(world);
    add(world, {.position = {0, 2, 0}}, Box{});
    const std::uint64_t before = world.hash();
    const auto refused = [&](const auto& result, const std::string& field) {
        ASSERT_FALSE(result) << field;
        EXPECT_EQ(result.status(), Status::BadArgument) << field;
        EXPECT_NE(result.error().text().find(field), std::string::npos) << result.error().text();
        EXPECT_EQ(world.hash(), before);
    };
    std::vector<RayHit> hits;
    std::vector<std::optional<RayHit>> results;
    std::vector<Found> found;
    std::vector<NearHit> near;
    const std::vector<std::pair<Ray, std::string>> bad_rays{
        {{{nan, 0, 0}}, "ray.origin"},          {{{0, 2e7, 0}}, "ray.origin"},
        {{{0, double(inf), 0}}, "ray.origin"},  {{{}, {0, 0, 0}}, "ray.direction"},
        {{{}, {0, nan, 1}}, "ray.direction"},   {{{}, {0, 2, 0}}, "ray.direction"},
        {{{}, {0, 1.01f, 0}}, "ray.direction"}, {{{}, {0, 1, 0}, -1}, "ray.length"},
        {{{}, {0, 1, 0}, nan}, "ray.length"},
    };
    for (const auto& [ray, field] : bad_rays) {
        refused(cast_ray(world, ray), field);
        refused(any_hit(world, ray), field);
        refused(cast_ray_all(world, ray, {}, hits), field);
        const std::vector<Ray> rays{{{}, {0, 1, 0}}, ray};
        refused(cast_rays(world, rays, {}, results), "rays[1]." + field.substr(4));
    }
    const Pose here{{0, 1, 0}, {}};
    refused(cast_shape(world, Sphere{0}, here, {0, 1, 0}, 1), "radius");
    refused(cast_shape(world, ConvexHull{}, here, {0, 1, 0}, 1), "hull");
    refused(cast_shape(world, Sphere{}, {{nan, 0, 0}, {}}, {0, 1, 0}, 1), "pose.position");
    refused(cast_shape(world, Sphere{}, {{}, {0, 0, 0, 0}}, {0, 1, 0}, 1), "pose.rotation");
    refused(cast_shape(world, Sphere{}, here, {0, 1.1f, 0}, 1), "direction");
    refused(cast_shape(world, Sphere{}, here, {0, 1, 0}, -1), "length");
    refused(overlapping(world, Box{{1, nan, 1}}, here, {}, found), "half");
    refused(overlapping(world, Sphere{}, {{0, 0, nan}, {}}, {}, found), "pose.position");
    refused(overlapping(world, Aabb{}, {}, found), "box");
    refused(overlapping(world, Aabb{{0, 0, nan}, {1, 1, 1}}, {}, found), "box");
    refused(colliders_at(world, {0, nan, 0}, {}, found), "point");
    refused(nearest(world, {0, nan, 0}, 1, 1, {}, near), "point");
    refused(nearest(world, {}, 0, 1, {}, near), "k");
    refused(nearest(world, {}, 1, -1, {}, near), "radius");
    refused(nearest(world, {}, 1, nan, {}, near), "radius");
    refused(seen_by(world, Frustum{}, {}, found), "frustum");
    Frustum frustum = box_frustum({}, {}, {1, 1, 1});
    frustum.sides[3].offset = nan;
    refused(seen_by(world, frustum, {}, found), "sides[3]");
    frustum = box_frustum({}, {}, {1, 1, 1});
    frustum.sides[2].normal *= 2;
    refused(seen_by(world, frustum, {}, found), "sides[2].normal");
    frustum = box_frustum({}, {}, {1, 1, 1});
    for (Frustum::Side& side : frustum.sides) side = {-side.normal, -side.offset};
    refused(seen_by(world, frustum, {}, found), "frustum");
    EXPECT_TRUE(hits.empty() && results.empty() && found.empty() && near.empty());
}

TEST(Query, inside_a_step_is_rejected) {
    struct QueryingRunner final : TaskRunner {
        const World* world = nullptr;
        Status status = Status::Ok;
        void run(std::size_t count, const std::function<void(std::size_t)>& chunk) override {
            if (world != nullptr) status = cast_ray(*world, {{0, 9, 0}, {0, -1, 0}}).status();
            for (std::size_t i = 0; i < count; ++i) chunk(i);
        }
        [[nodiscard]] int threads() const override { return 2; }
    } runner;
    World world = make_world({}, {.tasks = &runner});
    add_pile(world, 200);
    runner.world = &world;
    run(world, 0.1);
    EXPECT_EQ(runner.status, Status::Busy);
}

TEST(Query, of_an_empty_world_finds_nothing) {
    const World world = make_world();
    EXPECT_FALSE(opened(cast_ray(world, {{0, 9, 0}, {0, -1, 0}})));
    EXPECT_FALSE(opened(any_hit(world, {{0, 9, 0}, {0, -1, 0}})));
    EXPECT_FALSE(opened(cast_shape(world, Sphere{}, {}, {0, 1, 0}, inf)));
    std::vector<Found> found;
    std::vector<NearHit> near;
    opened(overlapping(world, Aabb::everything(), {}, found));
    opened(nearest(world, {}, 5, inf, {}, near));
    EXPECT_TRUE(found.empty() && near.empty());
}

}  // namespace
}  // namespace fase
