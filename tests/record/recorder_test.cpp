/// Tests that a recording matches the world: poses, sleep, islands, events, contacts, added and removed bodies.
#include "fase/record/recorder.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <map>

#include "fase/geometry/hull_builder.hpp"
#include "fase/record/player.hpp"
#include "tests/record/artificial_run.hpp"

namespace fase::record {
namespace {

/// A scene with ground, a tower, a ball that hits it, and a sensor.
struct Scene {
    World world = std::move(*World::create());
    BodyId ground, ball, zone;
    std::vector<BodyId> boxes;

    Scene() {
        ground = *world.add_body({.kind = BodyKind::Static, .user = 7}, HalfSpace{});
        for (int i = 0; i < 5; ++i) {
            boxes.push_back(*world.add_body({.position = {0, 0.5 + i, 0}, .user = 100u + static_cast<unsigned>(i)},
                                            Box{{0.5f, 0.5f, 0.5f}}));
        }
        ball = *world.add_body({.position = {-6, 1.5, 0.2}, .linear_velocity = {12, 1, 0}}, Sphere{0.4f});
        zone =
            *world.add_body({.kind = BodyKind::Static, .position = {-3, 1.5, 0}}, Box{{0.5f, 2, 2}}, {.sensor = true});
    }
};

/// The expected content of a frame, read from the world.
struct Expected {
    std::vector<BodyState> bodies;
    Events events;
    StepReport report;
    std::vector<ContactState> contacts;
};
Expected expected_of(const World& world) {
    Expected expected;
    world.read_bodies(expected.bodies);
    expected.events = world.events();
    expected.report = world.last_report();
    world.read_contacts(expected.contacts);
    std::erase_if(expected.contacts, [](const ContactState& contact) { return contact.sensor; });
    return expected;
}

std::uint64_t key(std::uint32_t index, std::uint16_t generation) { return std::uint64_t(index) << 16 | generation; }

void expect_same(const Frame& frame, const Expected& expected, const Tables& tables) {
    std::map<std::uint64_t, const BodyFrame*> by_id;
    for (const BodyFrame& body : frame.bodies) {
        by_id[key(tables.bodies[body.row].index, tables.bodies[body.row].generation)] = &body;
    }
    ASSERT_EQ(by_id.size(), expected.bodies.size());
    for (const BodyState& state : expected.bodies) {
        const auto found = by_id.find(key(state.id.index, state.id.generation));
        ASSERT_NE(found, by_id.end());
        const BodyFrame& body = *found->second;
        EXPECT_LT(length(body.pose.position - state.pose.position), 0.001);
        EXPECT_LT(degrees_between(body.pose.rotation, state.pose.rotation), 0.1);
        EXPECT_EQ(body.awake, state.awake);
        EXPECT_EQ(body.island, state.island + 1);
        EXPECT_EQ(body.kind, static_cast<std::uint8_t>(state.kind));
        EXPECT_EQ(tables.bodies[body.row].user, state.user);
    }
    const auto expect_pairs = [&](const auto& pairs, const auto& events, auto a, auto b) {
        ASSERT_EQ(pairs.size(), events.size());
        for (std::size_t i = 0; i < pairs.size(); ++i) {
            EXPECT_EQ(tables.colliders[pairs[i].a].index, (events[i].*a).index);
            EXPECT_EQ(tables.colliders[pairs[i].b].index, (events[i].*b).index);
        }
    };
    expect_pairs(frame.contacts_begun, expected.events.contacts_begun, &ContactEvent::a, &ContactEvent::b);
    expect_pairs(frame.sensors_begun, expected.events.sensors_begun, &SensorEvent::sensor, &SensorEvent::visitor);
    expect_pairs(frame.sensors_ended, expected.events.sensors_ended, &SensorEvent::sensor, &SensorEvent::visitor);
    expect_pairs(frame.hits, expected.events.hits, &HitEvent::a, &HitEvent::b);
    for (std::size_t i = 0; i < frame.hits.size(); ++i)
        EXPECT_EQ(frame.hits[i].impulse, expected.events.hits[i].impulse);
    ASSERT_EQ(frame.contacts.size(), expected.contacts.size());
    for (std::size_t i = 0; i < frame.contacts.size(); ++i) {
        EXPECT_EQ(frame.contacts[i].count, expected.contacts[i].count);
        EXPECT_EQ(frame.contacts[i].normal, expected.contacts[i].normal);
        EXPECT_EQ(frame.contacts[i].separations[0], expected.contacts[i].separations[0]);
    }
    EXPECT_EQ(frame.step, expected.report.step);
    EXPECT_EQ(frame.total_ms, static_cast<float>(expected.report.total_ms));
    EXPECT_EQ(frame.counters[0], expected.report.bodies);
}

TEST(Recorder, FramesMatchTheWorld) {
    const TemporaryFolder folder;
    Scene scene;
    RecordingHead head;
    head.title = "a tower";
    head.meshes.push_back({{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {}, {{0, 1, 2}}});
    head.looks.push_back({scene.ball, "ball", {200, 10, 20, 255}, {{0, {{0, 1, 0}, {}}, {1, 2, 3, 255}}}});
    RecorderOptions options;
    options.contacts = true;
    Result<Recorder> recorder = Recorder::create(folder / "run.faserec", scene.world, head, options);
    ASSERT_TRUE(recorder) << recorder.error().text();
    std::vector<Expected> expected;
    const std::vector<Vec3> corners{{-0.5f, -0.5f, -0.5f}, {0.5f, -0.5f, -0.5f}, {0, -0.5f, 0.5f}, {0, 0.6f, 0}};
    for (int k = 0; k < 300; ++k) {
        if (k != 0) {
            ASSERT_TRUE(scene.world.step());
        }
        if (k == 40) {
            ASSERT_TRUE(scene.world.remove_body(scene.boxes[4]));
        }
        if (k == 41) {  // reuses its slot
            ASSERT_TRUE(scene.world.add_body({.position = {3, 8, 0}, .user = 999}, *build_convex_hull(corners)));
        }
        if (k == 50) {
            ASSERT_TRUE(scene.world.set_pose(scene.ball, {{500, 2, 0}, {}}));
        }
        ASSERT_TRUE((*recorder).add_frame(scene.world));
        expected.push_back(expected_of(scene.world));
    }
    ASSERT_TRUE((*recorder).finish());
    Result<Player> player = Player::open(folder / "run.faserec");
    ASSERT_TRUE(player) << player.error().text();
    EXPECT_TRUE((*player).complete());
    ASSERT_EQ((*player).frames(), 300u);
    const Tables& tables = (*player).tables();
    EXPECT_EQ(tables.head.title, "a tower");
    EXPECT_EQ(tables.head.time_step, scene.world.settings().time_step);
    EXPECT_EQ(tables.head.stage_names.size(), stage_count);
    EXPECT_EQ(tables.bodies.size(), 9u);  // eight, and the one that reuses a slot
    EXPECT_EQ(tables.shapes.size(), 5u);  // half-space, box, ball, zone, hull; the boxes share one
    ASSERT_EQ(tables.visuals.size(), 1u);
    EXPECT_EQ(tables.bodies[tables.visuals[0].body].name, "ball");
    std::size_t hits = 0, sensed = 0, asleep = 0;
    Frame frame;
    for (std::uint64_t k = 0; k < 300; ++k) {
        const Result<void> read = (*player).read(k, frame);
        ASSERT_TRUE(read) << read.error().text();
        expect_same(frame, expected[k], tables);
        hits += frame.hits.size();
        sensed += frame.sensors_begun.size() + frame.sensors_ended.size();
        for (const BodyFrame& body : frame.bodies) asleep += body.kind == 2 && !body.awake ? 1 : 0;
    }
    EXPECT_GT(hits, 0u);
    EXPECT_GE(sensed, 2u);
    EXPECT_GT(asleep, 0u);
}

TEST(Recorder, ColliderChangesTakeEffectFromTheNextBlockOn) {
    const TemporaryFolder folder;
    Scene scene;
    RecorderOptions options;
    options.flush_frames = 4;
    Result<Recorder> recorder = Recorder::create(folder / "run.faserec", scene.world, {}, options);
    ASSERT_TRUE(recorder);
    ColliderId knob;
    for (int k = 0; k < 24; ++k) {
        ASSERT_TRUE(scene.world.step());
        if (k == 5) knob = *scene.world.add_collider(scene.boxes[0], Sphere{0.2f}, {.pose = {{0, 0, 1}, {}}});
        if (k == 14) {
            ASSERT_TRUE(scene.world.remove_collider(knob));
        }
        ASSERT_TRUE((*recorder).add_frame(scene.world));
    }
    ASSERT_TRUE((*recorder).finish());
    const Result<Player> player = Player::open(folder / "run.faserec");
    ASSERT_TRUE(player);
    const auto& colliders = (*player).tables().colliders;
    ASSERT_EQ(colliders.size(), 9u);
    EXPECT_EQ(colliders[8].pose.position, (Vec3{0, 0, 1}));
    EXPECT_GE(colliders[8].first_frame, 5u);
    EXPECT_LE(colliders[8].first_frame, 8u);
    EXPECT_GE(colliders[8].end_frame, 14u);
    EXPECT_LE(colliders[8].end_frame, 16u);
}

TEST(Recorder, DoesNotChangeTheWorld) {
    const TemporaryFolder folder;
    Scene recorded, unrecorded;
    Result<Recorder> recorder = Recorder::create(folder / "run.faserec", recorded.world);
    ASSERT_TRUE(recorder);
    for (int k = 0; k < 60; ++k) {
        ASSERT_TRUE(recorded.world.step());
        ASSERT_TRUE(unrecorded.world.step());
        ASSERT_TRUE((*recorder).add_frame(recorded.world));
        ASSERT_EQ(recorded.world.hash(), unrecorded.world.hash());
    }
}

TEST(Recorder, FinishesWhenItIsDestroyed) {
    const TemporaryFolder folder;
    {
        Scene scene;
        Result<Recorder> recorder = Recorder::create(folder / "run.faserec", scene.world);
        ASSERT_TRUE(recorder);
        ASSERT_TRUE((*recorder).add_frame(scene.world));
    }
    const Result<Player> player = Player::open(folder / "run.faserec");
    ASSERT_TRUE(player);
    EXPECT_TRUE((*player).complete());
    EXPECT_EQ((*player).frames(), 1u);
}

TEST(Recorder, RejectsAVisualWithAMissingMesh) {
    const TemporaryFolder folder;
    Scene scene;
    RecordingHead head;
    head.looks.push_back({scene.ball, "ball", {}, {{3, {}, {}}}});
    EXPECT_EQ(Recorder::create(folder / "run.faserec", scene.world, head).status(), Status::BadArgument);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace fase::record
