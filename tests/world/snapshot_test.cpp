// Snapshots: they believe nothing that they read, keep all that a step reads, and never revive an abandoned id.
#include <cstring>

#include "fase/core/hash.hpp"
#include "fase/geometry/hull_builder.hpp"
#include "fase/world/detail/check_state.hpp"
#include "fase/world/detail/state_access.hpp"
#include "tests/world/worlds.hpp"

namespace fase {
namespace {

using namespace test;

constexpr std::size_t head_size = 28;

/// Ground, bodies of all shapes, compounds, a sensor, a moving platform; later edits of all sorts since the last step.
World make_mixed(int steps, bool edits) {
    World world = make_world();
    add_ground(world);
    std::vector<Vec3> points;
    Random random(7);
    for (int i = 0; i < 12; ++i)
        points.push_back({random.between(-0.5f, 0.5f), random.between(-0.5f, 0.5f), random.between(-0.5f, 0.5f)});
    const std::vector<Shape> shapes{Sphere{0.5f}, Capsule{0.2f, 0.3f}, Cylinder{0.3f, 0.3f}, *build_convex_hull(points),
                                    Box{{0.5f, 0.4f, 0.3f}}};
    std::vector<BodyId> bodies;
    for (std::size_t i = 0; i < 12; ++i) {
        const Vec3d place{0.3 * double(i % 4), 0.5 + 0.6 * double(i), 0.2 * double(i % 3)};
        const auto body = world.add_body({.position = place}, shapes[i % 5], {.sensor = i % 7 == 6});
        EXPECT_TRUE(body);
        bodies.push_back(*body);
        if (i % 3 == 0) {
            EXPECT_TRUE(world.add_collider(*body, Sphere{0.2f}, {.pose = {{0.4f, 0, 0}, {}}}));
        }
    }
    add(world, {.kind = BodyKind::Kinematic, .position = {2, 1, 0}, .linear_velocity = {0.1f, 0, 0}}, Box{});
    for (int i = 0; i < steps; ++i) EXPECT_TRUE(world.step());
    if (!edits) return world;
    EXPECT_TRUE(world.remove_body(bodies[1]));
    EXPECT_TRUE(world.exclude_pair(bodies[0], bodies[2]));
    EXPECT_TRUE(world.set_kind(bodies[3], BodyKind::Static));
    EXPECT_TRUE(world.apply_force(bodies[2], {1, 2, 3}));
    EXPECT_TRUE(world.remove_collider(world.colliders_of(bodies[4])[0]));
    EXPECT_TRUE(world.add_body({}, Sphere{0.3f}));
    return world;
}

/// Changes a few bytes of the state and repairs the checksum, as anyone can.
std::vector<std::byte> forged(std::vector<std::byte> bytes, Random& random) {
    constexpr std::uint32_t words[] = {0xffffffff, 0x7fffffff, 0, 1, 2, 0x7fc00000, 0x7f800000, 0x7f7fffff};
    const auto place = [&](std::size_t size) { return head_size + random.below(bytes.size() - head_size - size); };
    for (std::size_t left = 1 + random.below(3); left > 0; --left) switch (random.below(4)) {
            case 0: bytes[place(1)] ^= std::byte(1u << random.below(8)); break;
            case 1: bytes[place(1)] = std::byte(random.below(256)); break;
            case 2: std::memmove(bytes.data() + place(4), bytes.data() + place(4), 4); break;
            default: std::memcpy(bytes.data() + place(4), &words[random.below(8)], 4);
        }
    Hasher hasher;
    hasher.add_bytes(std::span<const std::byte>(bytes).subspan(head_size));
    const std::uint64_t sum = hasher.value();
    std::memcpy(bytes.data() + 20, &sum, sizeof sum);
    return bytes;
}

TEST(Snapshot, forged_ones_are_refused_or_make_a_world_that_works) {
    int refused = 0, taken = 0;
    for (const auto& [steps, edits] : {std::pair{0, false}, {20, true}, {60, true}, {400, false}}) {
        const World base = make_mixed(steps, edits);
        const std::vector<std::byte> good = base.snapshot();
        World world = make_world();
        add(world, {}, Sphere{});
        ASSERT_TRUE(world.restore(good));
        ASSERT_EQ(world.hash(), base.hash());
        Random random(static_cast<std::uint64_t>(steps));
        for (int round = 0; round < 150; ++round) {
            const std::uint64_t before = world.hash();
            if (const auto restored = world.restore(forged(good, random)); !restored) {
                ++refused;
                ASSERT_TRUE(restored.status() == Status::Format || restored.status() == Status::Capacity);
                ASSERT_EQ(world.hash(), before);
                if (restored.status() == Status::Capacity) world = make_world();  // a forged slot has issued all ids
                continue;
            }
            ++taken;
            for (int i = 0; i < 60; ++i) ASSERT_TRUE(world.step());
            ASSERT_TRUE(world.restore(world.snapshot()));
            for (const BodyId body : world.bodies()) ASSERT_TRUE(world.remove_body(body));
            ASSERT_TRUE(world.step());
            ASSERT_TRUE(world.restore(world.snapshot()));
        }
    }
    EXPECT_GT(refused, 100);
    EXPECT_GT(taken, 30);
}

TEST(Snapshot, names_the_part_that_is_wrong) {
    const auto wrong = [](const auto& change) {
        World world = make_mixed(60, true);
        WorldState& state = WorldStateAccess::of(world);
        EXPECT_EQ(wrong_part(state), "");
        change(state);
        const std::string_view part = wrong_part(state);
        const auto restored = make_world().restore(world.snapshot());
        EXPECT_FALSE(restored);
        EXPECT_NE(restored.error().text().find(part), std::string::npos) << restored.error().text();
        return std::string(part);
    };
    EXPECT_EQ(wrong([](WorldState& s) { s.bodies.awake.pop_back(); }), "wrong lists of bodies");
    EXPECT_EQ(wrong([](WorldState& s) { s.bodies.to_wake.push_back(999); }), "wrong lists of bodies");
    EXPECT_EQ(wrong([](WorldState& s) { s.bodies.let_go.push_back(999); }), "wrong lists of bodies");
    EXPECT_EQ(wrong([](WorldState& s) { s.bodies.awake_added.clear(); }), "wrong lists of bodies");
    EXPECT_EQ(wrong([](WorldState& s) { s.bodies.awake_added.push_back(s.bodies.awake[0]); }), "wrong lists of bodies");
    EXPECT_EQ(wrong([](WorldState& s) { s.bodies.awake_added.push_back(s.bodies.awake_added[0]); }),
              "wrong lists of bodies");
    EXPECT_EQ(wrong([](WorldState& s) { s.contacts.to_check.push_back(999); }), "wrong contacts");
    EXPECT_EQ(wrong([](WorldState& s) { s.bodies.traits[s.bodies.awake[0]].motion_state = MotionState::Static; }),
              "wrong motion states");
    EXPECT_EQ(wrong([](WorldState& s) { s.contacts.active.values[0] = s.contacts.active.values[1]; }),
              "wrong contacts");
    EXPECT_EQ(wrong([](WorldState& s) { std::swap(s.contacts.active.pairs[0], s.contacts.active.pairs[1]); }),
              "wrong contacts");
    EXPECT_EQ(wrong([](WorldState& s) { s.contacts.free.push_back(0); }), "wrong contacts");
    EXPECT_EQ(wrong([](WorldState& s) { ++s.colliders.shapes[0].users; }), "wrong shapes");
    EXPECT_EQ(wrong([](WorldState& s) { s.colliders[1].next = 1; }), "wrong colliders");
    EXPECT_EQ(wrong([](WorldState& s) { s.broad_phase.edited_colliders.push_back(0); }), "wrong colliders");
    EXPECT_EQ(wrong([](WorldState& s) { s.bodies.motion[2].position.x = 2e7; }), "a wrong body");
    EXPECT_EQ(wrong([](WorldState& s) { s.bodies.traits[3].inverse_mass *= 2; }), "a wrong body");
    EXPECT_EQ(wrong([](WorldState& s) { s.settings.sub_steps = 0; }), "settings out of range");
    EXPECT_EQ(wrong([](WorldState& s) { s.broad_phase.boxes.pop_back(); }), "lists of different sizes");
}

/// A count of as many elements as there are bytes is refused before the memory for them is allocated.
TEST(Snapshot, counts_are_checked_by_the_size_of_their_elements) {
    World world = make_world();
    add(world, {}, Sphere{});
    const std::vector<std::byte> good = world.snapshot();
    for (std::size_t at = head_size; at + 8 <= good.size(); ++at) {
        std::vector<std::byte> bytes = good;
        bytes.resize(good.size() + (1 << 16));
        const auto put = [&](std::size_t where, std::uint64_t value) { std::memcpy(&bytes[where], &value, 8); };
        put(at, bytes.size() - at - 8);
        put(12, bytes.size() - head_size);
        Hasher hasher;
        hasher.add_bytes(std::span<const std::byte>(bytes).subspan(head_size));
        put(20, hasher.value());
        EXPECT_EQ(world.restore(bytes).status(), Status::Format) << at;
    }
}

/// The path of a fast body that is gone must not widen the contacts of the body that has its slot now.
TEST(Snapshot, holds_all_that_a_step_reads) {
    World world = make_world();
    add_ground(world);
    const BodyId bullet = add(world, {.position = {0, 500, 0}, .linear_velocity = {0, 600, 0}}, Sphere{0.1f});
    for (int i = 0; i < 3; ++i) ASSERT_TRUE(world.step());
    ASSERT_TRUE(world.remove_body(bullet));
    add(world, {.kind = BodyKind::Static, .position = {0, 1, 0}}, Box{{5, 1, 5}});
    add(world, {.position = {0, 3.1, 0}, .rotation = rotation_about(Vec3{0, 0, 1}, 0.4f)}, Box{});
    World other = make_world();
    ASSERT_TRUE(other.restore(world.snapshot()));
    for (int i = 0; i < 120; ++i) {
        ASSERT_TRUE(world.step());
        ASSERT_TRUE(other.step());
        ASSERT_EQ(other.hash(), world.hash()) << i;
    }
}

TEST(Snapshot, ids_of_an_abandoned_future_are_refused) {
    World world = make_world();
    const BodyId kept = add(world, {}, Sphere{});
    const std::vector<std::byte> saved = world.snapshot();
    const std::uint64_t hash = world.hash();
    const BodyId later = add(world, {}, Sphere{});
    const ColliderId later_collider = world.colliders_of(later)[0];
    ASSERT_TRUE(world.remove_body(kept));
    const BodyId reused = add(world, {}, Sphere{});
    ASSERT_TRUE(world.restore(saved));
    EXPECT_EQ(world.hash(), hash);
    EXPECT_TRUE(world.contains(kept));
    EXPECT_FALSE(world.contains(later));
    EXPECT_FALSE(world.contains(later_collider));
    EXPECT_FALSE(world.contains(reused));
    const BodyId again = add(world, {}, Sphere{});
    EXPECT_EQ(again.index, later.index);
    EXPECT_FALSE(world.contains(later)) << "names the body that has its slot now";
    EXPECT_FALSE(world.contains(later_collider));
    ASSERT_TRUE(world.remove_body(kept));
    add(world, {}, Sphere{});
    EXPECT_FALSE(world.contains(reused));
}

TEST(Snapshot, a_replay_after_restore_gives_the_same_hash) {
    World world = make_mixed(30, false);
    const std::vector<std::byte> saved = world.snapshot();
    const auto play = [&] {
        for (int i = 0; i < 20; ++i) {
            EXPECT_TRUE(world.add_body({.position = {0, 9, 0}}, Sphere{0.2f}));
            EXPECT_TRUE(world.remove_body(world.bodies()[2]));
            EXPECT_TRUE(world.step());
        }
        return world.hash();
    };
    const std::uint64_t first = play();
    ASSERT_TRUE(world.restore(saved));
    EXPECT_EQ(play(), first);
}

TEST(Snapshot, ids_are_good_again_in_any_world) {
    World first = make_mixed(60, true), second = make_mixed(60, true);
    for (const BodyId body : second.bodies()) ASSERT_TRUE(second.remove_body(body));
    std::vector<BodyId> own;
    for (int i = 0; i < 20; ++i) own.push_back(add(second, {.position = {0, 2.0 * i, 0}}, Sphere{}));
    std::vector<ColliderId> own_colliders;
    for (const BodyId body : own) own_colliders.push_back(second.colliders_of(body)[0]);
    const std::vector<std::byte> own_snapshot = second.snapshot();
    const auto map = second.restore(first.snapshot());
    ASSERT_TRUE(map);
    EXPECT_EQ(second.hash(), first.hash());
    for (const BodyId id : own) {
        EXPECT_FALSE(second.contains(id));
        EXPECT_EQ(map->of(id), BodyId{});
    }
    for (const ColliderId id : own_colliders) EXPECT_FALSE(second.contains(id));
    for (const BodyId id : first.bodies()) {
        ASSERT_TRUE(second.contains(id));
        EXPECT_EQ(map->of(id), id);
        EXPECT_EQ(state(second, id).pose.position, state(first, id).pose.position);
        for (const ColliderId collider : first.colliders_of(id)) ASSERT_TRUE(second.contains(collider));
    }
    for (int i = 0; i < 60; ++i) {
        ASSERT_TRUE(first.step());
        ASSERT_TRUE(second.step());
        ASSERT_EQ(second.hash(), first.hash());
        ASSERT_EQ(second.events().contacts_begun, first.events().contacts_begun);
    }
    // Back to its own: its ids are good again, and none that it issued meanwhile is issued twice.
    const BodyId meanwhile = add(second, {}, Sphere{});
    ASSERT_TRUE(second.restore(own_snapshot));
    for (const BodyId id : own) EXPECT_TRUE(second.contains(id));
    EXPECT_FALSE(second.contains(meanwhile));
}

TEST(Snapshot, ids_of_an_abandoned_future_are_refused_after_a_visit_to_another_world) {
    World world = make_world(), other = make_world();
    add(world, {}, Sphere{});
    const std::vector<std::byte> saved = world.snapshot();
    const BodyId later = add(world, {}, Sphere{});
    ASSERT_TRUE(world.restore(other.snapshot()));
    EXPECT_FALSE(world.contains(later));
    ASSERT_TRUE(world.restore(saved));
    EXPECT_FALSE(world.contains(later));
    const BodyId again = add(world, {}, Sphere{});
    EXPECT_EQ(again.index, later.index);
    EXPECT_FALSE(world.contains(later)) << "names the body that has its slot now";
}

TEST(Snapshot, worlds_have_numbers_of_their_own) {
    std::set<std::uint16_t> numbers;
    for (int i = 0; i < 100; ++i) {
        World world = make_world();
        numbers.insert(add(world, {}, Sphere{}).owner);
    }
    EXPECT_EQ(numbers.size(), 100u);
}

/// Edits between steps, too: lists that a restored world builds in another order must not show.
TEST(Snapshot, edits_after_a_restore_leave_the_same_state) {
    for (const int steps : {20, 60, 400}) {
        World world = make_mixed(steps, true), other = make_world();
        const auto map = other.restore(world.snapshot());
        ASSERT_TRUE(map);
        const auto edit = [](World& w) {
            for (const BodyId body : w.bodies())
                for (const ColliderId c : w.colliders_of(body)) EXPECT_TRUE(w.set_material(c, {.friction = 0.2f}));
            const std::vector<ColliderShape> parts{{Box{}}, {Sphere{0.2f}, {.pose = {{1, 0, 0}, {}}}}};
            EXPECT_TRUE(w.add_body({.position = {0, 9, 0}}, parts));
            EXPECT_TRUE(w.set_kind(w.bodies()[5], BodyKind::Kinematic));
            EXPECT_TRUE(w.set_settings({.gravity = {0, -5, 0}}));
        };
        for (int i = 0; i < 90; ++i) {
            if (i % 30 == 0) {
                edit(world);
                edit(other);
                ASSERT_EQ(other.hash(), world.hash()) << i;
            }
            ASSERT_TRUE(world.step());
            ASSERT_TRUE(other.step());
            ASSERT_EQ(other.hash(), world.hash()) << i;
        }
    }
}

}  // namespace
}  // namespace fase
