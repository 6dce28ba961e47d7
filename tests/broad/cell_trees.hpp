#pragma once
/// Shared by the tests of quadtree, octree and loose octree: box sets, sorted results, and checks against brute force.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "fase/broad/brute_force.hpp"
#include "fase/broad/cull.hpp"
#include "fase/broad/find_pairs.hpp"
#include "fase/broad/stats.hpp"
#include "fase/core/random.hpp"
#include "tests/broad/drawn_boxes.hpp"

namespace fase::broad::cell_trees {

inline std::vector<Move> random_cubes(std::size_t count, float world, std::uint64_t seed, float side = 1) {
    Random random(seed);
    std::vector<Move> boxes;
    for (Proxy p = 0; p < count; ++p) boxes.push_back({p, cube(place(random, 0, world), side)});
    return boxes;
}

/// All found pairs, sorted; duplicates are kept.
template <class S> std::vector<Pair> pairs_of(const S& s) {
    std::vector<Pair> pairs;
    s.find_pairs(pairs);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}
template <class S> std::vector<Pair> awake_pairs_of(const S& s) {
    std::vector<Pair> pairs;
    find_awake_pairs(s, pairs);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}
template <class S> std::vector<Proxy> overlapping(const S& s, const Aabb& box) {
    std::vector<Proxy> found;
    s.traverse(BoxRegion{box}, [&](Proxy p, const Aabb&) {
        found.push_back(p);
        return true;
    });
    std::sort(found.begin(), found.end());
    return found;
}

inline BruteForce reference_of(const std::vector<Move>& boxes) {
    BruteForce reference;
    for (const Move& m : boxes) reference.insert(m.proxy, m.box);
    return reference;
}

/// Checks pairs, awake pairs with two thirds of the boxes asleep, and queries against brute force.
template <class S> void expect_like_brute_force(S& tree, const std::vector<Move>& boxes) {
    tree.build(boxes);
    BruteForce reference = reference_of(boxes);
    ASSERT_EQ(tree.broken_invariant(), "");
    ASSERT_EQ(pairs_of(tree), pairs_of(reference));
    for (std::size_t i = 0; i < boxes.size(); i += 1 + boxes.size() / 50)
        ASSERT_EQ(overlapping(tree, boxes[i].box), overlapping(reference, boxes[i].box));
    for (const Move& m : boxes) {
        if (m.proxy % 3 == 0) continue;
        tree.set_awake(m.proxy, false);
        reference.set_awake(m.proxy, false);
    }
    tree.commit();
    ASSERT_EQ(tree.broken_invariant(), "");
    ASSERT_EQ(awake_pairs_of(tree), awake_pairs_of(reference));
}

/// Boxes on small integers, so that borders and corners coincide; some flat, some huge. Rapidcheck shrinks them.
inline std::vector<Move> arbitrary_boxes() {
    const auto sizes = *rc::gen::container<std::vector<std::array<int, 6>>>(
        rc::gen::container<std::array<int, 6>>(rc::gen::inRange(0, 17)));
    std::vector<Move> boxes;
    for (const auto& s : sizes) {
        const Vec3 at{static_cast<float>(s[0]), static_cast<float>(s[1]), static_cast<float>(s[2])};
        const auto side = [](int size) {
            return size > 12 ? std::ldexp(1.0f, size - 8) : static_cast<float>(size % 3);
        };
        boxes.push_back({static_cast<Proxy>(boxes.size()), {at, at + Vec3{side(s[3]), side(s[4]), side(s[5])}}});
    }
    return boxes;
}
template <class S> void like_brute_force_for_arbitrary_boxes() {
    typename S::Settings settings;
    settings.capacity = *rc::gen::inRange(1u, 6u);
    settings.max_depth = *rc::gen::inRange(0, 17);
    if (*rc::gen::arbitrary<bool>()) settings.bounds = Aabb{{2, 2, 2}, {8, 10, 9}};
    S tree(settings);
    const std::vector<Move> boxes = arbitrary_boxes();
    tree.build(boxes);
    RC_ASSERT(tree.broken_invariant() == "");
    RC_ASSERT(pairs_of(tree) == pairs_of(reference_of(boxes)));
}

/// The number of leaves of each proxy.
template <class S> std::map<Proxy, std::size_t> leaves_of_each(const S& tree) {
    std::map<Proxy, std::size_t> leaves;
    tree.for_each_leaf([&](const Leaf& leaf) {
        for (const Proxy p : leaf.proxies) ++leaves[p];
    });
    return leaves;
}

/// Repeated inserts, moves, erases and sleep must not grow the arrays without bound.
template <class S> void does_not_allocate_once_warm() {
    Random random(6);
    S tree;
    tree.build(random_cubes(2000, 25, 6));
    const auto one_round = [&] {
        for (Proxy p = 0; p < 2000; ++p) tree.move(p, cube(place(random, 0, 25)));
        tree.commit();
        for (Proxy p = 0; p < 2000; p += 3) tree.set_awake(p, !tree.is_awake(p));
        tree.commit();
        for (Proxy p = 0; p < 2000; p += 3) tree.erase(p);
        tree.commit();
        for (Proxy p = 0; p < 2000; p += 3) tree.insert(p, cube(place(random, 0, 25)));
        tree.commit();
    };
    for (int i = 0; i < 20; ++i) one_round();
    const std::size_t warm = tree.bytes();
    for (int i = 0; i < 20; ++i) one_round();
    EXPECT_LE(tree.bytes(), warm + warm / 20) << "more than the variation of the cell count between rounds";
    EXPECT_EQ(tree.broken_invariant(), "");
}

/// Building the same boxes again does not grow the arrays.
template <class S> void reuses_all_arrays() {
    const std::vector<Move> boxes = random_cubes(2000, 25, 7);
    S tree;
    tree.build(boxes);
    const std::size_t warm = tree.bytes();
    for (int i = 0; i < 5; ++i) {
        for (const Move& m : boxes) tree.move(m.proxy, m.box);
        tree.commit();
        tree.clear();
        tree.commit();
        tree.build(boxes);
    }
    EXPECT_EQ(tree.bytes(), warm);
}

/// Most boxes are outside the declared bounds, some of them very far.
template <class S> void finds_boxes_outside_the_declared_bounds() {
    typename S::Settings settings;
    settings.capacity = 4;
    settings.bounds = Aabb{{4, 4, 4}, {9, 9, 9}};
    S tree(settings);
    std::vector<Move> boxes = random_cubes(400, 14, 8);
    for (Proxy p = 0; p < 400; p += 50) {
        const Vec3 far = Vec3{p % 100 == 0 ? -1e6f : 2e7f, 5, p % 150 == 0 ? 1e12f : 6};
        boxes[p].box = cube(far, p % 200 == 0 ? 4 : 3e7f);
    }
    expect_like_brute_force(tree, boxes);
    for (const Aabb& bounds : {Aabb{}, Aabb::everything(), cube({5, 5, 5}, 0), cube({1e16f, 0, 0}, 1e-3f)}) {
        settings.bounds = bounds;
        S unbounded(settings);
        expect_like_brute_force(unbounded, boxes);
    }
}

/// All boxes of a branch completely inside the region are passed in one call.
template <class S> void passes_complete_branches() {
    S tree;
    tree.build(random_cubes(3000, 30, 9));
    std::size_t calls = 0, seen = 0;
    cull(tree, BoxRegion{{{-1, -1, -1}, {40, 40, 40}}}, [&](std::span<const Proxy> proxies, bool inside) {
        EXPECT_TRUE(inside);
        ++calls;
        seen += proxies.size();
    });
    EXPECT_EQ(calls, 1u);
    EXPECT_EQ(seen, 3000u);
}

/// Visits only the near boxes of a row.
template <class S> void visits_near_branches_first() {
    std::vector<Move> row;
    for (Proxy p = 0; p < 4000; ++p)
        row.push_back({p, cube({static_cast<float>(2 * p), 0, static_cast<float>(p % 7)})});
    S tree;
    tree.build(row);
    std::size_t visited = 0;
    Proxy nearest = 0;
    tree.nearest_first(PointMeasure({5000.5, 0, 3}, Aabb::infinity), infinite_distance,
                       [&](Proxy p, const Aabb&, float at) {
                           ++visited;
                           nearest = p;
                           return at;
                       });
    EXPECT_NEAR(nearest, 2500, 3);
    EXPECT_LT(visited, 200u);
}

template <class S> void finds_the_same_pairs_in_parallel() {
    S tree;
    tree.build(random_cubes(6000, 35, 10));
    std::vector<Pair> alone, shared;
    tree.find_pairs(alone);
    const auto tasks = make_thread_runner(3);
    tree.find_pairs(*tasks, shared);
    EXPECT_FALSE(alone.empty());
    EXPECT_EQ(alone, shared) << "in the order of the leaves";
}

}  // namespace fase::broad::cell_trees
