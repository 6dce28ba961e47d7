/// Ids and user data in events and hits, the ids of new bodies, and the bodies that a step moved.
#include <gtest/gtest.h>

#include <algorithm>
#include <unordered_map>

#include "tests/world/worlds.hpp"

namespace fase::test {
namespace {

TEST(NewBody, serves_as_the_id_of_the_body_and_knows_its_first_collider) {
    World world = make_world();
    const auto ball = world.add_body({.position = {0, 3, 0}}, Sphere{});
    ASSERT_TRUE(ball);
    EXPECT_TRUE(world.contains(*ball));
    EXPECT_EQ(world.colliders_of(*ball), std::vector<ColliderId>{ball->collider});
    const std::vector<ColliderShape> parts{{Box{}}, {Sphere{}, {.pose = {{1, 0, 0}, {}}}}};
    const auto compound = world.add_body({}, parts);
    ASSERT_TRUE(compound);
    EXPECT_EQ(compound->collider, world.colliders_of(*compound)[0]);
    const Result<BodyId> plain = world.add_body({});
    ASSERT_TRUE(plain) << "a NewBody serves as a BodyId";
    EXPECT_EQ(world.add_body({})->collider, ColliderId{});
    std::unordered_map<BodyId, int> score;
    score[*ball] = 7;
    EXPECT_EQ(score.at(world.bodies()[0]), 7);
}

TEST(EventData, names_body_and_collider_with_the_user_data_of_both) {
    World world = make_world();
    const auto ground = *world.add_body({.kind = BodyKind::Static, .user = 1}, HalfSpace{}, {.user = 11});
    const auto ball = *world.add_body({.position = {0, 1.5, 0}, .user = 2}, Sphere{0.5f});
    const auto zone =
        *world.add_body({.kind = BodyKind::Static, .position = {0, 0.5, 0}, .user = 3}, Box{}, {.sensor = true});
    EXPECT_EQ(world.collider(ball.collider)->def.user, 2u) << "a collider has its body's user data";
    bool hit = false, began = false, sensed = false;
    for (int i = 0; i < 120; ++i) {
        ASSERT_TRUE(world.step());
        for (const HitEvent& e : world.events().hits) {
            hit = true;
            EXPECT_EQ(e.a, ground.collider);
            EXPECT_EQ(e.a.body, ground);
            EXPECT_EQ(e.a.user, 11u);
            EXPECT_EQ(e.a.body_user, 1u);
            EXPECT_EQ(e.b.body, ball);
            EXPECT_EQ(e.b.user, 2u);
        }
        for (const ContactEvent& e : world.events().contacts_begun) {
            began = true;
            EXPECT_EQ(e.b, ball.collider);
            EXPECT_EQ(e.b.body_user, 2u);
        }
        for (const SensorEvent& e : world.events().sensors_begun) {
            sensed = true;
            EXPECT_EQ(e.sensor.body, zone);
            EXPECT_EQ(e.sensor.user, 3u);
            EXPECT_EQ(e.visitor.body, ball);
        }
    }
    EXPECT_TRUE(hit && began && sensed);
    const auto ray = *cast_ray(world, {{0, 5, 0}, {0, -1, 0}, 10});
    ASSERT_TRUE(ray);
    EXPECT_EQ(ray->body, ball);
    EXPECT_EQ(ray->user, 2u);
    EXPECT_EQ(ray->body_user, 2u);
}

TEST(EventData, of_removed_bodies_stays_readable_until_the_next_step) {
    for (const bool whole_body : {true, false})
        for (const bool restored : {true, false}) {
            World world = make_world();
            add_ground(world);
            const auto box =
                *world.add_body({.position = {0, 0.5, 0}, .user = 42}, Box{{0.5f, 0.5f, 0.5f}}, {.user = 43});
            for (int i = 0; i < 5; ++i) ASSERT_TRUE(world.step());
            if (whole_body) {
                ASSERT_TRUE(world.remove_body(box));
                ASSERT_TRUE(world.add_body({.position = {9, 9, 9}, .user = 1}, Sphere{})) << "takes the slots";
            } else {
                ASSERT_TRUE(world.remove_collider(box.collider));
            }
            if (restored) {
                World twin = make_world();
                ASSERT_TRUE(twin.restore(world.snapshot()));
                world = std::move(twin);
            }
            ASSERT_TRUE(world.step());
            ASSERT_EQ(world.events().contacts_ended.size(), 1u);
            const ContactEvent end = world.events().contacts_ended[0];
            EXPECT_EQ(end.b, box.collider);
            EXPECT_EQ(end.b.body, box);
            EXPECT_EQ(end.b.user, 43u);
            EXPECT_EQ(end.b.body_user, 42u);
            ASSERT_TRUE(world.step());
            EXPECT_TRUE(world.events().contacts_ended.empty());
        }
}

TEST(MovedBodies, are_those_that_were_awake) {
    World world = make_world();
    add_ground(world);
    const BodyId rests = add(world, {.position = {5, 0.5, 0}, .awake = false}, Box{{0.5f, 0.5f, 0.5f}});
    const BodyId falls = add(world, {.position = {0, 3, 0}}, Sphere{});
    const BodyId lift =
        add(world, {.kind = BodyKind::Kinematic, .position = {9, 9, 0}, .linear_velocity = {0, 1, 0}}, Box{});
    std::vector<BodyState> moved;
    world.read_moved_bodies(moved);
    EXPECT_TRUE(moved.empty()) << "nothing moves before the first step";
    ASSERT_TRUE(world.step());
    world.read_moved_bodies(moved);
    ASSERT_EQ(moved.size(), 2u);
    EXPECT_EQ(moved[0].id, falls);
    EXPECT_EQ(moved[1].id, lift);
    EXPECT_LT(moved[0].pose.position.y, 3);
    ASSERT_TRUE(world.remove_body(falls));
    ASSERT_TRUE(world.wake(rests));
    moved.clear();
    world.read_moved_bodies(moved);
    ASSERT_EQ(moved.size(), 1u);
    EXPECT_EQ(moved[0].id, lift);
    // Every body whose pose changes is in the list.
    World pile = make_world();
    add_ground(pile);
    for (int i = 0; i < 40; ++i) add(pile, {.position = {0.1 * i, 1.0 + i, 0}}, Box{{0.4f, 0.4f, 0.4f}});
    for (int i = 0; i < 400; ++i) {
        std::vector<BodyState> before, after, list;
        pile.read_bodies(before);
        ASSERT_TRUE(pile.step());
        pile.read_bodies(after);
        pile.read_moved_bodies(list);
        for (std::size_t k = 0; k < before.size(); ++k) {
            const bool listed = std::ranges::any_of(list, [&](const BodyState& s) { return s.id == after[k].id; });
            EXPECT_TRUE(listed || before[k].pose == after[k].pose);
        }
    }
}

TEST(StepReport, counts_dynamic_bodies_without_a_mass) {
    World world = make_world();
    add(world, {}, Sphere{}, {.density = 0});
    add(world, {.position = {5, 0, 0}}, Sphere{});
    ASSERT_TRUE(world.add_body({.position = {9, 0, 0}}));
    EXPECT_EQ(world.step()->without_mass, 2u);
}

}  // namespace
}  // namespace fase::test
