// The default structure of an index, neighbours, bulk edits and batches, against brute force.
#include <gtest/gtest.h>

#include <atomic>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include "fase/core/random.hpp"
#include "fase/query/index2.hpp"

namespace fase {
namespace {

using Pairs = std::set<std::pair<int, int>>;

Aabb random_box(Random& random, float reach) {
    const Vec3 at{random.between(-reach, reach), random.between(-reach, reach), random.between(-reach, reach)};
    const Vec3 size{random.between(0, 2), random.below(4) == 0 ? 0 : random.between(0, 3), random.between(0, 1)};
    return {at, at + size};
}

/// An index and what it must hold.
struct Life {
    Index<int> index;
    std::map<int, Index<int>::Id> ids;
    std::map<int, Aabb> boxes;
    std::set<int> asleep;
    int next = 0;

    void edit(Random& random) {
        const float reach = random.below(4) == 0 ? 40.0f : 8.0f;
        if (ids.empty() || random.below(3) == 0) {
            boxes[next] = random_box(random, reach);
            ids[next] = index.insert(boxes[next], next);
            ++next;
            return;
        }
        auto some = ids.begin();
        std::advance(some, static_cast<std::ptrdiff_t>(random.below(ids.size())));
        const int value = some->first;
        const auto act = random.below(8);
        if (act == 0) {
            EXPECT_TRUE(index.erase(some->second));
            EXPECT_FALSE(index.contains(some->second));
            boxes.erase(value);
            asleep.erase(value);
            ids.erase(some);
        } else if (act == 1) {
            const bool rests = random.below(2) == 0;
            EXPECT_TRUE(index.set_awake(some->second, !rests));
            asleep.erase(value);
            if (rests) asleep.insert(value);
        } else {
            boxes[value] = random_box(random, reach);
            EXPECT_TRUE(index.move(some->second, boxes[value]));
        }
    }
    [[nodiscard]] Pairs near(float radius) const {
        Pairs pairs;
        for (const auto& [a, box_a] : boxes)
            for (const auto& [b, box_b] : boxes)
                if (a < b && query::squared_distance(box_a, box_b) <= radius * radius) pairs.emplace(a, b);
        return pairs;
    }
};

template <class Ask> Pairs found_by(const Ask& ask) {
    Pairs pairs;
    ask([&](int a, int b) { EXPECT_TRUE(pairs.emplace(std::min(a, b), std::max(a, b)).second) << "found twice"; });
    return pairs;
}

void check_questions(const Life& life, Random& random) {
    const Index<int>& index = life.index;
    const Aabb region = random_box(random, 8);
    std::set<int> inside, expected;
    index.overlapping(region, [&](int value) { inside.insert(value); });
    for (const auto& [value, box] : life.boxes)
        if (overlaps(region, box)) expected.insert(value);
    EXPECT_EQ(inside, expected);
    const Vec3d point{static_cast<double>(random.between(-9, 9)), 0, 1};
    const auto near = index.nearest(point, 3);
    EXPECT_EQ(near.size(), std::min<std::size_t>(3, life.boxes.size()));
    std::vector<double> distances;
    for (const auto& [value, box] : life.boxes)
        distances.push_back(
            static_cast<double>(broad::PointMeasure(point, Aabb::infinity).distance(box, broad::infinite_distance)));
    std::sort(distances.begin(), distances.end());
    for (std::size_t i = 0; i < near.size(); ++i) EXPECT_EQ(static_cast<double>(near[i].distance), distances[i]);
    std::size_t count = 0;
    for (const auto id : index) {
        EXPECT_TRUE(index.contains(id));
        EXPECT_EQ(index.id(id.index), id);
        ++count;
    }
    EXPECT_EQ(count, life.boxes.size());
    EXPECT_EQ(index.structure().broken_invariant(), "");
}

TEST(IndexByDefault, random_lives_find_what_brute_force_finds) {
    const auto tasks = make_thread_runner(2);
    for (std::uint64_t seed = 0; seed < 12; ++seed) {
        Random random(seed);
        Life life;
        for (int round = 0; round < 40; ++round) {
            const std::size_t edits = random.below(random.below(5) == 0 ? 300 : 12);
            for (std::size_t i = 0; i < edits; ++i) life.edit(random);
            ASSERT_TRUE(life.index.commit());
            if (random.below(3) == 0) continue;  // not asked after each commit
            Index<int>& index = life.index;
            const Pairs touching = life.near(0);
            ASSERT_EQ(found_by([&](const auto& f) { index.pairs(f); }), touching);
            const float radius = random.below(3) == 0 ? random.between(0, 6) : 2.5f;
            const Pairs near = life.near(radius);
            ASSERT_EQ(found_by([&](const auto& f) { index.neighbours(radius, f); }), near) << "seed " << seed;
            std::mutex lock;
            ASSERT_EQ(found_by([&](const auto& f) {
                          index.neighbours(*tasks, radius, [&](int a, int b) {
                              const std::lock_guard guard(lock);
                              f(a, b);
                          });
                      }),
                      near);
            Pairs awake;
            for (const auto& [a, b] : touching)
                if (!life.asleep.contains(a) || !life.asleep.contains(b)) awake.emplace(a, b);
            ASSERT_EQ(found_by([&](const auto& f) { index.awake_pairs(f); }), awake);
            check_questions(life, random);
        }
    }
}

TEST(IndexByDefault, boxes_at_exactly_the_radius_are_neighbours) {
    for (const float far : {0.0f, 1000.0f, -123456.0f}) {
        Index<int> index;
        for (int i = 0; i < 50; ++i) {
            const Vec3 at{far + 3 * static_cast<float>(i), far, far};
            index.insert({at, at}, i);
        }
        ASSERT_TRUE(index.commit());
        int count = 0;
        index.neighbours(3, [&](int, int) { ++count; });
        EXPECT_EQ(count, 49) << far;
    }
}

TEST(IndexByDefault, structures_exist_only_while_they_are_asked) {
    Index<int> index;
    const auto id = index.insert({{0, 0, 0}, {1, 1, 1}}, 7);
    ASSERT_TRUE(index.commit());
    EXPECT_FALSE(index.statistics().has_rows || index.statistics().has_tree || index.statistics().has_neighbours);
    EXPECT_TRUE(index.cast_ray({{-3, 0.5, 0.5}, {1, 0, 0}}));
    EXPECT_TRUE(index.statistics().has_tree);
    EXPECT_FALSE(index.statistics().has_rows);
    index.neighbours(1, [](int, int) {});
    EXPECT_TRUE(index.statistics().has_neighbours);
    const auto play = [&](int frames) {
        for (int frame = 0; frame < frames; ++frame) {
            EXPECT_TRUE(index.move(id, {{0, 0, 0}, {1, 1, 1}}));
            ASSERT_TRUE(index.commit());
            index.pairs([](int, int) {});
        }
    };
    play(600);
    EXPECT_TRUE(index.statistics().has_tree && index.statistics().has_neighbours) << "one question in ten seconds";
    play(1);
    EXPECT_TRUE(index.statistics().has_rows);
    EXPECT_FALSE(index.statistics().has_tree || index.statistics().has_neighbours);
    EXPECT_TRUE(index.cast_ray({{-3, 0.5, 0.5}, {1, 0, 0}})) << "and come back";
}

TEST(IndexByDefault, bulk_edits_take_arrays_of_any_layout) {
    struct Unit {
        char team;
        float place[3];
        float top[3];
    };
    std::vector<Unit> units;
    std::vector<int> numbers;
    for (int i = 0; i < 100; ++i) {
        const float x = 2 * static_cast<float>(i);
        units.push_back({'a', {x, 0, 0}, {x + 1, 1, 1}});
        numbers.push_back(i);
    }
    Index<int> index;
    ASSERT_TRUE(index.assign(StridedBoxes::corners(units[0].place, units[0].top, units.size(), sizeof(Unit)),
                             std::span<const int>(numbers)));
    ASSERT_TRUE(index.commit());
    EXPECT_EQ(index.size(), 100u);
    EXPECT_EQ(index.box(index.id(3)), (Aabb{{6, 0, 0}, {7, 1, 1}}));
    for (Unit& unit : units) unit.place[1] += 5;
    index.move_all(StridedBoxes::centres(units[0].place, {1, 1, 1}, units.size(), sizeof(Unit)));
    ASSERT_TRUE(index.commit());
    EXPECT_EQ(index.box(index.id(3)), (Aabb{{5, 4, -1}, {7, 6, 1}}));
    int pairs = 0;
    index.pairs([&](int a, int b) {
        EXPECT_EQ(b - a, 1);
        ++pairs;
    });
    EXPECT_EQ(pairs, 99) << "cubes of 2 m every 2 m touch";
    std::vector<Aabb> boxes(200, Aabb{{0, 0, 0}, {1, 1, 1}});
    numbers.resize(200);
    ASSERT_TRUE(index.assign(std::span<const Aabb>(boxes), std::span<const int>(numbers)));
    for (std::uint32_t p = 0; p < 200; ++p) EXPECT_EQ(index.value(index.id(p)), numbers[p]);
}

TEST(IndexByDefault, batches_give_what_single_questions_give) {
    Random random(5);
    Index<int> index;
    for (int i = 0; i < 500; ++i) index.insert(random_box(random, 20), i);
    ASSERT_TRUE(index.commit());
    const auto tasks = make_thread_runner(2);
    std::vector<Aabb> regions;
    std::vector<Vec3d> points;
    std::vector<Ray> rays;
    for (int i = 0; i < 100; ++i) {
        regions.push_back(random_box(random, 20));
        points.push_back(to_double(regions.back().lo));
        rays.push_back({points.back(), normalized(Vec3{random.between(-1, 1), random.between(-1, 1), 0.3f}), 50});
    }
    for (TaskRunner* runner : {static_cast<TaskRunner*>(nullptr), tasks.get()}) {
        query::Lists<broad::Proxy> inside;
        query::Lists<query::Hit> near;
        std::vector<query::Hit> hits;
        index.overlapping(std::span<const Aabb>(regions), inside, runner);
        index.nearest(points, 4, 30, near, runner);
        index.cast_rays(rays, hits, runner);
        for (std::size_t i = 0; i < regions.size(); ++i) {
            std::vector<broad::Proxy> one;
            index.overlapping(in_order, regions[i], [&](Index<int>::Id id) { one.push_back(id.index); });
            EXPECT_TRUE(std::ranges::equal(inside[i], one));
            const auto single = index.nearest(points[i], 4, 30);
            ASSERT_EQ(near[i].size(), single.size());
            for (std::size_t k = 0; k < single.size(); ++k) EXPECT_EQ(near[i][k].proxy, single[k].id.index);
            const auto hit = index.cast_ray(rays[i]);
            EXPECT_EQ(hits[i].is_hit(), hit.has_value());
            EXPECT_EQ(hits[i].proxy, hit ? hit->id.index : no_index);
        }
    }
}

TEST(IndexByDefault, const_questions_may_come_from_several_threads_at_once) {
    Random random(6);
    Index<int> index;
    for (int i = 0; i < 2000; ++i) index.insert(random_box(random, 30), i);
    for (int round = 0; round < 5; ++round) {
        for (const auto id : index)
            if (random.below(4) == 0) index.move(id, random_box(random, 30));
        ASSERT_TRUE(index.commit());
        std::atomic<int> sum = 0;
        std::vector<std::thread> threads;
        for (int t = 0; t < 4; ++t)
            threads.emplace_back([&index = std::as_const(index), &sum, t] {
                int found = 0;
                if (t % 2 == 0) {
                    index.overlapping(Aabb{{-9, -9, -9}, {9, 9, 9}}, [&](int) { ++found; });
                } else {
                    found = static_cast<int>(index.nearest({0, 0, 0}, 50).size());
                }
                sum += found;
            });
        for (std::thread& thread : threads) thread.join();
        int inside = 0;
        index.overlapping(Aabb{{-9, -9, -9}, {9, 9, 9}}, [&](int) { ++inside; });
        EXPECT_EQ(sum, 2 * inside + 2 * 50);
    }
}

TEST(IndexByDefault, moved_indices_keep_their_values) {
    Index<int> first;
    const auto id = first.insert({{0, 0, 0}, {1, 1, 1}}, 5);
    ASSERT_TRUE(first.commit());
    first.pairs([](int, int) {});
    Index<int> second = std::move(first);
    int found = 0;
    second.at({0.5, 0.5, 0.5}, [&](int value) { found = value; });
    EXPECT_EQ(found, 5);
    EXPECT_EQ(second.value(id), 5);
}

TEST(Index2, asks_in_the_plane) {
    Index2<int> map;
    Random random(8);
    std::vector<Vec2> places;
    for (int i = 0; i < 300; ++i) {
        places.push_back({random.between(0, 100), random.between(0, 100)});
        map.insert(places.back(), i);
    }
    const auto house = map.insert(Aabb2{{200, 200}, {210, 220}}, 1000);
    ASSERT_TRUE(map.commit());
    EXPECT_EQ(map.box(house), (Aabb2{{200, 200}, {210, 220}}));
    std::set<int> inside, expected;
    map.within({50, 50}, 20, [&](int value) { inside.insert(value); });
    for (int i = 0; i < 300; ++i) {
        const Vec2 p = places[static_cast<std::size_t>(i)];
        if (std::hypot(p.x - 50, p.y - 50) <= 20) expected.insert(i);
    }
    EXPECT_EQ(inside, expected);
    EXPECT_EQ(map.value(map.nearest({204, 230}, 1)[0].id), 1000);
    EXPECT_EQ(map.nearest({204, 230}, 1)[0].distance, 10);
    const auto hit = map.cast_ray({205, 300}, {0, -1});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->distance, 80, 1e-4);
    int at = 0;
    map.at({203, 203}, [&](int value) { at = value; });
    EXPECT_EQ(at, 1000);
    int close = 0, brute = 0;
    map.neighbours(3, [&](int, int) { ++close; });
    for (std::size_t i = 0; i < places.size(); ++i)
        for (std::size_t j = 0; j < i; ++j)
            brute += std::hypot(places[i].x - places[j].x, places[i].y - places[j].y) <= 3 ? 1 : 0;
    EXPECT_EQ(close, brute);
    ASSERT_TRUE(map.move(house, Vec2{1, 1}));
    ASSERT_TRUE(map.erase(house));
    ASSERT_TRUE(map.commit());
    EXPECT_EQ(map.size(), 300u);
}

}  // namespace
}  // namespace fase
