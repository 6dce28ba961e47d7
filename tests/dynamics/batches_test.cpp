/// Batches hold every body and constraint once, and share nothing that moves.
#include "fase/dynamics/solver/batches.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>
#include <vector>

#include "fase/core/random.hpp"

namespace fase::dynamics {
namespace {

/// Bodies of which some have no row, in clusters that constraints connect.
struct Scene {
    std::vector<std::uint32_t> awake;
    std::vector<std::uint32_t> row_of_body;
    std::vector<Constraint> constraints;
    std::vector<std::uint8_t> in_hub;

    Scene(Random& random, std::uint32_t bodies, std::uint32_t cluster, std::size_t count) : row_of_body(bodies) {
        for (std::uint32_t body = 0; body < bodies; ++body)
            if (random.below(10) != 0) {
                row_of_body[body] = 1;
                awake.push_back(body);
            }
        for (std::size_t i = 0; i < count; ++i) {
            const auto first = static_cast<std::uint32_t>(random.below(bodies / cluster)) * cluster;
            const auto a = first + static_cast<std::uint32_t>(random.below(cluster));
            const auto b = first + static_cast<std::uint32_t>(random.below(cluster));
            if (a == b) continue;
            Constraint c{static_cast<std::uint32_t>(i), 0, a, b};
            // A body with a row may still be kinematic: then the constraint moves only the other one.
            const bool moves_both = row_of_body[a] && row_of_body[b] && random.below(5) != 0;
            c.moves = moves_both ? Moves::Both : row_of_body[a] ? Moves::A : row_of_body[b] ? Moves::B : Moves::Neither;
            c.touches = random.below(2) == 0;
            constraints.push_back(c);
            in_hub.push_back(random.below(4000) == 0 ? 1 : 0);
        }
    }
    [[nodiscard]] DisjointSets groups() const {
        DisjointSets sets;
        sets.reset(row_of_body.size());
        for (const Constraint& c : constraints)
            if (c.touches && c.moves == Moves::Both) sets.unite(c.body_a, c.body_b);
        return sets;
    }
    [[nodiscard]] Batches::Input input() const { return {awake, constraints, row_of_body, in_hub}; }
};

void expect_sound(const Scene& scene, const Batches& batches) {
    std::map<std::uint32_t, std::size_t> batch_of;
    std::set<std::uint32_t> rows, constraints;
    rows.insert(0);
    for (std::size_t i = 0; i < batches.all().size(); ++i) {
        const Batch& batch = batches.all()[i];
        const auto bodies = batches.bodies_of(batch);
        ASSERT_EQ(bodies.size(), batch.bodies);
        EXPECT_TRUE(std::ranges::is_sorted(bodies));
        for (const std::uint32_t body : bodies)
            EXPECT_TRUE(batch_of.emplace(body, i).second) << "a body in two batches";
        for (std::uint32_t row = batch.first_row; row <= batch.unused_row(); ++row)
            EXPECT_TRUE(rows.insert(row).second) << "a row in two batches";
        EXPECT_TRUE(std::ranges::is_sorted(batches.constraints_of(batch)));
        if (i > 0) {
            EXPECT_LE(batch.constraints, Batches::capacity);
            EXPECT_GT(batch.bodies, 0u);
        }
        for (const std::uint32_t number : batches.constraints_of(batch)) {
            EXPECT_TRUE(constraints.insert(number).second) << "a constraint in two batches";
            EXPECT_TRUE(i == 0 || !scene.in_hub[number]) << "hubs are in the first batch";
        }
    }
    EXPECT_EQ(batch_of.size(), scene.awake.size());
    EXPECT_EQ(rows.size(), batches.rows());
    EXPECT_EQ(*rows.rbegin() + 1, batches.rows());
    for (std::size_t i = 0; i < scene.constraints.size(); ++i) {
        const Constraint& c = scene.constraints[i];
        EXPECT_EQ(constraints.contains(static_cast<std::uint32_t>(i)), c.moves != Moves::Neither);
        if (c.moves == Moves::Neither || !scene.row_of_body[c.body_a] || !scene.row_of_body[c.body_b]) continue;
        EXPECT_EQ(batch_of.at(c.body_a), batch_of.at(c.body_b)) << "a constraint between two batches";
    }
}

TEST(Batches, hold_each_body_and_constraint_once_and_share_no_row) {
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
        Random random(seed);
        const std::uint32_t cluster = 2 + static_cast<std::uint32_t>(random.below(seed % 4 == 0 ? 900 : 30));
        const std::uint32_t bodies = cluster * (1 + static_cast<std::uint32_t>(random.below(60)));
        const Scene scene(random, bodies, cluster, random.below(6000));
        Batches batches;
        for (int round = 0; round < 2; ++round) {  // the memory of an earlier call has no influence
            DisjointSets groups = scene.groups();
            batches.divide(scene.input(), groups);
            expect_sound(scene, batches);
        }
    }
}

TEST(Batches, a_body_that_left_after_the_groups_were_found_is_in_no_batch) {
    Random random(1);
    Scene scene(random, 30, 30, 200);
    DisjointSets groups = scene.groups();
    const std::uint32_t gone = scene.awake.front();  // it names its group
    scene.awake.erase(scene.awake.begin());
    scene.row_of_body[gone] = 0;
    for (Constraint& c : scene.constraints)
        if (c.body_a == gone || c.body_b == gone) c.moves = Moves::Neither;
    Batches batches;
    batches.divide(scene.input(), groups);
    expect_sound(scene, batches);
}

TEST(Batches, groups_are_packed_up_to_the_capacity_and_large_ones_come_first) {
    Scene scene = [] {
        Random random(3);
        return Scene(random, 100, 100, 0);
    }();
    scene.awake.clear();
    scene.row_of_body.assign(4000, 1);
    for (std::uint32_t body = 0; body < 4000; ++body) scene.awake.push_back(body);
    const auto connect = [&](std::uint32_t first, std::uint32_t bodies) {
        for (std::uint32_t body = first; body + 1 < first + bodies; ++body) {
            scene.constraints.push_back({0, 0, body, body + 1});
            scene.constraints.back().moves = Moves::Both;
            scene.in_hub.push_back(0);
        }
    };
    connect(0, 401);
    connect(1000, 1026);  // 1,025 constraints: one too many
    connect(2500, 401);
    connect(3000, 401);
    DisjointSets groups = scene.groups();
    Batches batches;
    batches.divide(scene.input(), groups);
    expect_sound(scene, batches);
    EXPECT_EQ(batches.all()[0].constraints, 1025u);
    EXPECT_EQ(batches.all()[0].bodies, 1026u);
    std::vector<std::uint32_t> sizes;
    for (const Batch& batch : batches.all().subspan(1))
        if (batch.constraints > 0) sizes.push_back(batch.constraints);
    EXPECT_EQ(std::accumulate(sizes.begin(), sizes.end(), 0u), 1200u);
    EXPECT_LE(sizes.size(), 3u);
}

}  // namespace
}  // namespace fase::dynamics
