// Memory that runs out at the Nth allocation, for every N.
#include <functional>

#include "fase/broad/registry.hpp"
#include "fase/geometry/mesh.hpp"
#include "fase/world/query.hpp"
#include "tests/failing_memory.hpp"
#include "tests/world/worlds.hpp"

#ifndef FASE_TEST_SANITIZED
namespace fase {
namespace {

using namespace test;

std::vector<std::string> structures() {
    std::vector<std::string> names{"auto"};
    broad::for_each_structure([&]<class S>() { names.emplace_back(S::info.name); });
    return names;
}

/// Runs a call in which allocation number `n` fails, and returns its status.
template <class F> Status run_with_failure(long n, const F& call) {
    Status status = Status::Io;
    EXPECT_TRUE(run_with_failing_allocation(n, [&] { status = call(); }))
        << "an exception left the library at allocation " << n;
    return status;
}

World make_crowd(const std::string& structure, int steps) {
    World world = make_world({}, {.structure = structure});
    add_ground(world);
    for (int i = 0; i < 10; ++i)
        add(world, {.position = {0.1 * i, 0.5 + i, 0}}, i % 2 ? Shape(Box{}) : Shape(Sphere{0.5f}));
    add(world, {.kind = BodyKind::Kinematic, .position = {9, 0, 0}}, Box{});
    add(world, {.position = {20, 0.5, 0}, .awake = false}, Box{});
    add(world, {.kind = BodyKind::Static, .position = {20, 0.5, 0}}, Box{{2, 1, 2}}, {.sensor = true});
    for (int i = 0; i < steps; ++i) EXPECT_TRUE(world.step());
    return world;
}

/// A crowd, and some of its ids: lists of ids need memory, too.
struct Scene {
    World world;
    BodyId ground, body, platform, sleeper;
    ColliderId part, sleeping_part, ground_part;
    explicit Scene(const std::string& structure) : world(make_crowd(structure, 3)) {
        const std::vector<BodyId> all = world.bodies();
        ground = all[0];
        body = all[3];
        platform = all[11];
        sleeper = all[12];
        ground_part = world.colliders_of(ground)[0];
        part = world.colliders_of(body)[0];
        sleeping_part = world.colliders_of(sleeper)[0];
        EXPECT_TRUE(world.exclude_pair(platform, sleeper));
        EXPECT_TRUE(world.set_velocity(body, {1, 2, 3}, {}));
    }
};

struct Call {
    const char* name;
    std::function<Status(Scene&)> run;
};

class OutOfMemory : public testing::TestWithParam<std::string> {};

TEST_P(OutOfMemory, a_failed_edit_changes_nothing_and_the_next_one_works) {
    const Shape cylinder = Cylinder{0.31f, 0.2f};
    const std::vector<ColliderShape> compound{{cylinder}, {Box{}, {.sensor = true}}, {Sphere{0.37f}}, {cylinder}};
    const TriangleMesh surface = triangles(Sphere{1});
    const Shape mesh = Mesh{*CollisionMesh::build(surface.positions, surface.indices)};
    std::vector<std::byte> saved, foreign;
    const std::vector<Call> calls{
        {"add_body",
         [&](Scene& s) {
             return s.world.add_body({.position = {3, 1, 0}}).status();
         }},
        {"add_body with a shape", [&](Scene& s) { return s.world.add_body({}, cylinder).status(); }},
        {"CollisionMesh::build",
         [&](Scene&) { return CollisionMesh::build(surface.positions, surface.indices).status(); }},
        {"add_body with a mesh", [&](Scene& s) { return s.world.add_body({.kind = BodyKind::Static}, mesh).status(); }},
        {"add_body asleep", [&](Scene& s) { return s.world.add_body({.awake = false}, cylinder).status(); }},
        {"add_body with many shapes", [&](Scene& s) { return s.world.add_body({}, compound).status(); }},
        {"add_body with many shapes asleep",
         [&](Scene& s) { return s.world.add_body({.awake = false}, compound).status(); }},
        {"add_collider", [&](Scene& s) { return s.world.add_collider(s.body, cylinder).status(); }},
        {"add_collider asleep", [&](Scene& s) { return s.world.add_collider(s.sleeper, Box{}).status(); }},
        {"remove_collider", [&](Scene& s) { return s.world.remove_collider(s.part).status(); }},
        {"remove_body", [&](Scene& s) { return s.world.remove_body(s.body).status(); }},
        {"set_settings", [&](Scene& s) { return s.world.set_settings({.sleep = false}).status(); }},
        {"set_settings that disturb",
         [&](Scene& s) {
             return s.world.set_settings({.gravity = {0, -5, 0}}).status();
         }},
        {"set_pose",
         [&](Scene& s) {
             return s.world.set_pose(s.sleeper, {{1, 5, 0}, {}}).status();
         }},
        {"set_velocity",
         [&](Scene& s) {
             return s.world.set_velocity(s.sleeper, {1, 5, 0}, {}).status();
         }},
        {"move_kinematic",
         [&](Scene& s) {
             return s.world.move_kinematic(s.platform, {{9, 1, 0}, {}}, 0.1f).status();
         }},
        {"set_kind", [&](Scene& s) { return s.world.set_kind(s.body, BodyKind::Static).status(); }},
        {"set_kind to dynamic", [&](Scene& s) { return s.world.set_kind(s.platform, BodyKind::Dynamic).status(); }},
        {"set_kind of what lies asleep",
         [&](Scene& s) { return s.world.set_kind(s.sleeper, BodyKind::Kinematic).status(); }},
        {"set_kind of the ground", [&](Scene& s) { return s.world.set_kind(s.ground, BodyKind::Kinematic).status(); }},
        {"set_mass",
         [&](Scene& s) {
             return s.world.set_mass(s.body, MassProperties{2, {}, Mat3::identity()}).status();
         }},
        {"set_mass back", [&](Scene& s) { return s.world.set_mass(s.sleeper, std::nullopt).status(); }},
        {"set_damping", [&](Scene& s) { return s.world.set_damping(s.body, 1, 1).status(); }},
        {"set_gravity_scale", [&](Scene& s) { return s.world.set_gravity_scale(s.sleeper, 2).status(); }},
        {"set_locks", [&](Scene& s) { return s.world.set_locks(s.sleeper, {true}).status(); }},
        {"set_can_sleep", [&](Scene& s) { return s.world.set_can_sleep(s.sleeper, false).status(); }},
        {"wake", [&](Scene& s) { return s.world.wake(s.sleeper).status(); }},
        {"set_material", [&](Scene& s) { return s.world.set_material(s.sleeping_part, {.friction = 1}).status(); }},
        {"set_material of the ground",
         [&](Scene& s) { return s.world.set_material(s.ground_part, {.friction = 1}).status(); }},
        {"set_filter", [&](Scene& s) { return s.world.set_filter(s.sleeping_part, {.mask = 6}).status(); }},
        {"include_pair", [&](Scene& s) { return s.world.include_pair(s.platform, s.sleeper).status(); }},
        {"exclude_pair", [&](Scene& s) { return s.world.exclude_pair(s.body, s.sleeper).status(); }},
        {"apply_force",
         [&](Scene& s) {
             return s.world.apply_force(s.sleeper, {1, 0, 0}).status();
         }},
        {"apply_torque",
         [&](Scene& s) {
             return s.world.apply_torque(s.sleeper, {1, 0, 0}).status();
         }},
        {"apply_impulse",
         [&](Scene& s) {
             return s.world.apply_impulse(s.sleeper, {1, 0, 0}).status();
         }},
        {"apply_angular_impulse",
         [&](Scene& s) {
             return s.world.apply_angular_impulse(s.sleeper, {1, 0, 0}).status();
         }},
        {"restore", [&](Scene& s) { return s.world.restore(saved).status(); }},
        {"restore another world's", [&](Scene& s) { return s.world.restore(foreign).status(); }},
        {"cast_ray",
         [&](Scene& s) {
             return cast_ray(s.world, {{0, 20, 0}, {0, -1, 0}, 50}).status();
         }},
        {"overlapping",
         [&](Scene& s) {
             std::vector<Found> found;
             return overlapping(s.world, Aabb{{-9, -9, -9}, {9, 9, 9}}, {}, found).status();
         }},
    };
    foreign = make_crowd(GetParam(), 20).snapshot();
    long failures = 0;
    for (const Call& call : calls) {
        bool fails = true;
        for (long n = 0; fails; ++n) {
            ASSERT_LT(n, 2000) << call.name;
            Scene scene(GetParam());
            World& world = scene.world;
            saved = world.snapshot();
            ASSERT_TRUE(world.set_velocity(scene.body, {1, 2, 2}, {}));
            const std::uint64_t before = world.hash();
            const Status status = run_with_failure(n, [&] { return call.run(scene); });
            fails = an_allocation_failed;
            if (!fails) {
                EXPECT_EQ(status, Status::Ok) << call.name;
                break;
            }
            ++failures;
            if (status != Status::Ok) {
                EXPECT_EQ(status, Status::NoMemory) << call.name << " at " << n;
                EXPECT_EQ(world.hash(), before) << call.name << " at " << n;
            }
            ASSERT_TRUE(world.step()) << call.name << " at " << n;
            EXPECT_EQ(call.run(scene), Status::Ok) << call.name << " at " << n;
            ASSERT_TRUE(world.step()) << call.name << " at " << n;
        }
    }
    EXPECT_GT(failures, 100);
}

/// The one call that may leave the world broken says so, and restore() mends it.
TEST_P(OutOfMemory, a_failed_step_leaves_a_world_that_only_restore_leads_on_from) {
    const auto prepare = [&] {
        World world = make_crowd(GetParam(), 3);
        for (int i = 0; i < 40; ++i)
            add(world, {.position = {0.2 * (i % 6), 1.0 + 0.3 * i, 0.1 * i}}, i % 3 ? Shape(Box{}) : Shape(Capsule{}));
        return world;
    };
    World control = prepare();
    const std::vector<std::byte> saved = control.snapshot();
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(control.step());
    for (long n = 0;; ++n) {
        ASSERT_LT(n, 5000);
        World world = prepare();
        const std::uint64_t before = world.hash();
        const Status status = run_with_failure(n, [&] { return world.step().status(); });
        if (!an_allocation_failed) break;
        if (status == Status::Ok) continue;  // the trees of queries, which are no part of the step
        ASSERT_EQ(status, Status::NoMemory);
        const BodyId body = control.bodies()[1];
        for (const Error& error : {world.step().error(), world.add_body({}).error(), world.remove_body(body).error(),
                                   world.body(body).error(), cast_ray(world, {{0, 20, 0}, {0, -1, 0}, 50}).error()}) {
            EXPECT_EQ(error.status, Status::NoMemory);
            EXPECT_NE(error.text().find("restore a snapshot"), std::string::npos) << error.text();
        }
        EXPECT_TRUE(world.snapshot().empty());
        ASSERT_TRUE(world.restore(saved));
        EXPECT_EQ(world.hash(), before);
        for (int i = 0; i < 3; ++i) ASSERT_TRUE(world.step());
        EXPECT_EQ(world.hash(), control.hash()) << n;
    }
}

TEST(OutOfMemoryWorld, creating_a_world_fails_without_an_exception) {
    for (long n = 0;; ++n) {
        ASSERT_LT(n, 500);
        const Status status = run_with_failure(n, [&] { return World::create().status(); });
        if (!an_allocation_failed) break;
        EXPECT_EQ(status, Status::NoMemory);
    }
    for (long n = 0;; ++n) {
        const Status status = run_with_failure(n, [&] { return World::create({.sub_steps = 0}).status(); });
        if (!an_allocation_failed) break;
        EXPECT_EQ(status, Status::NoMemory);
    }
}

INSTANTIATE_TEST_SUITE_P(Registry, OutOfMemory, testing::ValuesIn(structures()),
                         [](const testing::TestParamInfo<std::string>& name) { return name.param; });

}  // namespace
}  // namespace fase
#endif
