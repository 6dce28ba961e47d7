#include "fase/broad/row_grid.hpp"

#include <gtest/gtest.h>
#include <hwy/targets.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "fase/broad/brute_force.hpp"
#include "fase/broad/find_pairs.hpp"
#include "fase/broad/stats.hpp"
#include "fase/core/random.hpp"
#include "tests/broad/drawn_boxes.hpp"

namespace fase::broad {
namespace {

using Rows = RowGrid::Settings::Rows;

std::vector<Pair> found(const RowGrid& grid) {
    std::vector<Pair> pairs;
    grid.find_pairs(pairs);
    return pairs;
}
RowGrid grid_of(const std::vector<Move>& boxes, const RowGrid::Settings& settings = {}) {
    RowGrid grid(settings);
    grid.build(boxes);
    return grid;
}

/// Runs `body` once for every instruction set of this machine, with its name.
template <class Body> void for_each_target(Body&& body) {
    for (std::int64_t rest = hwy::SupportedTargets(); rest != 0; rest &= rest - 1) {
        const std::int64_t target = rest & -rest;
        hwy::SetSupportedTargetsForTest(target);
        body(hwy::TargetName(target));
    }
    hwy::SetSupportedTargetsForTest(0);
}

TEST(RowGrid, FindsTheSamePairsInTheSameOrderWithEveryInstructionSet) {
    std::vector<Move> boxes = gas(3000, 1);
    for (Proxy p = 0; p < 200; ++p) boxes[p].box.hi += Vec3{4, 2, 6};  // some on upper levels
    for (const Rows rows : {Rows::Table, Rows::List}) {
        std::vector<Pair> first;
        for_each_target([&](const char* name) {
            SCOPED_TRACE(name);
            RowGrid grid = grid_of(boxes, {.rows = rows});
            for (Proxy p = 1000; p < 1400; ++p) grid.set_awake(p, false);
            grid.commit();
            ASSERT_EQ(grid.broken_invariant(), "");
            const std::vector<Pair> pairs = found(grid);
            if (first.empty()) first = pairs;
            EXPECT_TRUE(pairs == first);
        });
        std::sort(first.begin(), first.end());
        EXPECT_EQ(first, reference_pairs(boxes));
    }
}

TEST(RowGrid, FindsTheSamePairsInTheSameOrderWithAnyNumberOfThreads) {
    RowGrid grid = grid_of(gas(30000, 2));
    for (Proxy p = 0; p < 30000; p += 3) grid.set_awake(p, false);
    grid.insert(30000, Aabb::everything());
    grid.commit();
    const std::vector<Pair> serial = found(grid);
    for (const int threads : {1, 2, 3, 8}) {
        const auto tasks = make_thread_runner(threads);
        std::vector<Pair> pairs{{7, 9}};  // existing pairs stay
        grid.find_pairs(*tasks, pairs);
        ASSERT_EQ(pairs.front(), (Pair{7, 9}));
        pairs.erase(pairs.begin());
        EXPECT_TRUE(pairs == serial) << threads;
    }
}

TEST(RowGrid, StoresTheSameWithAnyNumberOfThreads) {
    std::vector<Move> boxes = gas(70000, 12);
    for (Proxy p = 0; p < 70000; p += 100) boxes[p].box.hi += Vec3{4, 2, 6};  // some on upper levels
    boxes[7].box = Aabb::everything();
    for (const Rows rows : {Rows::Table, Rows::List}) {
        std::vector<Pair> serial;
        for (const int threads : {1, 2, 3, 8}) {
            const auto tasks = make_thread_runner(threads);
            RowGrid grid({.rows = rows});
            for (const Move& m : boxes) grid.insert(m.proxy, m.box);
            grid.commit(*tasks);
            for (Proxy p = 0; p < 70000; ++p) grid.move(p, boxes[69999 - p].box);
            grid.commit(*tasks);
            ASSERT_EQ(grid.broken_invariant(), "");
            if (threads == 1) serial = found(grid);
            EXPECT_TRUE(found(grid) == serial) << threads;
        }
    }
}

TEST(RowGrid, StoresTheSameWhenBoxesExceedTheCaches) {
    const std::vector<Move> boxes = gas(row_grid::out_of_cache_boxes + 5, 14);
    std::vector<Pair> serial;
    for (const int threads : {1, 2, 3}) {
        const auto tasks = make_thread_runner(threads);
        RowGrid grid;
        for (const Move& m : boxes) grid.insert(m.proxy, m.box);
        grid.commit(*tasks);
        ASSERT_EQ(grid.broken_invariant(), "");
        if (threads == 1) serial = found(grid);
        EXPECT_TRUE(found(grid) == serial) << threads;
    }
}

TEST(RowGrid, ReclassifiesRegularAndUnboundedBoxesAtCommit) {
    const float nan = std::nanf("");
    const std::array<Aabb, 4> unbounded{Aabb::everything(), Aabb{{1, 1, 1}, {0, 0, 0}}, Aabb{{nan, 0, 0}, {1, 1, 1}},
                                        Aabb{{0, 0, -1e18f}, {1, 1, 1}}};
    for_each_target([&](const char* name) {
        SCOPED_TRACE(name);
        std::vector<Move> boxes = gas(2000, 13);
        const std::vector<Move> usual = boxes;
        RowGrid grid = grid_of(boxes);
        for (int step = 0; step < 6; ++step) {
            for (Proxy p = 0; p < 2000; ++p) {
                boxes[p].box = (p + static_cast<Proxy>(step)) % 300 == 0 ? unbounded[p / 300 % 4] : usual[p].box;
                grid.move(p, boxes[p].box);
            }
            if (step == 4) {  // all boxes
                for (Move& m : boxes) m.box = unbounded[m.proxy % 4];
                for (const Move& m : boxes) grid.move(m.proxy, m.box);
            }
            grid.commit();
            ASSERT_EQ(grid.broken_invariant(), "");
            ASSERT_EQ(sorted_pairs(grid), reference_pairs(boxes));
        }
    });
}

TEST(RowGrid, FindsEveryPairOfALatticeOfTouchingBoxes) {
    constexpr std::uint32_t side = 24;
    for (const Vec3 at : {Vec3{}, Vec3{100000, -100000, 0}, Vec3{-12, -12, -12}}) {
        std::vector<Move> boxes;
        for (std::uint32_t k = 0; k < side * side * side; ++k) {
            const Vec3 lo = at + Vec3{static_cast<float>(k % side), static_cast<float>(k / side % side),
                                      static_cast<float>(k / side / side)};
            boxes.push_back({k, {lo, lo + Vec3{1, 1, 1}}});
        }
        for (const Rows rows : {Rows::Table, Rows::List}) {
            const RowGrid grid = grid_of(boxes, {.rows = rows});
            EXPECT_EQ(grid.broken_invariant(), "");
            constexpr std::size_t along = 3 * side - 2;  // neighbours of all boxes of a line, themselves included
            EXPECT_EQ(found(grid).size(), (along * along * along - boxes.size()) / 2);
        }
    }
}

TEST(RowGrid, DistinguishesTouchingFromBarelySeparated) {
    const float after_one = std::nextafter(1.0f, 2.0f);
    for (int axis = 0; axis < 3; ++axis) {
        std::vector<Move> boxes = gas(500, 3, {50, 50, 50});  // so that the grid has cells
        Aabb apart{{0, 0, 0}, {1, 1, 1}}, touching = apart;
        apart.lo[axis] = after_one;
        apart.hi[axis] = 2;
        touching.lo[axis] = 1;
        touching.hi[axis] = 2;
        boxes.push_back({500, {{0, 0, 0}, {1, 1, 1}}});
        boxes.push_back({501, touching});
        boxes.push_back({502, apart});
        for (const Rows rows : {Rows::Table, Rows::List}) {
            const std::vector<Pair> pairs = sorted_pairs(grid_of(boxes, {.rows = rows}));
            EXPECT_TRUE(std::binary_search(pairs.begin(), pairs.end(), Pair{500, 501}));
            EXPECT_FALSE(std::binary_search(pairs.begin(), pairs.end(), Pair{500, 502}));
        }
    }
}

TEST(RowGrid, TreatsMinusZeroAsZero) {
    std::vector<Move> boxes{{0, {{-1, -1, -1}, {-0.0f, -0.0f, -0.0f}}}, {1, {{0.0f, 0.0f, 0.0f}, {1, 1, 1}}}};
    for (const Rows rows : {Rows::Table, Rows::List})
        EXPECT_EQ(found(grid_of(boxes, {.rows = rows})), (std::vector<Pair>{{0, 1}}));
    const std::vector<Move> query_box{{2, boxes[0].box}};
    for (const Move& stored : {Move{1, boxes[1].box}, Move{1, {{-0.0f, -0.0f, -0.0f}, {1, 1, 1}}}}) {
        std::vector<Pair> pairs;
        grid_of({stored}).find_pairs_of(query_box, {}, pairs);
        EXPECT_EQ(pairs, (std::vector<Pair>{{1, 2}}));
    }
}

TEST(RowGrid, GivesTheSameResultForBulkMovesAndSingleMoves) {
    const auto many = make_thread_runner(3);
    const std::vector<Move> boxes = gas(50000, 12);
    for (TaskRunner* const tasks : {static_cast<TaskRunner*>(nullptr), many.get()}) {
        RowGrid together = grid_of(boxes), apart = grid_of(boxes);
        for (RowGrid* const grid : {&together, &apart}) {  // one in ten rests
            for (Proxy p = 0; p < boxes.size(); p += 10) grid->set_awake(p, false);
            grid->commit();
        }
        Random random(6);
        std::vector<Aabb> by_proxy;
        for (const Move& m : boxes) by_proxy.push_back(m.box);
        for (const std::uint32_t one_in : {1u, 2u, 1000u, 1u, 3u, 1u}) {
            std::vector<Proxy> proxies;
            std::vector<Move> moves;
            for (Proxy p = 0; p < boxes.size(); ++p) {
                if (random.below(one_in) != 0) continue;
                const Vec3 by = place(random, -1, 1);
                by_proxy[p] = {boxes[p].box.lo + by, boxes[p].box.hi + by};
                if (random.below(5000) == 0) by_proxy[p] = Aabb::everything();
                proxies.push_back(p);
                moves.push_back({p, by_proxy[p]});
                apart.move(p, by_proxy[p]);
            }
            if (one_in == 2) {
                together.move(tasks, moves);
            } else {
                together.move(tasks, proxies, by_proxy);
            }
            together.commit();
            apart.commit();
            ASSERT_EQ(together.broken_invariant(), "");
            ASSERT_TRUE(sorted_pairs(together) == sorted_pairs(apart)) << one_in;
        }
    }
}

TEST(RowGrid, KeepsItsCellsSmallWhenOneBoxIsFarAway) {
    std::vector<Move> boxes = gas(8000, 4);
    const std::size_t usual = stats_of(grid_of(boxes)).largest_leaf;
    for (const float far : {5e4f, -1e6f, 9e16f}) {
        boxes[17].box = {{far, far, far}, {far, far, far}};
        const RowGrid grid = grid_of(boxes);
        EXPECT_EQ(grid.broken_invariant(), "");
        EXPECT_LE(stats_of(grid).largest_leaf, 2 * usual);
        EXPECT_EQ(sorted_pairs(grid), reference_pairs(boxes));
    }
}

TEST(RowGrid, AdaptsItsCellsToADriftingAndGrowingWorld) {
    std::vector<Move> boxes = gas(4000, 5);
    RowGrid grid = grid_of(boxes);
    const std::size_t usual = stats_of(grid).largest_leaf;
    for (int step = 0; step < 150; ++step) {
        const float growth = step < 75 ? 1.0f : 1.02f;
        for (Move& m : boxes) {
            const Vec3 lo = m.box.lo * growth + Vec3{3, -1, 0.5f}, sides = extent(m.box);
            m.box = {lo, lo + sides};
            grid.move(m.proxy, m.box);
        }
        grid.commit();
        ASSERT_EQ(grid.broken_invariant(), "");
        ASSERT_LE(stats_of(grid).largest_leaf, 3 * usual) << step;
        if (step % 15 == 14) {
            ASSERT_EQ(sorted_pairs(grid), reference_pairs(boxes));
        }
    }
}

TEST(RowGrid, AdaptsItsCellsImmediatelyWhenAllBoxesJump) {
    std::vector<Move> boxes = gas(4000, 6);
    RowGrid grid = grid_of(boxes);
    const std::size_t usual = stats_of(grid).largest_leaf;
    for (Move& m : boxes) {
        m.box = {m.box.lo + Vec3{7000, 0, 0}, m.box.hi + Vec3{7000, 0, 0}};
        grid.move(m.proxy, m.box);
    }
    grid.commit();
    EXPECT_LE(stats_of(grid).largest_leaf, 2 * usual);
    EXPECT_EQ(sorted_pairs(grid), reference_pairs(boxes));
}

/// Clusters at random places of a large world: `together` boxes each, spread over `spread` metres.
std::vector<Move> far_clusters(std::size_t count, std::uint64_t seed, std::size_t together, float spread,
                               float half_world = 5e5f) {
    Random random(seed);
    std::vector<Move> boxes;
    Vec3 at;
    for (Proxy p = 0; p < count; ++p) {
        if (p % together == 0) at = place(random, -half_world, half_world);
        const Vec3 lo = at + place(random, 0, spread);
        boxes.push_back({p, {lo, lo + place(random, 0.5f, 1.5f)}});
    }
    return boxes;
}

TEST(RowGrid, ListsTheRowsOfAWorldThatIsNearlyEmpty) {
    const std::vector<Move> boxes = far_clusters(6000, 7, 1000, 13);
    const RowGrid grid = grid_of(boxes);
    EXPECT_EQ(grid.broken_invariant(), "");
    EXPECT_EQ(sorted_pairs(grid), reference_pairs(boxes));
    EXPECT_LT(stats_of(grid).largest_leaf, 64u) << "a cluster of a thousand boxes is in one cell";
}

TEST(RowGrid, UsesMoreCellsWhenBoxesCrowdInAFewOfThem) {
    // The boxes occupy a thousandth of the world: with four cells for five boxes, the used cells would hold many.
    const std::vector<Move> boxes = far_clusters(20000, 12, 2500, 18, 90);
    const RowGrid grid = grid_of(boxes);
    EXPECT_EQ(grid.broken_invariant(), "");
    EXPECT_EQ(sorted_pairs(grid), reference_pairs(boxes));
    const StructureStats stats = stats_of(grid);
    EXPECT_LT(stats.entries, 16 * stats.leaves);
    EXPECT_LE(grid.bytes(), 84 * boxes.size());
    const StructureStats fewer = stats_of(grid_of(boxes, {.cells_per_box = 0.16f}));
    EXPECT_GT(fewer.entries, 40 * fewer.leaves) << "the grid above has no more cells than usual";
}

TEST(RowGrid, LimitsItsMemoryByTheNumberOfBoxes) {
    Random random(8);
    std::vector<std::vector<Move>> worlds{gas(20000, 8), far_clusters(20000, 9, 1000, 13),
                                          far_clusters(20000, 10, 100, 6)};
    for (Move& m : worlds[2]) {  // dust over 1000 km
        const Vec3 lo = place(random, -5e5f, 5e5f);
        m.box = {lo, lo + Vec3{1, 1, 1}};
    }
    for (const std::vector<Move>& boxes : worlds) {
        for (const Rows rows : {Rows::Chosen, Rows::Table}) {
            const RowGrid grid = grid_of(boxes, {.rows = rows});
            const bool listed = &boxes == &worlds[1] && rows == Rows::Chosen;  // the sort needs three more columns
            EXPECT_LE(grid.bytes(), (listed ? 130 : 66) * boxes.size());
        }
    }
}

TEST(RowGrid, TestsOnlyBoxesNearAQuery) {
    const std::vector<Move> boxes = gas(5000, 11);
    const RowGrid grid = grid_of(boxes);
    std::size_t tested = 0;
    struct Counting {
        Aabb box;
        std::size_t* tested;
        [[nodiscard]] bool touches(const Aabb& other) const {
            ++*tested;
            return overlaps(box, other);
        }
        [[nodiscard]] Aabb bounds() const { return box; }
    };
    for (const Move& m : boxes) grid.traverse(Counting{m.box, &tested}, [](Proxy, const Aabb&) { return true; });
    EXPECT_LT(tested, 100 * boxes.size());
}

/// Settings must not affect the pairs.
RC_GTEST_PROP(RowGridProperty, FindsTheSamePairsAsBruteForceForAnySettings, ()) {
    RowGrid::Settings settings;
    settings.rows = static_cast<Rows>(*rc::gen::inRange(0, 3));
    settings.cell = *rc::gen::element(0.0f, 1e-3f, 0.7f, 3.0f, 1e9f);
    settings.cells_along = *rc::gen::element(0.25f, 1.0f, 3.0f, 20.0f);
    settings.side_share = *rc::gen::element(0.1f, 1.0f, 5.0f);
    settings.level_ratio = *rc::gen::element(1.0f, 2.0f, 10.0f);
    settings.cells_per_box = *rc::gen::element(0.0f, 1.0f, 30.0f);
    settings.max_fit_age = *rc::gen::inRange(1u, 5u);
    settings.sample = *rc::gen::inRange(0u, 300u);
    Random random(*rc::gen::inRange<std::uint64_t>(0, 1u << 30));
    const float world = *rc::gen::element(0.0f, 5.0f, 50.0f, 1e6f);
    RowGrid grid(settings);
    std::vector<Move> boxes;
    const auto count = *rc::gen::inRange<Proxy>(0, 300);
    const auto draw = [&] {
        const Vec3 lo = place(random, 0, world), sides = place(random, 0, random.below(8) == 0 ? 20.0f : 1.5f);
        return Aabb{lo, lo + sides};
    };
    for (Proxy p = 0; p < count; ++p) {
        boxes.push_back({p, draw()});
        grid.insert(p, boxes.back().box);
    }
    for (int step = 0; step < 4; ++step) {
        grid.commit();
        RC_ASSERT(grid.broken_invariant() == "");
        RC_ASSERT(sorted_pairs(grid) == reference_pairs(boxes));
        for (Move& m : boxes) {
            if (random.below(3) != 0) continue;
            m.box = draw();
            grid.move(m.proxy, m.box);
            if (random.below(2) == 0) grid.set_awake(m.proxy, random.below(2) == 0);
        }
    }
}

}  // namespace
}  // namespace fase::broad
