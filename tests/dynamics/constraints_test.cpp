/// The colours of constraints and the pool of manifolds, against simple models.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <vector>

#include "fase/core/random.hpp"
#include "fase/dynamics/solver/constraint_colours.hpp"
#include "fase/dynamics/solver/manifold_pool.hpp"

namespace fase::dynamics {
namespace {

struct Edge {
    std::uint32_t a = 0, b = 0;
    ConstraintColour colour;
};

/// Each colour that a constraint has is taken at the bodies that it moves, and nowhere else.
void expect_consistent(const ConstraintColours& colours, const std::vector<Edge>& edges, std::uint32_t bodies) {
    std::vector<std::set<int>> taken(bodies);
    for (const Edge& e : edges) {
        if (e.colour.number >= ConstraintColours::count) continue;
        EXPECT_EQ(e.colour.moves == Moves::Both, e.colour.number < ConstraintColours::two_sided);
        const bool free_a = !moves_a(e.colour.moves) || taken[e.a].insert(e.colour.number).second;
        const bool free_b = !moves_b(e.colour.moves) || taken[e.b].insert(e.colour.number).second;
        EXPECT_TRUE(free_a && free_b);
    }
    for (std::uint32_t body = 0; body < bodies; ++body)
        EXPECT_EQ(colours.used(body), static_cast<int>(taken[body].size()));
}

void update(ConstraintColours& colours, Edge& e, Moves moves, bool on_sleeper = false) {
    Constraint constraint{0, 0, e.a, e.b};
    constraint.moves = moves;
    constraint.on_sleeper = on_sleeper && moves != Moves::Both && moves != Moves::Neither;
    colours.update(e.colour, constraint);
    const bool has_colour = e.colour.number < ConstraintColours::count;
    EXPECT_EQ(has_colour && constraint.on_sleeper, has_colour && e.colour.number >= ConstraintColours::on_sleeper);
}

TEST(ConstraintColours, random_lives_keep_one_colour_per_body_and_free_those_that_end) {
    constexpr std::uint32_t bodies = 12;
    bool overflowed = false;
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
        Random random(seed);
        ConstraintColours colours;
        colours.resize(bodies);
        std::vector<Edge> edges;
        for (int act = 0; act < 1500; ++act) {
            if (edges.empty() || random.below(3) != 0) {
                Edge e{static_cast<std::uint32_t>(random.below(bodies)),
                       static_cast<std::uint32_t>(random.below(bodies)),
                       {}};
                if (e.a == e.b) continue;
                update(colours, e, static_cast<Moves>(1 + random.below(3)), random.below(2) == 0);
                edges.push_back(e);
            }
            Edge& e = edges[random.below(edges.size())];
            const ConstraintColour before = e.colour;
            const auto moves = static_cast<Moves>(random.below(4));
            const bool on_sleeper = random.below(2) == 0, one = moves == Moves::A || moves == Moves::B;
            update(colours, e, moves, on_sleeper);
            EXPECT_EQ(e.colour.moves, moves);
            EXPECT_EQ(e.colour.number == ConstraintColour::none, moves == Moves::Neither);
            const bool was_on_sleeper = before.number >= ConstraintColours::on_sleeper;
            if (before.moves == moves && before.number < ConstraintColours::count &&
                (!one || was_on_sleeper == on_sleeper)) {
                EXPECT_EQ(e.colour.number, before.number) << "a colour that still suits is kept";
            }
            overflowed |= e.colour.number == ConstraintColour::overflow;
            if (random.below(3) == 0) {
                const std::size_t gone = random.below(edges.size());
                colours.release(edges[gone].colour, edges[gone].a, edges[gone].b);
                edges.erase(edges.begin() + static_cast<std::ptrdiff_t>(gone));
            }
        }
        expect_consistent(colours, edges, bodies);
        // What is saved with the constraints is enough to go on.
        ConstraintColours restored;
        restored.resize(bodies);
        for (const Edge& e : edges) EXPECT_TRUE(restored.restore(e.colour, e.a, e.b));
        for (std::uint32_t body = 0; body < bodies; ++body) EXPECT_EQ(restored.used(body), colours.used(body));
        for (const Edge& e : edges) {
            const bool has_colour = e.colour.number < ConstraintColours::count;
            EXPECT_EQ(restored.restore(e.colour, e.a, e.b), !has_colour) << "nobody has a colour twice";
        }
    }
    EXPECT_TRUE(overflowed);
}

TEST(ConstraintColours, contradictory_colours_are_refused) {
    ConstraintColours colours;
    colours.resize(3);
    EXPECT_FALSE(colours.restore({3, Moves::B}, 0, 1)) << "a two-sided colour moves both";
    EXPECT_FALSE(colours.restore({50, Moves::Both}, 0, 1));
    EXPECT_FALSE(colours.restore({3, Moves::Neither}, 0, 1));
    EXPECT_FALSE(colours.restore({ConstraintColour::none, Moves::A}, 0, 1));
    EXPECT_FALSE(colours.restore({ConstraintColour::overflow, Moves::Neither}, 0, 1));
    EXPECT_FALSE(colours.restore({100, Moves::Both}, 0, 1)) << "there is no colour 100";
    EXPECT_TRUE(colours.restore({ConstraintColour::overflow, Moves::Both}, 0, 1));
    EXPECT_EQ(colours.used(0) + colours.used(1), 0);
}

TEST(ConstraintColours, a_hub_gets_a_colour_when_one_becomes_free) {
    ConstraintColours colours;
    colours.resize(100);
    std::vector<Edge> all;
    for (std::uint32_t i = 0; i <= ConstraintColours::two_sided; ++i) {
        all.push_back({0, i + 1, {}});
        update(colours, all.back(), Moves::Both);
    }
    EXPECT_EQ(all.back().colour.number, ConstraintColour::overflow);
    const int freed = all[7].colour.number;
    colours.release(all[7].colour, 0, 8);
    update(colours, all.back(), Moves::Both);
    EXPECT_EQ(all.back().colour.number, freed);
}

TEST(ManifoldPool, random_lives_keep_the_manifolds_of_each_contact_together) {
    Random random(7);
    ManifoldPool pool;
    std::vector<Contact> contacts;
    std::map<std::size_t, std::vector<std::uint32_t>> expected;  // by contact: the children of its manifolds
    std::uint32_t next = 0;
    std::size_t most = 0;
    for (int act = 0; act < 4000; ++act) {
        if (contacts.size() < 60) contacts.emplace_back();
        const std::size_t at = random.below(contacts.size());
        Contact& c = contacts[at];
        if (random.below(5) == 0) {
            pool.release(c);
            EXPECT_EQ(c.manifolds + c.capacity, 0);
            expected[at].clear();
        } else {
            const std::size_t more = 1 + random.below(random.below(20) == 0 ? 100 : 3);
            pool.reserve(c, c.manifolds + more);
            for (std::size_t i = 0; i < more; ++i) {
                ContactManifold& fresh = pool.places(c)[c.manifolds];
                EXPECT_EQ(fresh.count + fresh.key.child_a, 0u) << "a place that is reused is empty";
                fresh.key.child_a = ++next;
                fresh.count = 1;
                ++c.manifolds;
                expected[at].push_back(next);
            }
        }
        most = std::max(most, pool.size());
        for (std::size_t i = 0; i < contacts.size(); ++i) {
            std::vector<std::uint32_t> found;
            for (const ContactManifold& m : pool.of(contacts[i])) found.push_back(m.key.child_a);
            ASSERT_EQ(found, expected[i]);
        }
    }
    // Freed places are used again.
    std::size_t in_use = 0;
    for (const Contact& c : contacts) in_use += c.capacity;
    EXPECT_LT(most, 20 * in_use);
}

}  // namespace
}  // namespace fase::dynamics
