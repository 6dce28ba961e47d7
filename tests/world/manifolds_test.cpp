/// Contacts of several manifolds, and the colours that constraints keep.
#include <gtest/gtest.h>

#include "fase/world/detail/state_access.hpp"
#include "tests/world/worlds.hpp"

namespace fase::test {
namespace {

using dynamics::Contact;
using dynamics::ContactManifold;

Settings awake() {
    Settings settings;
    settings.sleep = false;
    return settings;
}

/// A box of 1 m that rests on the ground, whose one manifold is split into two of two points, as a mesh would give.
struct SplitContact {
    World world;
    BodyId box;

    SplitContact() : world(make_world(awake())) {
        add_ground(world);
        box = add(world, {.position = {0, 0.5, 0}}, Box{{0.5f, 0.5f, 0.5f}});
        for (int i = 0; i < 30; ++i) EXPECT_TRUE(world.step());
        Contact& c = contact();
        EXPECT_EQ(c.manifolds, 1);
        internals().contacts.manifolds.reserve(c, 2);
        const std::span<ContactManifold> places = internals().contacts.manifolds.places(c);
        places[1] = places[0];
        places[1].colour = {};
        places[1].key.triangle = 1;
        places[0].count = places[1].count = 2;
        for (int i = 0; i < 2; ++i) {
            for (float(ContactManifold::*field)[4] :
                 {&ContactManifold::x, &ContactManifold::y, &ContactManifold::first_separation,
                  &ContactManifold::separation, &ContactManifold::impulse, &ContactManifold::total_impulse}) {
                (places[1].*field)[i] = (places[0].*field)[i + 2];
                (places[0].*field)[i + 2] = (places[1].*field)[i + 2] = 0;
            }
            places[1].feature[i] = places[0].feature[i + 2];
        }
        c.manifolds = 2;
        internals().constraints.results.clear();
    }
    WorldState& internals() { return WorldStateAccess::of(world); }
    Contact& contact() { return internals().contacts[internals().contacts.active.values[0]]; }
    /// Colours that are taken at the box.
    int colours() { return internals().contacts.colours.used(internals().colliders[contact().collider_b].body); }
};

TEST(Manifolds, a_contact_of_two_manifolds_bears_its_body_and_tells_both) {
    SplitContact split;
    for (int i = 0; i < 120; ++i) {
        const auto report = split.world.step();
        ASSERT_TRUE(report);
        ASSERT_EQ(report->manifolds, 2u);
        EXPECT_EQ(report->contact_points, 4u);
        EXPECT_TRUE(split.world.events().contacts_begun.empty());
        EXPECT_TRUE(split.world.events().contacts_ended.empty());
    }
    const BodyState box = state(split.world, split.box);
    EXPECT_NEAR(box.pose.position.y, 0.5, 0.002);
    EXPECT_LT(length(box.linear_velocity), 1e-3f);
    EXPECT_LT(length(box.angular_velocity), 1e-3f);
    EXPECT_EQ(split.colours(), 2) << "two constraints of one body have two colours";
    std::vector<ContactState> contacts;
    split.world.read_contacts(contacts);
    ASSERT_EQ(contacts.size(), 2u);
    float impulse = 0;
    for (const ContactState& c : contacts) {
        EXPECT_EQ(c.count, 2);
        impulse += c.impulses[0] + c.impulses[1];
    }
    EXPECT_NEAR(impulse, 1000 * 9.81f / 60, 1);
}

TEST(Manifolds, several_manifolds_pass_through_a_snapshot) {
    SplitContact split;
    for (int i = 0; i < 10; ++i) EXPECT_TRUE(split.world.step());
    World twin = make_world(awake());
    ASSERT_TRUE(twin.restore(split.world.snapshot()));
    EXPECT_EQ(twin.hash(), split.world.hash());
    for (int i = 0; i < 30; ++i) {
        EXPECT_TRUE(split.world.step());
        EXPECT_TRUE(twin.step());
    }
    EXPECT_EQ(twin.hash(), split.world.hash());
    EXPECT_EQ(WorldStateAccess::of(twin).contacts[0].manifolds, 2);
}

TEST(Manifolds, colours_of_manifolds_that_end_are_freed) {
    SplitContact split;
    EXPECT_TRUE(split.world.step());
    EXPECT_EQ(split.colours(), 2);
    const auto kept = split.internals().contacts.manifolds.of(split.contact())[0].colour.number;
    split.contact().reusable = false;  // two boxes give one manifold again
    EXPECT_TRUE(split.world.step());
    EXPECT_EQ(split.contact().manifolds, 1);
    EXPECT_EQ(split.colours(), 1);
    EXPECT_EQ(split.internals().contacts.manifolds.of(split.contact())[0].colour.number, kept) << "colours persist";
    EXPECT_TRUE(split.world.set_velocity(split.box, {0, 20, 0}, {}));
    for (int i = 0; i < 30; ++i) EXPECT_TRUE(split.world.step());
    EXPECT_TRUE(split.internals().contacts.active.values.empty());
    EXPECT_EQ(split.internals().contacts.colours.used(split.box.index), 0);
}

TEST(Manifolds, contradictory_colours_in_a_snapshot_are_refused) {
    SplitContact split;
    EXPECT_TRUE(split.world.step());
    const auto manifolds = split.internals().contacts.manifolds.of(split.contact());
    manifolds[1].colour = manifolds[0].colour;
    World twin = make_world();
    const std::uint64_t before = twin.hash();
    const auto restored = twin.restore(split.world.snapshot());
    ASSERT_FALSE(restored);
    EXPECT_NE(restored.error().problem.find("contradictory colours"), std::string::npos) << restored.error().problem;
    EXPECT_EQ(twin.hash(), before);
}

}  // namespace
}  // namespace fase::test
