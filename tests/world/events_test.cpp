// Events of a step.
#include <set>

#include "tests/world/worlds.hpp"

namespace fase {
namespace {

using namespace test;

TEST(Events, a_contact_begins_once_and_ends_once) {
    World world = make_world();
    const BodyId ground = add_ground(world);
    const BodyId box = add(world, {.position = {0, 1, 0}}, Box{});
    int begun = 0, ended = 0;
    for (int i = 0; i < 100; ++i) {
        ASSERT_TRUE(world.step());
        for (const ContactEvent& e : world.events().contacts_begun) {
            ++begun;
            EXPECT_EQ(e.a, world.colliders_of(ground)[0]);
            EXPECT_EQ(e.b, world.colliders_of(box)[0]);
        }
        ended += static_cast<int>(world.events().contacts_ended.size());
    }
    EXPECT_EQ(begun, 1);
    EXPECT_EQ(ended, 0);
    ASSERT_TRUE(world.apply_impulse(box, {0, 8000, 0}));
    for (int i = 0; i < 20; ++i) {
        ASSERT_TRUE(world.step());
        ended += static_cast<int>(world.events().contacts_ended.size());
    }
    EXPECT_EQ(ended, 1);
}

TEST(Events, every_contact_begins_before_it_ends_for_every_structure) {
    std::vector<std::vector<ContactEvent>> events;
    for (const char* structure : {"brute_force", "dynamic_bvh"}) {
        World world = make_world({}, {.structure = structure});
        add_pile(world, 60);
        std::set<std::pair<std::uint32_t, std::uint32_t>> touching;
        std::vector<ContactEvent> all;
        for (int i = 0; i < 300; ++i) {
            ASSERT_TRUE(world.step());
            for (const ContactEvent& e : world.events().contacts_ended) {
                ASSERT_EQ(touching.erase({e.a.index, e.b.index}), 1u);
                all.push_back(e);
            }
            for (const ContactEvent& e : world.events().contacts_begun) {
                ASSERT_LT(e.a.index, e.b.index);
                ASSERT_TRUE(touching.insert({e.a.index, e.b.index}).second);
                all.push_back(e);
            }
        }
        EXPECT_GT(all.size(), 100u);
        for (ContactEvent& e : all) e.a.owner = e.b.owner = 0;
        events.push_back(all);
    }
    EXPECT_EQ(events[0], events[1]);
}

TEST(Events, a_removed_body_ends_its_contacts_in_the_next_step) {
    World world = make_world();
    add_ground(world);
    const BodyId box = add(world, {.position = {0, 0.5, 0}}, Box{});
    run(world, 0.2);
    const ColliderId collider = world.colliders_of(box)[0];
    ASSERT_TRUE(world.remove_body(box));
    ASSERT_TRUE(world.step());
    ASSERT_EQ(world.events().contacts_ended.size(), 1u);
    EXPECT_EQ(world.events().contacts_ended[0].b, collider);
    EXPECT_FALSE(world.contains(collider));
}

TEST(Events, a_hit_reports_speed_and_impulse) {
    World world = make_world();
    add_ground(world);
    const BodyId ball = add(world, {.position = {0, 5.5, 0}}, Sphere{0.5f});
    const float mass = state(world, ball).mass;
    std::vector<HitEvent> hits;
    for (int i = 0; i < 120 && hits.empty(); ++i) {
        ASSERT_TRUE(world.step());
        hits = world.events().hits;
    }
    ASSERT_EQ(hits.size(), 1u);
    EXPECT_NEAR(hits[0].speed, std::sqrt(2 * 9.81f * 5), 0.2f);
    EXPECT_NEAR(hits[0].normal.y, 1, 1e-6f);
    EXPECT_GT(hits[0].impulse, 0);
    EXPECT_LT(hits[0].impulse, 1.1f * mass * hits[0].speed);
    EXPECT_NEAR(hits[0].point.y, 0, 0.2);
}

TEST(Events, a_sensor_reports_overlaps_and_applies_no_forces) {
    World world = make_world();
    const BodyId gate = add(world, {.kind = BodyKind::Static, .position = {0, 2, 0}}, Box{}, {.sensor = true});
    const BodyId ball = add(world, {.position = {0, 5, 0}}, Sphere{0.2f});
    const BodyId twin = add(world, {.position = {10, 5, 0}}, Sphere{0.2f});
    int begun = 0, ended = 0;
    for (int i = 0; i < 90; ++i) {
        ASSERT_TRUE(world.step());
        for (const SensorEvent& e : world.events().sensors_begun) {
            ++begun;
            EXPECT_EQ(e.sensor, world.colliders_of(gate)[0]);
            EXPECT_EQ(e.visitor, world.colliders_of(ball)[0]);
            EXPECT_NEAR(state(world, ball).pose.position.y, 2.6, 0.15);
        }
        ended += static_cast<int>(world.events().sensors_ended.size());
    }
    EXPECT_EQ(begun, 1);
    EXPECT_EQ(ended, 1);
    EXPECT_EQ(state(world, ball).pose.position.y, state(world, twin).pose.position.y);
}

/// A removed sensor is still the sensor when its slot, or that of its visitor, is used again before the event is told.
TEST(Events, sensor_and_visitor_keep_their_places_when_both_are_removed) {
    for (const bool sensor_first : {true, false}) {
        for (const bool reuse_as_sensor : {true, false}) {
            World world = make_world();
            const auto add_gate = [&] {
                return add(world, {.kind = BodyKind::Static, .position = {0, 2, 0}}, Box{}, {.sensor = true});
            };
            BodyId gate, ball;
            if (sensor_first) gate = add_gate();
            ball = add(world, {.position = {0, 2, 0}, .gravity_scale = 0}, Sphere{0.2f});
            if (!sensor_first) gate = add_gate();
            ASSERT_TRUE(world.step());
            ASSERT_EQ(world.events().sensors_begun.size(), 1u);
            const SensorEvent begun = world.events().sensors_begun[0];
            ASSERT_TRUE(world.remove_body(gate));
            ASSERT_TRUE(world.remove_body(ball));
            for (int i = 0; i < 2; ++i) add(world, {.position = {9.0 * i, 50, 0}}, Box{}, {.sensor = reuse_as_sensor});
            ASSERT_TRUE(world.step());
            ASSERT_EQ(world.events().sensors_ended.size(), 1u);
            EXPECT_EQ(world.events().sensors_ended[0].sensor, begun.sensor);
            EXPECT_EQ(world.events().sensors_ended[0].visitor, begun.visitor);
        }
    }
}

TEST(Events, sleeping_and_waking_are_reported) {
    World world = make_world();
    add_ground(world);
    const BodyId box = add(world, {.position = {0, 0.5, 0}}, Box{});
    int slept = 0, woke = 0;
    for (int i = 0; i < 120; ++i) {
        ASSERT_TRUE(world.step());
        slept += static_cast<int>(world.events().fell_asleep.size());
    }
    EXPECT_EQ(slept, 1);
    ASSERT_TRUE(world.apply_impulse(box, {0, 1, 0}));
    ASSERT_TRUE(world.step());
    woke += static_cast<int>(world.events().woke_up.size());
    EXPECT_EQ(woke, 1);
}

}  // namespace
}  // namespace fase
