// Calls that a world rejects, and that a rejected call changes nothing.
#include <cmath>
#include <limits>

#include "tests/world/worlds.hpp"

namespace fase {
namespace {

using namespace test;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr float inf = std::numeric_limits<float>::infinity();
constexpr double nan_d = std::numeric_limits<double>::quiet_NaN();

class Refusals : public testing::Test {
protected:
    World world = make_world();
    BodyId ground = add_ground(world);
    BodyId box = add(world, {.position = {0, 0.6, 0}}, Box{});
    std::uint64_t before = 0;
    void SetUp() override {
        run(world, 0.1);
        before = world.hash();
    }
    /// Expects that the call failed with this status, named the field, and left the world unchanged.
    template <class T> void expect_refused(const Result<T>& result, Status status, const char* field) {
        ASSERT_FALSE(result) << field;
        EXPECT_EQ(result.status(), status) << field;
        EXPECT_NE(result.error().text().find(field), std::string::npos) << result.error().text();
        EXPECT_EQ(result.error().text().find('\n'), std::string::npos);
        EXPECT_EQ(world.hash(), before) << field;
    }
};

TEST_F(Refusals, numbers_that_are_not_finite) {
    for (const double bad : {nan_d, double(inf), -double(inf), 2e7}) {
        expect_refused(world.add_body({.position = {0, bad, 0}}), Status::BadArgument, "BodyDef.position");
        expect_refused(world.set_pose(box, {{bad, 0, 0}, {}}), Status::BadArgument, "position");
        expect_refused(world.apply_impulse_at(box, {1, 0, 0}, {0, 0, bad}), Status::BadArgument, "point");
    }
    for (const float bad : {nan, inf, -inf}) {
        expect_refused(world.add_body({.linear_velocity = {bad, 0, 0}}), Status::BadArgument, "linear_velocity");
        expect_refused(world.add_body({.angular_velocity = {0, bad, 0}}), Status::BadArgument, "angular_velocity");
        expect_refused(world.add_body({.linear_damping = bad}), Status::BadArgument, "linear_damping");
        expect_refused(world.add_body({.gravity_scale = bad}), Status::BadArgument, "gravity_scale");
        expect_refused(world.add_body({.rotation = {bad, 0, 0, 1}}), Status::BadArgument, "rotation");
        expect_refused(world.add_body({}, Sphere{bad}), Status::BadArgument, "radius");
        expect_refused(world.add_body({}, Box{{1, bad, 1}}), Status::BadArgument, "half");
        expect_refused(world.add_body({}, Capsule{1, bad}), Status::BadArgument, "half_length");
        expect_refused(world.add_body({}, Cylinder{bad, 1}), Status::BadArgument, "radius");
        expect_refused(world.add_body({}, Sphere{}, {.density = bad}), Status::BadArgument, "density");
        expect_refused(world.add_body({}, Sphere{}, {.material = {.friction = bad}}), Status::BadArgument, "friction");
        expect_refused(world.add_body({}, Sphere{}, {.material = {.restitution = bad}}), Status::BadArgument,
                       "restitution");
        expect_refused(world.set_velocity(box, {bad, 0, 0}, {}), Status::BadArgument, "linear");
        expect_refused(world.set_velocity(box, {}, {0, 0, bad}), Status::BadArgument, "angular");
        expect_refused(world.apply_force(box, {0, bad, 0}), Status::BadArgument, "newtons");
        expect_refused(world.apply_torque(box, {0, bad, 0}), Status::BadArgument, "torque");
        expect_refused(world.apply_impulse(box, {0, bad, 0}), Status::BadArgument, "impulse");
        expect_refused(world.step(bad), Status::BadArgument, "seconds");
        MassProperties mass{bad, {}, Mat3::identity()};
        expect_refused(world.set_mass(box, mass), Status::BadArgument, "mass");
    }
}

TEST_F(Refusals, impossible_sizes_masses_and_rotations) {
    for (const float bad : {0.0f, -1.0f}) {
        expect_refused(world.add_body({}, Sphere{bad}), Status::BadArgument, "radius");
        expect_refused(world.add_body({}, Box{{1, bad, 1}}), Status::BadArgument, "half");
        expect_refused(world.set_mass(box, MassProperties{bad, {}, Mat3::identity()}), Status::BadArgument, "mass");
    }
    expect_refused(world.add_body({}, Sphere{}, {.density = -1}), Status::BadArgument, "density");
    expect_refused(world.add_body({}, Sphere{}, {.material = {.friction = -1}}), Status::BadArgument, "friction");
    expect_refused(world.add_body({.rotation = {0, 0, 0, 0}}), Status::BadArgument, "rotation");
    expect_refused(world.add_body({.rotation = {0, 0, 0, 1.5f}}), Status::BadArgument, "rotation");
    // No rigid body has a moment larger than the sum of the other two.
    expect_refused(world.set_mass(box, MassProperties{1, {}, Mat3::diagonal({1, 1, 3})}), Status::BadArgument, "mass");
    expect_refused(world.set_mass(box, MassProperties{1, {}, Mat3::diagonal({1, -1, 1})}), Status::BadArgument, "mass");
    expect_refused(world.add_body({}, HalfSpace{}), Status::BadArgument, "half-space");
    expect_refused(world.add_body({}, ConvexHull{}), Status::BadArgument, "hull");
    expect_refused(world.apply_force(ground, {1, 0, 0}), Status::BadArgument, "apply_force");
    expect_refused(world.set_velocity(ground, {1, 0, 0}, {}), Status::BadArgument, "set_velocity");
    expect_refused(world.move_kinematic(box, {}, 0.1f), Status::BadArgument, "kinematic");
    expect_refused(world.exclude_pair(box, box), Status::BadArgument, "exclude_pair");
    for (const float bad : {-1.0f, 1e9f}) expect_refused(world.step(bad), Status::BadArgument, "seconds");
    expect_refused(world.apply_impulse(box, {3e38f, 3e38f, 3e38f}), Status::BadArgument, "impulse");
}

TEST_F(Refusals, a_rotation_of_almost_unit_length_is_normalised) {
    const auto body = world.add_body({.rotation = {0, 0, 0, 1.005f}});
    ASSERT_TRUE(body);
    EXPECT_EQ(state(world, *body).pose.rotation, Quat{});
}

TEST_F(Refusals, ids_that_are_stale_foreign_or_random) {
    World other = make_world();
    const BodyId foreign = add(other, {}, Sphere{});
    const BodyId removed = add(world, {.position = {50, 0, 0}}, Sphere{});
    const ColliderId stale = world.colliders_of(removed)[0];
    ASSERT_TRUE(world.remove_body(removed));
    run(world, 0.1);
    const BodyId reused = add(world, {.position = {60, 0, 0}}, Sphere{});
    EXPECT_EQ(reused.index, removed.index);
    before = world.hash();
    Random random(5);
    std::vector<BodyId> bad{foreign, removed, BodyId{}, BodyId{0xfffffffe, 1, box.owner}};
    for (int i = 0; i < 1000; ++i)
        bad.push_back({static_cast<std::uint32_t>(random.next()), static_cast<std::uint16_t>(random.next()),
                       static_cast<std::uint16_t>(random.next())});
    for (const BodyId id : bad) {
        EXPECT_FALSE(world.contains(id));
        expect_refused(world.body(id), Status::BadHandle, "body");
        expect_refused(world.remove_body(id), Status::BadHandle, "remove_body");
        expect_refused(world.set_pose(id, {}), Status::BadHandle, "set_pose");
        expect_refused(world.set_velocity(id, {}, {}), Status::BadHandle, "set_velocity");
        expect_refused(world.apply_force(id, {}), Status::BadHandle, "apply_force");
        expect_refused(world.apply_impulse(id, {}), Status::BadHandle, "apply_impulse");
        expect_refused(world.add_collider(id, Sphere{}), Status::BadHandle, "add_collider");
        expect_refused(world.set_kind(id, BodyKind::Static), Status::BadHandle, "set_kind");
        expect_refused(world.wake(id), Status::BadHandle, "wake");
        expect_refused(world.exclude_pair(id, box), Status::BadHandle, "exclude_pair");
        EXPECT_TRUE(world.colliders_of(id).empty());
    }
    expect_refused(world.collider(stale), Status::BadHandle, "collider");
    expect_refused(world.remove_collider(stale), Status::BadHandle, "remove_collider");
}

TEST_F(Refusals, texts_name_the_call_the_axis_and_the_value) {
    const auto text = [](const auto& result) { return result ? std::string("no error") : result.error().text(); };
    EXPECT_EQ(text(world.add_body({.position = {0, nan_d, 0}})),
              "BodyDef.position.y: found nan, not a finite number; expected -1e7 to 1e7 m");
    EXPECT_EQ(text(world.set_pose(box, {{0, 0, -2e7}, {}})),
              "World::set_pose: position.z: found -20000000; expected -1e7 to 1e7 m");
    EXPECT_EQ(text(world.set_velocity(box, {0, nan, 0}, {})),
              "World::set_velocity: linear_velocity.y: found nan, not a finite number; expected at most 1e7 m/s");
    EXPECT_EQ(text(world.set_velocity(box, {}, {0, 0, -inf})),
              "World::set_velocity: angular_velocity.z: found -inf, not a finite number; expected at most 1e6 rad/s");
    EXPECT_EQ(text(world.set_velocity(box, {3e7f, 4e7f, 0}, {})),
              "World::set_velocity: linear_velocity: found 50000000 m/s; expected at most 1e7 m/s");
    EXPECT_EQ(text(world.apply_impulse_at(box, {1, 0, 0}, {nan_d, 0, 0})),
              "World::apply_impulse_at: point.x: found nan, not a finite number; expected -1e7 to 1e7 m");
    EXPECT_TRUE(text(world.apply_force_at(box, {0, 0, nan}, {})).starts_with("World::apply_force_at: newtons.z: "));
    EXPECT_TRUE(text(world.apply_torque(box, {0, nan, 0})).starts_with("World::apply_torque: newton_metres.y: "));
    EXPECT_TRUE(text(world.add_body({}, HalfSpace{})).starts_with("World::add_body: found a half-space"));
    EXPECT_TRUE(text(world.add_collider(box, HalfSpace{})).starts_with("World::add_collider: found a half-space"));
    const std::vector<ColliderShape> parts{{Sphere{}}, {HalfSpace{}}};
    EXPECT_TRUE(text(world.add_body({}, parts)).starts_with("World::add_body: colliders[1]: found a half-space"));
    EXPECT_TRUE(text(world.set_mass(box, MassProperties{0, {}, Mat3::identity()}))
                    .starts_with("World::set_mass: mass: found 0; expected"));
    Settings settings;
    settings.gravity.y = nan;
    EXPECT_EQ(text(world.set_settings(settings)),
              "Settings.gravity.y: found nan, not a finite number; expected -1e6 to 1e6 m/s²");
    const BodyId lift = add(world, {.kind = BodyKind::Kinematic, .position = {9, 5, 0}}, Box{});
    EXPECT_TRUE(text(world.move_kinematic(lift, {{1e6, 5, 0}, {}}, 0.001f))
                    .starts_with("World::move_kinematic: linear_velocity: found "));
}

TEST_F(Refusals, texts_tell_why_an_id_is_not_valid) {
    World other = make_world();
    add_ground(other);
    const BodyId foreign = add(other, {}, Sphere{});
    const auto [removed, part] = *world.add_body({.position = {50, 0, 0}}, Sphere{});
    ASSERT_TRUE(world.remove_body(removed));
    const auto text = [&](BodyId id) { return world.wake(id).error().text(); };
    EXPECT_TRUE(text({}).starts_with("World::wake: found the default id, which names no body; "));
    EXPECT_TRUE(text(foreign).starts_with("World::wake: found the id of a body of another world (index 1); "));
    EXPECT_TRUE(text(removed).starts_with("World::wake: found the id of a body that was removed (index 2); "));
    for (const BodyId never : {BodyId{7, 1, box.owner}, BodyId{box.index, 2, box.owner}, BodyId{0, 0, box.owner}})
        EXPECT_TRUE(text(never).starts_with("World::wake: found an id that this world never issued (index "));
    EXPECT_TRUE(world.remove_collider(part).error().text().starts_with(
        "World::remove_collider: found the id of a collider that was removed (index 2); "));
    EXPECT_TRUE(world.exclude_pair(box, removed).error().text().starts_with("World::exclude_pair: b: found the id"));
}

TEST_F(Refusals, a_sleeping_body_with_a_velocity) {
    expect_refused(world.add_body({.linear_velocity = {1, 0, 0}, .awake = false}, Sphere{}), Status::BadArgument,
                   "BodyDef.awake: found false, with a velocity that is not 0");
    expect_refused(world.add_body({.kind = BodyKind::Kinematic, .angular_velocity = {0, 1, 0}, .awake = false}),
                   Status::BadArgument, "BodyDef.awake");
    EXPECT_TRUE(world.add_body({.awake = false}, Sphere{}));
}

TEST_F(Refusals, settings_out_of_range) {
    const auto with = [&](auto change, const char* field) {
        Settings settings = world.settings();
        change(settings);
        expect_refused(world.set_settings(settings), Status::BadArgument, field);
        EXPECT_EQ(World::create(settings).status(), Status::BadArgument) << field;
    };
    with([](Settings& s) { s.sub_steps = 0; }, "sub_steps");
    with([](Settings& s) { s.sub_steps = 65; }, "sub_steps");
    with([](Settings& s) { s.time_step = 0; }, "time_step");
    with([](Settings& s) { s.time_step = nan; }, "time_step");
    with([](Settings& s) { s.gravity.y = inf; }, "gravity");
    with([](Settings& s) { s.contact_frequency = -1; }, "contact_frequency");
    with([](Settings& s) { s.max_pairs = -1; }, "max_pairs");
    EXPECT_EQ(World::create({}, {.structure = "no_such_tree"}).status(), Status::BadArgument);
    EXPECT_NE(World::create({}, {.structure = "no_such_tree"}).error().text().find("dynamic_bvh"), std::string::npos);
    EXPECT_EQ(World::create({}, {.threads = -1}).status(), Status::BadArgument);
}

TEST_F(Refusals, a_step_of_no_time_moves_nothing) {
    const Vec3d at = state(world, box).pose.position;
    ASSERT_TRUE(world.step(0));
    EXPECT_EQ(state(world, box).pose.position, at);
}

TEST_F(Refusals, a_force_that_makes_a_speed_infinite_quarantines_only_its_body) {
    World twin = make_world();
    add_ground(twin);
    add(twin, {.position = {0, 0.6, 0}}, Box{});
    run(twin, 0.1);
    const MassProperties light{1e-6f, {}, Mat3::diagonal({1e-6f, 1e-6f, 1e-6f})};
    const BodyId bad = add(world, {.position = {0, 3, 0}, .mass = light}, Sphere{});
    ASSERT_TRUE(world.apply_force(bad, {1e20f, 0, 0}));
    const auto report = world.step();
    ASSERT_TRUE(report);
    EXPECT_EQ(report->quarantined, 1u);
    EXPECT_TRUE(state(world, bad).quarantined);
    EXPECT_EQ(state(world, bad).pose.position, (Vec3d{0, 3, 0}));
    run(world, 1);
    run(twin, 1 + 1.0 / 60);
    EXPECT_EQ(state(world, box).pose.position, state(twin, twin.bodies()[1]).pose.position);
}

TEST_F(Refusals, a_quarantined_body_rests_whatever_kind_it_becomes) {
    const MassProperties light{1e-6f, {}, Mat3::diagonal({1e-6f, 1e-6f, 1e-6f})};
    const BodyId bad = add(world, {.position = {0, 3, 0}, .mass = light}, Sphere{});
    ASSERT_TRUE(world.apply_force(bad, {1e20f, 0, 0}));
    ASSERT_TRUE(world.step());
    for (const BodyKind kind : {BodyKind::Static, BodyKind::Dynamic, BodyKind::Kinematic, BodyKind::Dynamic}) {
        ASSERT_TRUE(world.set_kind(bad, kind));
        if (kind != BodyKind::Static) {
            ASSERT_TRUE(world.set_velocity(bad, {1, 0, 0}, {}));
        }
        run(world, 0.5);
        EXPECT_FALSE(state(world, bad).awake);
        EXPECT_TRUE(state(world, bad).quarantined);
        EXPECT_EQ(state(world, bad).pose.position, (Vec3d{0, 3, 0}));
    }
}

TEST_F(Refusals, speeds_above_the_limit_are_clamped_and_counted) {
    ASSERT_TRUE(world.set_velocity(box, {1e6f, 1e6f, 0}, {0, 1e4f, 0}));
    const auto report = world.step();
    ASSERT_TRUE(report);
    EXPECT_EQ(report->speed_clamped, 1u);
    EXPECT_LE(length(state(world, box).linear_velocity), 1000.1f);
    EXPECT_LE(length(state(world, box).angular_velocity), 1000.1f);
}

TEST_F(Refusals, pairs_beyond_the_limit_are_dropped_and_counted) {
    Settings settings;
    settings.max_pairs = 1000;
    World crowd = make_world(settings);
    for (int i = 0; i < 300; ++i) add(crowd, {.position = {0, 5, 0}}, Sphere{});
    const auto report = crowd.step();
    ASSERT_TRUE(report);
    EXPECT_LE(report->pairs, 1000u);
    EXPECT_GT(report->pairs_dropped, 0u);
    World again = make_world(settings, {.structure = "brute_force"});
    for (int i = 0; i < 300; ++i) add(again, {.position = {0, 5, 0}}, Sphere{});
    ASSERT_TRUE(again.step());
    EXPECT_EQ(again.hash(), crowd.hash());
}

TEST_F(Refusals, a_step_inside_a_step_is_rejected) {
    struct SteppingRunner final : TaskRunner {
        World* world = nullptr;
        Status status = Status::Ok;
        void run(std::size_t count, const std::function<void(std::size_t)>& chunk) override {
            if (world != nullptr) status = world->step().status();
            for (std::size_t i = 0; i < count; ++i) chunk(i);
        }
        [[nodiscard]] int threads() const override { return 2; }
    } runner;
    World inner = make_world({}, {.tasks = &runner});
    add_pile(inner, 200);
    runner.world = &inner;
    run(inner, 1);
    EXPECT_EQ(runner.status, Status::Busy);
}

}  // namespace
}  // namespace fase
