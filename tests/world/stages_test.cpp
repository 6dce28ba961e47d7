// Stages of the step, each called alone with tables made by hand.
#include "fase/world/detail/stages.hpp"

#include <gtest/gtest.h>

#include "fase/geometry/bounds.hpp"
#include "fase/world/detail/collider_places.hpp"

namespace fase {
namespace {

/// What every stage is given: a step of a 60th of a second on one thread.
struct Given {
    Settings settings;
    StepReport report;
    std::unique_ptr<TaskRunner> tasks = make_thread_runner(1);
    StepContext context{settings, 1.0f / 60, 0, *tasks, report};
};

/// Awake dynamic bodies at the origin, without colliders.
BodyTable dynamic_bodies(std::uint32_t count) {
    BodyTable bodies;
    bodies.resize(count);
    for (std::uint32_t body = 0; body < count; ++body) {
        (void)bodies.ids.add();
        bodies.traits[body].kind = BodyKind::Dynamic;
        bodies.traits[body].motion_state = MotionState::Awake;
        bodies.awake.push_back(body);
    }
    return bodies;
}

/// One ball of 1 m on each body.
ColliderTable balls_on(BodyTable& bodies) {
    ColliderTable colliders;
    colliders.shapes = {{Sphere{1}, static_cast<std::uint32_t>(bodies.awake.size()), 1, 1}};
    for (const std::uint32_t body : bodies.awake) {
        (void)colliders.ids.add();
        colliders.all.push_back({.body = body});
        bodies.traits[body].first_collider = body;
        bodies.traits[body].inner_radius = 1;
    }
    return colliders;
}

TEST(Stages, refresh_gives_a_body_a_new_box_only_when_it_leaves_the_old_one) {
    Given given;
    BodyTable bodies = dynamic_bodies(1);
    const ColliderTable colliders = balls_on(bodies);
    BroadPhase broad_phase;
    broad_phase.boxes = {tight_box(bodies, colliders, 0)};
    broad_phase.changes = {0};
    QueryTrees query;
    Moved moved;
    const auto refresh = [&] { refresh_boxes(given.context, colliders, bodies, broad_phase, query, moved); };
    const float margin = given.settings.box_margin;

    const Aabb before = broad_phase.boxes[0];
    refresh();
    EXPECT_EQ(moved.colliders, std::vector<std::uint32_t>{0}) << "the first box had no speculative distance";
    EXPECT_EQ(moved.previous_boxes[0], before);
    EXPECT_EQ(broad_phase.changes[0], moved_box);
    EXPECT_EQ(given.report.boxes_moved, 1u);
    EXPECT_EQ(broad_phase.boxes[0],
              enlarged(speculative_box(bodies, colliders, 0, given.settings.speculative_distance), margin));

    const Aabb fat = broad_phase.boxes[0];
    broad_phase.changes[0] = 0;
    bodies.motion[0].position.x = 0.5 * double(margin);
    refresh();
    EXPECT_TRUE(moved.colliders.empty());
    EXPECT_EQ(broad_phase.boxes[0], fat);

    bodies.motion[0].linear_velocity = {2 * given.settings.max_linear_speed, 0, 0};
    refresh();
    EXPECT_EQ(moved.clamped, std::vector<std::uint32_t>{0});
    EXPECT_EQ(bodies.motion[0].linear_velocity.x, given.settings.max_linear_speed);
    EXPECT_GT(moved.sweep[0], 16) << "a fast body sweeps its path";
    EXPECT_GT(broad_phase.boxes[0].hi.x, fat.hi.x + 16);
    EXPECT_EQ(moved.previous_boxes[0], fat);
}

TEST(Stages, islands_are_the_awake_bodies_that_constraints_connect) {
    Given given;
    BodyTable bodies = dynamic_bodies(6);
    bodies.traits[5].kind = BodyKind::Kinematic;
    bodies.motion[5].linear_velocity = {1, 0, 0};
    for (dynamics::BodyMotion& motion : bodies.motion) motion.sleep_time = 1;
    const auto touch = [](std::uint32_t a, std::uint32_t b, dynamics::Moves moves, bool touches = true) {
        return dynamics::Constraint{.body_a = a, .body_b = b, .moves = moves, .touches = touches};
    };
    using enum dynamics::Moves;
    Constraints constraints;  // a row of bodies 1, 2 and 3; 0 is only near; 5 pushes 4
    constraints.all = {touch(0, 1, Both, false), touch(2, 3, Both), touch(1, 2, Both), touch(4, 5, A)};
    IslandLists lists;
    find_islands(given.context, constraints, bodies, lists);
    std::vector<std::uint32_t> islands;
    for (const dynamics::BodyMotion& motion : bodies.motion) islands.push_back(motion.island);
    EXPECT_EQ(islands, (std::vector<std::uint32_t>{0, 1, 1, 1, 4, 5})) << "named for the smallest body";
    EXPECT_EQ(given.report.islands, 4u);
    EXPECT_EQ(bodies.motion[4].sleep_time, 0) << "what a moving kinematic body touches does not rest";
    EXPECT_EQ(bodies.motion[3].sleep_time, 1);
}

TEST(Stages, events_tell_what_the_results_of_constraints_say) {
    const Settings settings;
    BodyTable bodies = dynamic_bodies(2);
    bodies.motion[1].position = {0, 2, 0};
    const ColliderTable colliders = balls_on(bodies);
    ContactTable contacts;
    contacts.active.append({0, 1}, add_contact(colliders, contacts, {0, 1}));
    contacts[0].manifolds = 1;
    contacts.manifolds.places(contacts[0])[0].normal = {0, 1, 0};
    Constraints constraints;
    constraints.all = {{.index = contacts[0].first_manifold, .body_b = 1}};
    constraints.results = {{.nearest = 0, .approach = 2, .impulse = 30, .pushes = true, .hit_offset_a = Vec3{0, 1, 0}}};
    Events events;
    publish_events(settings, colliders, constraints, bodies, contacts, events);
    const ContactEvent pair{event_collider(bodies, colliders, 0), event_collider(bodies, colliders, 1)};
    EXPECT_EQ(events.contacts_begun, std::vector{pair});
    ASSERT_EQ(events.hits.size(), 1u);
    EXPECT_EQ(events.hits[0].point, (Vec3d{0, 1, 0}));
    EXPECT_EQ(events.hits[0].normal, (Vec3{0, 1, 0}));
    EXPECT_EQ(events.hits[0].speed, 2);
    EXPECT_EQ(events.hits[0].impulse, 30);

    events.clear();
    constraints.results = {{.nearest = 1.5f * settings.linear_slop}};
    publish_events(settings, colliders, constraints, bodies, contacts, events);
    EXPECT_TRUE(events.contacts_ended.empty()) << "up to twice the slop they still touch";

    constraints.results = {{.nearest = 3 * settings.linear_slop}};
    bodies.motion[0].sleep_time = bodies.motion[1].sleep_time = 1;
    bodies.traits[1].motion_state = MotionState::Asleep;
    publish_events(settings, colliders, constraints, bodies, contacts, events);
    EXPECT_EQ(events.contacts_ended, std::vector{pair});
    EXPECT_TRUE(events.hits.empty());
    EXPECT_EQ(bodies.motion[0].sleep_time, 0) << "what is let go rests no longer";
    EXPECT_EQ(bodies.let_go, std::vector<std::uint32_t>{1}) << "the stage sleep wakes it";
}

}  // namespace
}  // namespace fase
