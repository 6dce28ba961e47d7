#include "fase/broad/uniform_grid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "fase/broad/brute_force.hpp"
#include "fase/core/random.hpp"
#include "tests/broad/drawn_boxes.hpp"

namespace fase::broad {
namespace {

/// Sides from 0 to `largest`, most of them small.
std::vector<Move> random_boxes(std::size_t count, float world, float largest, std::uint64_t seed) {
    Random random(seed);
    std::vector<Move> boxes;
    for (Proxy p = 0; p < count; ++p) {
        const Vec3 at = place(random, -world, world);
        const float size = largest * std::pow(random.unit(), 6.0f);
        boxes.push_back({p, {at, at + place(random, 0, size)}});
    }
    return boxes;
}

TEST(UniformGrid, FindsTheSamePairsWithCellsOfAnySize) {
    const std::vector<Move> boxes = random_boxes(900, 10, 12, 1);
    const std::vector<Pair> expected = sorted_pairs(filled(BruteForce(), boxes));
    ASSERT_GT(expected.size(), 500u);
    for (const double cell : {0.0, 1e-6, 0.01, 0.3, 1.0, 7.0, 1e3, 1e30}) {
        SCOPED_TRACE(cell);
        const UniformGrid grid = filled(UniformGrid(UniformGrid::Settings{.cell = cell}), boxes);
        EXPECT_EQ(grid.broken_invariant(), "");
        EXPECT_EQ(sorted_pairs(grid), expected);
        for (const Move& m : boxes) {
            std::set<Proxy> found, expected_hits;
            grid.traverse(BoxRegion{m.box}, [&](Proxy p, const Aabb&) { return found.insert(p).second; });
            for (const Move& other : boxes)
                if (overlaps(m.box, other.box)) expected_hits.insert(other.proxy);
            ASSERT_EQ(found, expected_hits);
        }
    }
}

TEST(UniformGrid, ReportsBoxesThatTouchOnCellBordersOnce) {
    std::vector<Move> boxes;
    for (int x = 0; x < 9; ++x)
        for (int y = 0; y < 9; ++y)
            for (int z = 0; z < 3; ++z) {
                const Vec3 at{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)};
                boxes.push_back({static_cast<Proxy>(boxes.size()), {at, at + Vec3{1, 1, 1}}});
            }
    const std::vector<Pair> expected = sorted_pairs(filled(BruteForce(), boxes));
    for (const double cell : {0.25, 0.5, 1.0, 2.0, 4.0})
        EXPECT_EQ(sorted_pairs(filled(UniformGrid(UniformGrid::Settings{.cell = cell}), boxes)), expected);
}

TEST(UniformGrid, StoresABoxInAtMostEightCells) {
    const UniformGrid grid = filled(UniformGrid(), random_boxes(5000, 20, 30, 2));
    std::vector<int> entries(5000);
    grid.for_each_leaf([&](const Leaf& leaf) {
        for (const Proxy p : leaf.proxies) ++entries[p];
    });
    EXPECT_LE(*std::max_element(entries.begin(), entries.end()), 8);
    EXPECT_GE(*std::min_element(entries.begin(), entries.end()), 1);
}

TEST(UniformGrid, FitsItsCellsToMostBoxesAndIgnoresFewHugeOrDistantOnes) {
    std::vector<Move> boxes = random_boxes(2000, 20, 1, 3);
    const double side = filled(UniformGrid(), boxes).cell_side();
    boxes[100].box = {{-1000, -1, -1000}, {1000, 0, 1000}};
    boxes[200].box = {{9e16f, 0, 0}, {9.1e16f, 1, 1}};
    const UniformGrid grid = filled(UniformGrid(), boxes);
    EXPECT_LT(grid.cell_side(), 2 * side);
    EXPECT_GT(grid.cell_side(), side / 2);
    EXPECT_EQ(sorted_pairs(grid), sorted_pairs(filled(BruteForce(), boxes)));
}

TEST(UniformGrid, HandlesCoordinatesBeyondItsCellRange) {
    Random random(4);
    std::vector<Move> boxes = random_boxes(300, 5, 1, 5);
    for (Proxy p = 300; p < 500; ++p) {  // far more than 2^30 cells of a metre away, on all sides
        Vec3 at = place(random, -1, 1) * 9e16f;
        if (p % 3 == 0) at = place(random, -1, 1) * 3e9f;
        boxes.push_back({p, {at, at + Vec3{0.5f, 0.5f, 0.5f}}});
    }
    boxes.push_back({500, {{-1e17f, -1e17f, -1e17f}, {1e17f, 1e17f, 1e17f}}});
    boxes.push_back({501, {{1e17f, 1e17f, 1e17f}, {1e17f, 1e17f, 1e17f}}});
    const UniformGrid grid = filled(UniformGrid(UniformGrid::Settings{.cell = 0.5}), boxes);
    EXPECT_EQ(grid.broken_invariant(), "");
    EXPECT_EQ(sorted_pairs(grid), sorted_pairs(filled(BruteForce(), boxes)));
}

/// A measure that counts its evaluations.
template <class M> struct Counting : M {
    std::size_t* tests;
    Counting(const M& measure, std::size_t& count) : M(measure), tests(&count) {}
    [[nodiscard]] float distance(const Aabb& box, float limit) const {
        ++*tests;
        return M::distance(box, limit);
    }
};

/// Returns the number of box tests of a nearest search; `hits` counts the searches that hit a box.
template <class M> std::size_t tests_until_nearest(const UniformGrid& grid, const M& measure, int& hits) {
    std::size_t tests = 0;
    float nearest = infinite_distance;
    grid.nearest_first(Counting<M>(measure, tests), infinite_distance, [&](Proxy, const Aabb&, float at) {
        nearest = std::min(nearest, at);
        return nearest;
    });
    hits += nearest < infinite_distance ? 1 : 0;
    return tests;
}

TEST(UniformGrid, TestsFewBoxesInRayAndPointQueries) {
    const std::vector<Move> boxes = random_boxes(50000, 100, 1, 6);
    const UniformGrid grid = filled(UniformGrid(UniformGrid::Settings{.cell = 2}), boxes);
    Random random(7);
    std::size_t on_rays = 0, at_points = 0;
    int hits = 0;
    for (int i = 0; i < 50; ++i) {
        const Vec3 from = place(random, -90, 90), direction = normalized(place(random, -1, 1));
        const Ray ray{to_double(from), direction};
        on_rays += tests_until_nearest(grid, RayMeasure(ray, {-1, -1, -1}, {1, 1, 1}), hits);
        at_points += tests_until_nearest(grid, PointMeasure(to_double(from), Aabb::infinity), hits);
    }
    EXPECT_GT(hits, 80);
    EXPECT_LT(on_rays, 50 * 2000u);
    EXPECT_LT(at_points, 50 * 400u);
}

TEST(GridWalk, VisitsEveryCellOnARay) {
    Random random(8);
    GridFrame frame;
    frame.origin = {0.3, -0.7, 100};
    frame.side = 0.7;
    frame.inverse = 1 / frame.side;
    const CellRange within{{-30, -20, -170}, {25, 30, -120}};
    for (int i = 0; i < 300; ++i) {
        Vec3 direction = place(random, -1, 1);
        if (i % 4 == 0) direction[i % 3] = 0;
        if (i % 7 == 0) direction = {0, i % 2 == 0 ? 1.0f : -1.0f, 0};
        const Ray ray{to_double(place(random, -30, 30)), normalized(direction), i % 3 == 0 ? 15.0f : Aabb::infinity};
        const Vec3 after = i % 2 == 0 ? Vec3{} : place(random, 0, 2);
        const Vec3 before = -after;
        const RayCells cells(ray, before, after, frame, within);
        for (int k = 0; k < 400; ++k) {
            const double along = std::min(double(ray.length), 0.25 * k);
            const Vec3d at = point_at(ray, along) + to_double(multiply(after, place(random, -1, 1)));
            const CellCoord cell{frame.cell(at.x, 0), frame.cell(at.y, 1), frame.cell(at.z, 2)};
            if (!within.contains(cell)) continue;
            bool visited = false;
            for (std::int64_t s = 0; s < cells.count(); ++s) {
                if (!cells.slice(s).contains(cell)) continue;
                EXPECT_FALSE(cells.visited_before({cell, cell}, s)) << "visited twice";
                EXPECT_TRUE(cells.visited_before({cell, cell}, s + 1));
                EXPECT_LE(cells.entry(s), along);
                visited = true;
            }
            ASSERT_TRUE(visited) << i << ", " << k;
        }
    }
}

TEST(GridWalk, VisitsEachCellOfAShellOnce) {
    const CellCoord centre{2, -1, 5};
    const CellRange within{{-2, -3, 1}, {4, 6, 7}};
    std::set<CellCoord> seen;
    for (std::int64_t radius = cells_between(centre, within); radius <= cells_to_end(centre, within); ++radius) {
        for_each_cell_of_shell(centre, radius, within, [&](const CellCoord& at) {
            EXPECT_EQ(cells_between(centre, {at, at}), radius);
            EXPECT_TRUE(within.contains(at));
            EXPECT_TRUE(seen.insert(at).second);
            return true;
        });
    }
    EXPECT_EQ(static_cast<double>(seen.size()), within.count());
}

}  // namespace
}  // namespace fase::broad
