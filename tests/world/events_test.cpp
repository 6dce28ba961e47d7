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

/// A ball without bounce that flies at a wall of which the surface is at x = 0.
struct BallAtWall {
    World world = make_world(weightless());
    BodyId ball;
    float momentum = 0;

    BallAtWall(float distance, float speed) {
        add(world, {.kind = BodyKind::Static, .position = {0.5, 0, 0}}, Box{{0.5f, 5, 5}});
        ball =
            add(world, {.position = {-0.08 - double(distance), 0, 0}, .linear_velocity = {speed, 0, 0}}, Sphere{0.08f});
        momentum = state(world, ball).mass * speed;
    }
    static Settings weightless() {
        Settings settings;
        settings.gravity = {};
        return settings;
    }
};

TEST(Events, a_hit_is_told_once_with_its_whole_impulse_wherever_it_begins_in_a_step) {
    for (const float speed : {1.0f, 3.0f, 10.0f, 40.0f})
        for (int i = 0; i < 100; ++i) {
            BallAtWall scene(0.3f + speed / 60 * 0.013f * static_cast<float>(i), speed);
            std::vector<HitEvent> hits;
            for (int k = 0; k < 60; ++k) {
                ASSERT_TRUE(scene.world.step());
                hits.insert(hits.end(), scene.world.events().hits.begin(), scene.world.events().hits.end());
            }
            ASSERT_EQ(hits.size(), 1u) << speed << " m/s, start " << i;
            EXPECT_NEAR(hits[0].speed, speed, 0.01f * speed);
            EXPECT_NEAR(hits[0].impulse, scene.momentum, 0.02f * scene.momentum) << speed << " m/s, start " << i;
            EXPECT_NEAR(hits[0].point.x, 0, 0.01);
        }
}

