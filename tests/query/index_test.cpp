#include "fase/query/index.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <string>
#include <utility>

#include "fase/broad/registry.hpp"
#include "fase/core/random.hpp"

namespace fase {
namespace {

Aabb cube(float x, float y = 0, float z = 0, float side = 1) { return {{x, y, z}, {x + side, y + side, z + side}}; }

/// Four cubes in a row: a and b touch, c and d are apart.
template <class S> Index<std::string, S> four() {
    Index<std::string, S> index;
    for (const auto& [name, x] : {std::pair{"a", 0.f}, {"b", 1.f}, {"c", 2.5f}, {"d", 9.f}})
        index.insert(cube(x), name);
    index.commit();
    return index;
}

using Names = std::vector<std::string>;

/// Runs a test with the default and with four different kinds of structures: a list, a tree with boxes in several
/// leaves, a dynamic tree, and one with own versions of most operations. The conformance tests cover the others.
template <class F> void on_several_structures(F&& f) {
    const auto traced = [&]<broad::Structure S>() {
        SCOPED_TRACE(S::info.name);
        f.template operator()<S>();
    };
    f.template operator()<query::OnDemand>();
    broad::for_each_structure(
        traced, broad::StructureList<broad::BruteForce, broad::Quadtree, broad::DynamicBvh, broad::WideBvh>{});
}

TEST(Index, VisitsPairsOnceInOrder) {
    on_several_structures([]<class S>() {
        auto index = four<S>();
        index.insert(cube(0.5f), "e");
        index.commit();
        Names pairs;
        index.pairs(in_order, [&](std::string& a, const std::string& b) { pairs.push_back(a + b); });
        EXPECT_EQ(pairs, (Names{"ab", "ae", "be"}));
        Names with_ids;
        index.pairs(in_order, [&](auto a, std::string& left, auto b, std::string& right) {
            EXPECT_LT(a.index, b.index);
            with_ids.push_back(left + right);
        });
        EXPECT_EQ(with_ids, pairs);
    });
}

TEST(Index, AllowsMovesInPairCallbacks) {
    on_several_structures([]<class S>() {
        auto index = four<S>();
        index.pairs([&](auto, auto&, auto b, auto&) { EXPECT_TRUE(index.move(b, cube(5))); });
        index.commit();
        int pairs = 0;
        index.pairs([&](auto&, auto&) { ++pairs; });
        EXPECT_EQ(pairs, 0);
    });
}

TEST(Index, SkipsPairsOfTwoSleepingValues) {
    on_several_structures([]<class S>() {
        Index<int, S> index;
        std::vector<typename Index<int, S>::Id> ids;
        for (int i = 0; i < 6; ++i) ids.push_back(index.insert(cube(static_cast<float>(i)), i));
        for (int i = 0; i < 4; ++i) EXPECT_TRUE(index.set_awake(ids[static_cast<std::size_t>(i)], false));
        index.commit();
        EXPECT_FALSE(index.is_awake(ids[0]));
        EXPECT_TRUE(index.is_awake(ids[5]));
        std::vector<std::pair<int, int>> pairs;
        index.awake_pairs([&](int a, int b) { pairs.emplace_back(a, b); });
        EXPECT_EQ(pairs, (std::vector<std::pair<int, int>>{{3, 4}, {4, 5}}));
    });
}

TEST(Index, FindsPairsWithAnotherIndex) {
    on_several_structures([]<class S>() {
        auto players = four<S>();
        Index<int> walls;
        walls.insert(cube(2), 0);
        walls.insert({{0, 1, 0}, {9, 1, 1}}, 1);
        walls.commit();
        Names touching;
        players.pairs_with(walls,
                           [&](std::string& player, int& wall) { touching.push_back(player + std::to_string(wall)); });
        EXPECT_EQ(touching, (Names{"a1", "b0", "b1", "c0", "c1", "d1"}));
        EXPECT_EQ(walls.size(), 2u);
        Names again;
        players.pairs_with(std::as_const(walls), [&](auto, std::string& player, auto, const int& wall) {
            again.push_back(player + std::to_string(wall));
        });
        EXPECT_EQ(again, touching);
    });
}

TEST(Index, FindsValuesByPosition) {
    on_several_structures([]<class S>() {
        const auto index = four<S>();
        Names found;
        const auto keep = [&](const std::string& name) { found.push_back(name); };
        index.overlapping(in_order, Aabb{{1, 0, 0}, {2.5f, 1, 1}}, keep);
        EXPECT_EQ(std::exchange(found, {}), (Names{"a", "b", "c"}));
        index.overlapping(query::SphereRegion({4, 0.5, 0.5}, 0.5f), keep);
        EXPECT_EQ(std::exchange(found, {}), Names{"c"});
        index.at({1, 0.5, 0.5}, keep);
        std::sort(found.begin(), found.end());
        EXPECT_EQ(std::exchange(found, {}), (Names{"a", "b"}));
        index.for_each([&](auto id, const std::string& name) { found.push_back(name + std::to_string(id.index)); });
        EXPECT_EQ(std::exchange(found, {}), (Names{"a0", "b1", "c2", "d3"}));
        const auto near = index.nearest({4, 0.5, 0.5}, 2);
        ASSERT_EQ(near.size(), 2u);
        EXPECT_EQ(index.value(near[0].id), "c");
        EXPECT_EQ(near[0].distance, 0.5f);
        EXPECT_EQ(index.value(near[1].id), "b");
        EXPECT_EQ(index.nearest({4, 0.5, 0.5}, 9, 1).size(), 1u);
        const auto not_c = index.nearest({4, 0.5, 0.5}, 1, 100, [](const std::string& name) { return name != "c"; });
        ASSERT_EQ(not_c.size(), 1u);
        EXPECT_EQ(index.value(not_c[0].id), "b");
        Frustum ahead;  // x from 2 to 4
        for (std::size_t side = 0; side < 6; ++side) {
            Vec3d normal;
            normal[static_cast<int>(side / 2)] = side % 2 == 0 ? -1 : 1;
            ahead.sides[side] = {normal, side == 0 ? -2.0 : 4.0};
        }
        index.cull(ahead, keep);
        std::sort(found.begin(), found.end());
        EXPECT_EQ(found, (Names{"b", "c"}));
    });
}

TEST(Index, CastsRaysAgainstBoxesOrExactShapes) {
    on_several_structures([]<class S>() {
        const auto index = four<S>();
        const Ray ray{{-3, 0.5, 0.5}, {1, 0, 0}, 100};
        const auto first = index.cast_ray(ray);
        ASSERT_TRUE(first);
        EXPECT_EQ(index.value(first->id), "a");
        EXPECT_NEAR(first->distance, 3, 1e-6);
        EXPECT_FALSE(index.cast_ray({{-3, 5, 0}, {1, 0, 0}, 100}));
        const auto only_late_names = [](const std::string& name, const Aabb&, float entry, float) {
            return name < "c" ? broad::infinite_distance : entry + 0.25f;
        };
        const auto exact = index.cast_ray(ray, only_late_names);
        ASSERT_TRUE(exact);
        EXPECT_EQ(index.value(exact->id), "c");
        EXPECT_NEAR(exact->distance, 5.75, 1e-5);
        std::vector<typename Index<std::string, S>::Hit> all;
        index.cast_ray_through(ray, all);
        ASSERT_EQ(all.size(), 4u);
        EXPECT_EQ(index.value(all[3].id), "d");
    });
}

TEST(Index, VisitsLeavesWithTheirValues) {
    on_several_structures([]<class S>() {
        auto index = four<S>();
        index.for_each_leaf([](auto leaf) {
            for (std::size_t i = 0; i < leaf.size(); ++i)
                if (leaf[i].size() == 1) leaf[i] += "!";
        });
        Names names;
        std::as_const(index).for_each_leaf([&](auto leaf) {
            EXPECT_GE(leaf.depth(), 0);
            for (std::size_t i = 0; i < leaf.size(); ++i) {
                EXPECT_TRUE(overlaps(leaf.cell(), index.box(leaf.id(i))));
                names.push_back(leaf[i]);
            }
        });
        std::sort(names.begin(), names.end());
        names.erase(std::unique(names.begin(), names.end()), names.end());
        EXPECT_EQ(names, (Names{"a!", "b!", "c!", "d!"}));
    });
}

TEST(Index, RejectsStaleIds) {
    Index<std::string> index;
    const auto a = index.insert(cube(0), "a");
    EXPECT_TRUE(index.erase(a));
    EXPECT_FALSE(index.contains(a));
    const auto b = index.insert(cube(1), "b");
    index.commit();
    EXPECT_EQ(b.index, a.index) << "the slot is reused";
    EXPECT_FALSE(index.erase(a));
    EXPECT_FALSE(index.move(a, cube(5)));
    EXPECT_FALSE(index.set_awake(a, false));
    EXPECT_FALSE(index.contains({}));
    EXPECT_TRUE(index.contains(b));
    EXPECT_EQ(index.box(b), cube(1));
    index.clear();
    EXPECT_FALSE(index.contains(b));
    EXPECT_EQ(index.size(), 0u);
}

TEST(Index, FindsTheValueOfAnIdOrNothing) {
    Index<std::string> index;
    const auto a = index.insert(cube(0), "a");
    ASSERT_NE(index.find(a), nullptr);
    EXPECT_EQ(index.find(a), &index.value(a));
    EXPECT_EQ(std::as_const(index).find(a), &index.value(a));
    EXPECT_TRUE(index.erase(a));
    index.insert(cube(1), "b");
    EXPECT_EQ(index.find(a), nullptr) << "not the value that has its proxy now";
    EXPECT_EQ(index.find({}), nullptr);
}

template <class I>
concept TakesThreeNumbers = requires(I index, typename I::Id id) {
    index.insert({5, 5, 5}, 1);
}
|| requires(I index, typename I::Id id) { index.move(id, {5, 5, 5}); };
template <class I>
concept TakesPointsAndBoxes = requires(I index, typename I::Id id) {
    index.insert(Vec3{5, 5, 5}, 1);
    index.move(id, Vec3{5, 5, 5});
    index.insert({{5, 5, 5}, {6, 6, 6}}, 1);
    index.move(id, {{5, 5, 5}, {6, 6, 6}});
};

TEST(Index, TakesPointsButNoThreeNumbersForABox) {
    static_assert(TakesPointsAndBoxes<Index<int>> && !TakesThreeNumbers<Index<int>>);
    on_several_structures([]<class S>() {
        Index<int, S> index;
        const auto id = index.insert(Vec3{5, 5, 5}, 1);
        index.insert(Vec3{5, 5, 8}, 2);
        index.commit();
        EXPECT_EQ(index.box(id), (Aabb{{5, 5, 5}, {5, 5, 5}}));
        int found = 0;
        index.at({5, 5, 5}, [&](int value) { found += value; });
        EXPECT_EQ(found, 1);
        EXPECT_TRUE(index.move(id, Vec3{5, 5, 6}));
        EXPECT_FALSE(index.move({}, Vec3{5, 5, 6}));
        index.commit();
        EXPECT_EQ(index.nearest({5, 5, 5}, 1)[0].distance, 1);
        int near = 0;
        index.neighbours(2, [&](int, int) { ++near; });
        EXPECT_EQ(near, 1);
    });
}

TEST(Index, BulkEditsOfWrongSizesChangeNothing) {
    Index<int> index;
    const std::vector<Aabb> boxes{cube(0), cube(5), cube(9)};
    const std::vector<int> two{1, 2}, three{1, 2, 3}, four{1, 2, 3, 4};
    const std::span<const Aabb> all(boxes);
    ASSERT_TRUE(index.assign(all, three));
    ASSERT_TRUE(index.commit());
    for (const std::vector<int>& values : {two, four}) {
        EXPECT_FALSE(index.insert(all, values));
        EXPECT_FALSE(index.assign(all, values));
    }
    const std::vector<Aabb> moved{cube(20), cube(21), cube(22), cube(23)};
    EXPECT_FALSE(index.move_all(std::span(moved).first(2)));
    EXPECT_EQ(index.size(), 3u);
    EXPECT_EQ(index.box(index.id(0)), cube(0));
    EXPECT_TRUE(index.erase(index.id(1)));
    EXPECT_FALSE(index.move_all(std::span(moved).first(2))) << "proxies keep their numbers";
    EXPECT_EQ(index.box(index.id(2)), cube(9));
    EXPECT_TRUE(index.move_all(std::span(moved))) << "more are ignored";
    EXPECT_EQ(index.box(index.id(2)), cube(22));
    EXPECT_TRUE(index.commit());
}

TEST(Index, FindsInfiniteBoxesAndNeverThoseWithANaN) {
    constexpr float inf = Aabb::infinity, nan = std::numeric_limits<float>::quiet_NaN();
    on_several_structures([]<class S>() {
        Index<int, S> index;
        index.insert({{-inf, 0, 0}, {inf, 1, 1}}, 1);
        index.insert({{nan, 0, 0}, {1, 1, 1}}, 100);
        index.insert(Vec3{0, nan, 0}, 100);
        index.insert(Aabb{}, 100);
        index.insert(cube(50), 2);
        index.commit();
        int sum = 0;
        const auto add = [&](int value) { sum += value; };
        index.overlapping(cube(50), add);
        EXPECT_EQ(std::exchange(sum, 0), 3);
        index.overlapping(query::SphereRegion({0, 0, 0}, 1), add);
        EXPECT_EQ(std::exchange(sum, 0), 1);
        index.at({50.5, 0.5, 0.5}, add);
        EXPECT_EQ(std::exchange(sum, 0), 3);
        index.pairs([&](int a, int b) { sum += a + b; });
        EXPECT_EQ(std::exchange(sum, 0), 3);
        for (const auto& hit : index.nearest({0, 0, 0}, 9)) sum += index.value(hit.id);
        EXPECT_EQ(std::exchange(sum, 0), 3);
        std::vector<typename Index<int, S>::Hit> hits;
        index.cast_ray_through({{60, 0.5, 0.5}, {-1, 0, 0}}, hits);
        EXPECT_EQ(hits.size(), 2u);
    });
}

TEST(Index, TakesAnyRadiusOfNeighbours) {
    Index<int> index;
    for (int i = 0; i < 20; ++i) index.insert(cube(30 * static_cast<float>(i)), i);
    index.insert(cube(0.5f), 20);  // overlaps the first
    index.commit();
    const auto count = [&](float radius) { return index.find_neighbours(radius).size(); };
    EXPECT_EQ(count(0), 1u);
    EXPECT_EQ(count(-0.25f), 0u);
    EXPECT_EQ(count(std::numeric_limits<float>::quiet_NaN()), 0u);
    EXPECT_EQ(count(Aabb::infinity), 210u);
    EXPECT_EQ(count(1e30f), 210u);
    EXPECT_EQ(count(0), 1u);
}

TEST(Index, DestroysErasedValues) {
    const auto shared = std::make_shared<int>(1);
    Index<std::shared_ptr<int>> index;
    const auto id = index.insert(cube(0), shared);
    index.insert(cube(0), shared);
    EXPECT_EQ(shared.use_count(), 3);
    index.erase(id);
    EXPECT_EQ(shared.use_count(), 2);
    index.clear();
    EXPECT_EQ(shared.use_count(), 1);
}

TEST(Index, SupportsRefillingInEachFrame) {
    Index<std::unique_ptr<int>> index;  // values only have to be movable
    Index<std::unique_ptr<int>>::Id last;
    for (int frame = 0; frame < 70'000; ++frame) {
        index.clear();
        last = index.insert(cube(0), std::make_unique<int>(frame));
        index.commit();
    }
    EXPECT_EQ(last.index, 0u);
    EXPECT_EQ(*index.value(last), 69'999);
}

}  // namespace
}  // namespace fase
