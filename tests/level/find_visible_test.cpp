/// Compares visible sets and visible areas with rays.
#include "fase/level/find_visible.hpp"

#include <gtest/gtest.h>

#include "fase/level/seen_from.hpp"
#include "fase/level/visibility/doorways.hpp"
#include "tests/level/freedoom.hpp"

namespace fase::level {
namespace {

/// Counts passages of random rays into sub-sectors that the sets report as hidden.
struct Checked {
    std::size_t passages = 0, falsely_hidden = 0;
};
Checked check_by_rays(const Level& level, const VisibleSets& sets, Heights heights, int rays) {
    Checked checked;
    const PlanBox box = box_of(level.bsp);
    Random random(9);
    std::vector<Passage> path;
    for (int i = 0; i < rays; ++i) {
        const LevelRay ray = ray_inside(level, box, random);
        const std::uint32_t from = *sub_sector_at(level.bsp, ray.from);
        path.clear();
        passages(level.bsp, level.map, ray, heights, path);
        for (const Passage& passage : path) {
            ++checked.passages;
            checked.falsely_hidden += sets.sees(from, passage.sub_sector) ? 0 : 1;
        }
    }
    return checked;
}

Level grid(const std::vector<std::string>& rows) {
    Level level{"grid", grid_map(rows, [](char c) { return c == 'c' ? std::pair{0, 0} : std::pair{0, 128}; }), {}};
    level.bsp = *compile(level.map);
    return level;
}

TEST(VisibleSets, RoundTripBits) {
    for (const std::size_t count : {0u, 1u, 63u, 64u, 65u, 700u}) {
        for (const int density : {0, 1, 40, 128, 255, 256}) {
            Random random(count * 1000 + static_cast<std::size_t>(density));
            std::vector<std::vector<std::uint64_t>> rows(count, std::vector<std::uint64_t>((count + 63) / 64, 0));
            for (auto& row : rows)
                for (std::size_t i = 0; i < count; ++i)
                    if (random.below(256) < static_cast<std::uint64_t>(density)) row[i / 64] |= 1ull << i % 64;
            const VisibleSets sets =
                VisibleSets::of(count, [&](std::size_t i) -> std::span<const std::uint64_t> { return rows[i]; });
            ASSERT_EQ(sets.size(), count);
            std::size_t pairs = 0;
            for (std::uint32_t a = 0; a < count; ++a) {
                std::vector<std::uint32_t> expected, seen;
                for (std::uint32_t b = 0; b < count; ++b)
                    if ((rows[a][b / 64] >> b % 64 & 1) != 0) expected.push_back(b);
                sets.for_each_seen(a, [&](std::uint32_t b) { seen.push_back(b); });
                EXPECT_EQ(seen, expected);
                EXPECT_EQ(sets.seen_by(a), expected.size());
                pairs += expected.size();
                for (std::uint32_t b = 0; b < count; b += 7)
                    EXPECT_EQ(sets.sees(a, b), (rows[a][b / 64] >> b % 64 & 1) != 0);
            }
            EXPECT_EQ(sets.pairs(), pairs);
        }
    }
}

TEST(FindVisible, HidesNothingThatARayReaches) {
    const auto levels = freedoom_levels({"e1m1.wad", "map07.wad", "map29.wad", "e4m5.wad"});
    if (levels.empty()) GTEST_SKIP() << "skipped: no levels in " << FASE_SHARED_DATA;
    for (const Level& level : levels) {
        for (const Heights heights : {Heights::Ignored, Heights::Counted}) {
            const auto found = find_visible(level.bsp, level.map, {.heights = heights});
            ASSERT_TRUE(found);
            const Checked checked = check_by_rays(level, found->sets, heights, 20000);
            EXPECT_EQ(checked.falsely_hidden, 0u) << level.name;
            EXPECT_GT(checked.passages, 20000u);
            const std::size_t n = level.bsp.sub_sectors.size();
            EXPECT_LT(found->stats.pairs, n * n * 6 / 10) << level.name;
            EXPECT_EQ(found->stats.coarse, 0u);
        }
    }
}

TEST(FindVisible, ReportsFewFalsePairs) {
    const auto levels = freedoom_levels({"e1m1.wad"});
    if (levels.empty()) GTEST_SKIP() << "skipped: no levels in " << FASE_SHARED_DATA;
    const Level& level = levels[0];
    const auto found = find_visible(level.bsp, level.map);
    ASSERT_TRUE(found);
    // The sets must contain at least the pairs that random points see.
    const std::size_t n = level.bsp.sub_sectors.size();
    std::vector<std::uint8_t> visible(n * n, 0);
    const PlanBox box = box_of(level.bsp);
    Random random(12);
    for (int i = 0; i < 8000; ++i) {
        const Point p = point_inside(level.bsp, box, random);
        const std::uint32_t from = *sub_sector_at(level.bsp, p);
        const auto seen = seen_from(level.bsp, level.map, {p, 0});
        ASSERT_TRUE(seen);
        for (const std::uint32_t to : seen->sub_sectors) {
            EXPECT_TRUE(found->sets.sees(from, to));
            visible[from * n + to] = visible[to * n + from] = 1;
        }
    }
    const auto least = static_cast<std::size_t>(std::count(visible.begin(), visible.end(), std::uint8_t{1}));
    EXPECT_LT(found->stats.pairs, least * 23 / 20);
}

TEST(FindVisible, HidesWhatIsBehindCorners) {
    // An L of squares: its two ends do not see each other, but squares near the corner do.
    const Level level = grid({"aaaaaa", "     a", "     a", "     a", "     a"});
    const auto found = find_visible(level.bsp, level.map);
    ASSERT_TRUE(found);
    const auto at = [&](double x, double y) { return *sub_sector_at(level.bsp, {x * 64 + 32, y * 64 + 32}); };
    EXPECT_FALSE(found->sets.sees(at(0, 4), at(5, 0)));
    EXPECT_FALSE(found->sets.sees(at(5, 0), at(0, 4)));
    EXPECT_TRUE(found->sets.sees(at(0, 4), at(5, 4)));
    EXPECT_TRUE(found->sets.sees(at(5, 0), at(5, 4)));
    EXPECT_TRUE(found->sets.sees(at(4, 4), at(5, 3)));
}

TEST(FindVisible, ClosedDoorsHideOnlyWithHeights) {
    const Level level = grid({"aaacaaa"});
    const auto at = [&](double x) { return *sub_sector_at(level.bsp, {x * 64 + 32, 32}); };
    const auto open = find_visible(level.bsp, level.map);
    const auto shut = find_visible(level.bsp, level.map, {.heights = Heights::Counted});
    ASSERT_TRUE(open && shut);
    EXPECT_TRUE(open->sets.sees(at(0), at(6)));
    EXPECT_FALSE(shut->sets.sees(at(0), at(6)));
    EXPECT_TRUE(shut->sets.sees(at(0), at(2)));
}

TEST(FindVisible, LowAndHighGapsInARowHide) {
    // No straight line passes a low gap and, close behind it, a high one, and goes far.
    const auto room = [](char c) {
        return c == 'l' ? std::pair{0, 8} : c == 'h' ? std::pair{120, 128} : std::pair{0, 128};
    };
    Level level{"gaps", grid_map({"aaalhaaa"}, room), {}};
    level.bsp = *compile(level.map);
    const auto at = [&](double x) { return *sub_sector_at(level.bsp, {x * 64 + 32, 32}); };
    const auto counted = find_visible(level.bsp, level.map, {.heights = Heights::Counted});
    ASSERT_TRUE(counted);
    EXPECT_FALSE(counted->sets.sees(at(0), at(7)));
    Level straight{"straight", grid_map({"aaallaaa"}, room), {}};
    straight.bsp = *compile(straight.map);
    const auto through = find_visible(straight.bsp, straight.map, {.heights = Heights::Counted});
    ASSERT_TRUE(through);
    EXPECT_TRUE(through->sets.sees(*sub_sector_at(straight.bsp, {32, 32}), *sub_sector_at(straight.bsp, {480, 32})));
}

TEST(FindVisible, IsSymmetricAndSeesItself) {
    const Level level = grid({"aaaaa", "a a a", "aaaaa", "a   a", "aacaa"});
    const auto found = find_visible(level.bsp, level.map);
    ASSERT_TRUE(found);
    for (std::uint32_t a = 0; a < found->sets.size(); ++a) {
        EXPECT_TRUE(found->sets.sees(a, a));
        for (std::uint32_t b = 0; b < a; ++b) EXPECT_EQ(found->sets.sees(a, b), found->sets.sees(b, a));
    }
}

TEST(FindVisible, ReturnsCoarseSetsWhenStepsRunOut) {
    const auto levels = freedoom_levels({"e1m1.wad"});
    if (levels.empty()) GTEST_SKIP() << "skipped: no levels in " << FASE_SHARED_DATA;
    const Level& level = levels[0];
    const auto fine = find_visible(level.bsp, level.map);
    const auto some = find_visible(level.bsp, level.map, {.max_steps = 300});
    const auto coarse = find_visible(level.bsp, level.map, {.max_steps = 0});
    ASSERT_TRUE(fine && some && coarse);
    EXPECT_GT(some->stats.coarse, 0u);
    EXPECT_LT(some->stats.coarse, some->stats.openings);
    EXPECT_EQ(coarse->stats.coarse, coarse->stats.openings);
    EXPECT_LT(fine->stats.pairs, some->stats.pairs);
    EXPECT_LT(some->stats.pairs, coarse->stats.pairs);
    EXPECT_EQ(check_by_rays(level, some->sets, Heights::Ignored, 3000).falsely_hidden, 0u);
    EXPECT_EQ(check_by_rays(level, coarse->sets, Heights::Ignored, 3000).falsely_hidden, 0u);
}

TEST(FindVisible, ReturnsTheSameSetsForAnyNumberOfThreads) {
    const auto levels = freedoom_levels({"e1m1.wad"});
    if (levels.empty()) GTEST_SKIP() << "skipped: no levels in " << FASE_SHARED_DATA;
    const auto two = make_thread_runner(2), three = make_thread_runner(3);
    const auto alone = find_visible(levels[0].bsp, levels[0].map);
    for (TaskRunner* tasks : {two.get(), three.get()}) {
        const auto found = find_visible(levels[0].bsp, levels[0].map, {.tasks = tasks});
        ASSERT_TRUE(alone && found);
        EXPECT_EQ(found->sets, alone->sets);
        EXPECT_EQ(found->stats.steps, alone->stats.steps);
    }
}

TEST(FindVisible, RejectsTooLittleMemory) {
    const Level level = grid({"aaaaa"});
    const auto refused = find_visible(level.bsp, level.map, {.max_bytes = 3});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.status(), Status::Capacity);
    EXPECT_EQ(refused.error().where, "VisibleOptions.max_bytes");
}

TEST(SeenFrom, ContainsWhatRaysReach) {
    auto levels = freedoom_levels({"e1m1.wad", "map07.wad"});
    levels.push_back(grid({"aaaaa", "a a a", "aaaaa", "a   a", "aacaa"}));
    for (const Level& level : levels) {
        const PlanBox box = box_of(level.bsp);
        Random random(21);
        for (int i = 0; i < 40; ++i) {
            LevelRay ray = ray_inside(level, box, random);
            for (const Heights heights : {Heights::Ignored, Heights::Counted}) {
                const auto seen = seen_from(level.bsp, level.map, {ray.from, ray.z}, heights);
                ASSERT_TRUE(seen);
                EXPECT_TRUE(seen->complete);
                for (int k = 0; k < 100; ++k) {
                    ray.direction = {double(random.between(-1, 1)), double(random.between(-1, 1))};
                    ray.rise = double(random.between(-0.5f, 0.5f));
                    std::vector<Passage> path;
                    passages(level.bsp, level.map, ray, heights, path);
                    for (const Passage& passage : path) {
                        if (passage.to - passage.from < 1e-6 * passage.to) continue;
                        EXPECT_TRUE(
                            std::binary_search(seen->sub_sectors.begin(), seen->sub_sectors.end(), passage.sub_sector))
                            << level.name;
                    }
                }
            }
        }
    }
}

TEST(SeenFrom, HasTheAreaThatRaysReach) {
    // A square of 3 by 3 cells around a pillar, seen from the middle of a side.
    const Level level = grid({"aaa", "a a", "aaa"});
    const auto all = seen_from(level.bsp, level.map, {{96, 32}, 0});
    ASSERT_TRUE(all);
    // At least the lower row, at most also the columns beside the pillar.
    const double lower = 192 * 64, column = 64 * 128;
    EXPECT_LT(all->area, lower + 2 * column);
    EXPECT_GT(all->area, lower);
    // Compares with the number of random points that a line from the eye reaches.
    Random random(30);
    const PlanBox box = box_of(level.bsp);
    int seen = 0;
    constexpr int samples = 40000;
    for (int i = 0; i < samples; ++i) {
        const Point p = point_in(box, random);
        if (!sub_sector_at(level.bsp, p)) continue;
        const auto hit = cast_ray(level.bsp, level.map, {{96, 32}, 0, {p.x - 96, p.y - 32}, 0, 1}, Heights::Ignored);
        seen += hit ? 0 : 1;
    }
    EXPECT_NEAR(all->area, 192.0 * 192.0 * seen / samples, 192 * 192 * 0.02);
}

/// Returns random lines that overlap, with sectors that are not closed.
Map scribble(std::uint64_t seed) {
    Random random(seed);
    Map map;
    map.name = "MAP01";
    for (int i = 0; i < 3; ++i) {
        Sector sector;
        sector.floor = static_cast<std::int16_t>(random.below(100));
        sector.ceiling = static_cast<std::int16_t>(50 + random.below(100));
        map.sectors.push_back(sector);
    }
    const auto coordinate = [&] { return static_cast<std::int16_t>(8 * random.below(20)); };
    for (int i = 0; i < 24; ++i) map.vertices.push_back({coordinate(), coordinate()});
    for (int i = 0; i < 30; ++i) {
        Line line;
        line.from = static_cast<std::uint16_t>(random.below(24));
        line.to = static_cast<std::uint16_t>(random.below(24));
        for (std::uint16_t* side : {&line.right, &line.left}) {
            if (side == &line.left && random.below(2) == 0) continue;
            *side = static_cast<std::uint16_t>(map.sides.size());
            Side one;
            one.sector = static_cast<std::uint16_t>(random.below(3));
            map.sides.push_back(one);
        }
        map.lines.push_back(line);
    }
    return map;
}

TEST(FindVisible, HandlesMalformedMaps) {
    int compiled = 0;
    for (std::uint64_t seed = 0; seed < 24; ++seed) {
        Level level{"scribble", scribble(seed), {}};
        auto bsp = compile(level.map);
        if (!bsp) continue;
        ++compiled;
        level.bsp = *std::move(bsp);
        const PlanBox box = box_of(level.bsp);
        Random random(seed);
        for (const Heights heights : {Heights::Ignored, Heights::Counted}) {
            const auto found = find_visible(level.bsp, level.map, {.heights = heights});
            ASSERT_TRUE(found);
            std::vector<Passage> path;
            for (int i = 0; i < 300; ++i) {
                const Point from = point_in(box, random);
                const auto cell = sub_sector_at(level.bsp, from);
                const LevelRay ray{from, 60, {double(random.between(-1, 1)), double(random.between(-1, 1))}, 0};
                EXPECT_EQ(cast_ray(level.bsp, level.map, ray, heights).has_value(),
                          cast_ray_brute_force(level.bsp, level.map, ray, heights).has_value());
                EXPECT_EQ(seen_from(level.bsp, level.map, {from, 60}, heights).has_value(), cell.has_value());
                if (!cell || heights == Heights::Counted) continue;
                path.clear();
                passages(level.bsp, level.map, ray, heights, path);
                for (const Passage& passage : path)
                    EXPECT_TRUE(found->sets.sees(*cell, passage.sub_sector)) << "seed " << seed;
            }
        }
    }
    EXPECT_GT(compiled, 20);
}

TEST(SeenFrom, ReturnsNulloptOutside) {
    const Level level = grid({"aaa"});
    EXPECT_FALSE(seen_from(level.bsp, level.map, {{-50, 0}, 0}));
    EXPECT_FALSE(seen_from(level.bsp, level.map, {{std::numeric_limits<double>::quiet_NaN(), 0}, 0}));
}

}  // namespace
}  // namespace fase::level