TEST(Events, a_hit_that_is_not_over_is_told_when_its_body_is_removed_and_after_a_restore) {
    int open = 0;
    for (int i = 0; i < 50; ++i) {
        BallAtWall scene(0.3f + 10.0f / 60 * 0.026f * static_cast<float>(i), 10);
        const ColliderId collider = scene.world.colliders_of(scene.ball)[0];
        while (state(scene.world, scene.ball).linear_velocity.x > 9.9f) ASSERT_TRUE(scene.world.step());
        if (!scene.world.events().hits.empty()) continue;
        ++open;
        World restored = make_world(BallAtWall::weightless());
        ASSERT_TRUE(restored.restore(scene.world.snapshot()));
        ASSERT_EQ(restored.hash(), scene.world.hash());
        World without = make_world(BallAtWall::weightless());
        ASSERT_TRUE(without.restore(scene.world.snapshot()));
        ASSERT_TRUE(without.remove_body(scene.ball));
        ASSERT_TRUE(without.step());
        for (World* world : {&scene.world, &restored}) do
                ASSERT_TRUE(world->step());
            while (world->events().hits.empty() && world->steps() < 200);
        for (World* world : {&scene.world, &restored, &without}) {
            ASSERT_EQ(world->events().hits.size(), 1u);
            EXPECT_EQ(world->events().hits[0].b, collider);
            EXPECT_EQ(world->events().hits[0].b.body, scene.ball);
            EXPECT_NEAR(world->events().hits[0].speed, 10, 0.1f);
        }
        EXPECT_EQ(restored.events().hits[0].impulse, scene.world.events().hits[0].impulse);
        EXPECT_LT(without.events().hits[0].impulse, scene.momentum) << "of the first step alone";
        EXPECT_GT(without.events().hits[0].impulse, 0);
    }
    EXPECT_GT(open, 5);
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

/// Counts sensor events while a world runs.
struct SensorCount {
    int begun = 0, ended = 0;
    friend bool operator==(const SensorCount&, const SensorCount&) = default;
};
SensorCount count_sensor_events(World& world, int steps = 60) {
    SensorCount count;
    for (int i = 0; i < steps; ++i) {
        EXPECT_TRUE(world.step());
        count.begun += static_cast<int>(world.events().sensors_begun.size());
        count.ended += static_cast<int>(world.events().sensors_ended.size());
    }
    return count;
}
constexpr Box zone{{2, 1, 2}};
const ColliderDef as_sensor{.sensor = true};

struct SleepingBox {
    World world = make_world();
    BodyId ground = add_ground(world);
    BodyId box = add(world, {.position = {0, 0.5, 0}}, Box{});
    SleepingBox() {
        run(world, 3);
        EXPECT_FALSE(state(world, box).awake);
    }
};
TEST(Events, a_sensor_made_over_a_sleeper_reports_it_and_wakes_nobody) {
    SleepingBox t;
    add(t.world, {.kind = BodyKind::Static, .position = {0, 1, 0}}, zone, as_sensor);
    EXPECT_EQ(count_sensor_events(t.world), (SensorCount{1, 0}));
    EXPECT_FALSE(state(t.world, t.box).awake);
}
TEST(Events, a_sensor_moved_off_a_sleeper_by_two_centimetres_reports_the_end) {
    SleepingBox t;
    const BodyId sensor = add(t.world, {.kind = BodyKind::Static, .position = {0, 1, 0}}, zone, as_sensor);
    EXPECT_EQ(count_sensor_events(t.world), (SensorCount{1, 0}));
    opened(t.world.set_pose(sensor, {{2.52, 1, 0}, {}}));
    EXPECT_EQ(count_sensor_events(t.world), (SensorCount{0, 1}));
    opened(t.world.set_pose(sensor, {{20, 1, 0}, {}}));
    EXPECT_EQ(count_sensor_events(t.world), (SensorCount{0, 0}));
    opened(t.world.set_pose(sensor, {{0, 1, 0}, {}}));
    EXPECT_EQ(count_sensor_events(t.world), (SensorCount{1, 0}));
    opened(t.world.remove_body(sensor));
    EXPECT_EQ(count_sensor_events(t.world), (SensorCount{0, 1}));
}
TEST(Events, a_sensor_added_to_a_static_body_reports_the_sleeper_in_it) {
    SleepingBox t;
    const BodyId pillar = add(t.world, {.kind = BodyKind::Static, .position = {0, 0.5, 5}}, Box{});
    run(t.world, 1);
    opened(t.world.add_collider(pillar, Box{{0.5f, 0.5f, 6}}, as_sensor));
    EXPECT_EQ(count_sensor_events(t.world), (SensorCount{1, 0}));
}
TEST(Events, filters_of_sensors_over_sleepers_begin_and_end_visits) {
    SleepingBox t;
    const BodyId sensor = add(t.world, {.kind = BodyKind::Static, .position = {0, 1, 0}}, zone, as_sensor);
    EXPECT_EQ(count_sensor_events(t.world), (SensorCount{1, 0}));
    const ColliderId collider = t.world.colliders_of(sensor)[0];
    opened(t.world.set_filter(collider, {.category = 1, .mask = 0}));
    EXPECT_EQ(count_sensor_events(t.world), (SensorCount{0, 1}));
    opened(t.world.set_filter(collider, {}));
    EXPECT_EQ(count_sensor_events(t.world), (SensorCount{1, 0}));
}
TEST(Events, a_body_made_asleep_inside_a_sensor_is_reported) {
    World world = make_world();
    add_ground(world);
    add(world, {.kind = BodyKind::Static, .position = {0, 1, 0}}, zone, as_sensor);
    add(world, {.position = {0, 0.5, 0}, .awake = false}, Box{});
    EXPECT_EQ(count_sensor_events(world), (SensorCount{1, 0}));
}
TEST(Events, a_sensor_moved_onto_a_resting_kinematic_body_reports_it) {
    World world = make_world();
    const BodyId sensor = add(world, {.kind = BodyKind::Static}, zone, as_sensor);
    const BodyId lift = add(world, {.kind = BodyKind::Kinematic, .position = {9, 0, 0}}, Box{});
    EXPECT_EQ(count_sensor_events(world), (SensorCount{0, 0}));
    opened(world.set_pose(sensor, {{9, 0, 0}, {}}));
    EXPECT_EQ(count_sensor_events(world), (SensorCount{1, 0}));
    opened(world.set_pose(lift, {{11.6, 0, 0}, {}}));
    EXPECT_EQ(count_sensor_events(world), (SensorCount{0, 1}));
}
TEST(Events, a_body_made_asleep_begins_and_ends_its_contacts) {
    World world = make_world();
    const BodyId floor = add(world, {.kind = BodyKind::Static, .position = {0, -0.5, 0}}, Box{{5, 0.5f, 5}});
    add(world, {.position = {0, 0.5, 0}, .awake = false}, Box{});
    ASSERT_TRUE(world.step());
    EXPECT_EQ(world.events().contacts_begun.size(), 1u);
    std::vector<ContactState> contacts;
    world.read_contacts(contacts);
    EXPECT_EQ(contacts.size(), 1u);
    opened(world.remove_body(floor));
    ASSERT_TRUE(world.step());
    EXPECT_EQ(world.events().contacts_ended.size(), 1u);
}

}  // namespace
}  // namespace fase
