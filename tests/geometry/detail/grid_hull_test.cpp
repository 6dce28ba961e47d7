/// Quickhull on grid points is exact: no point is outside.
#include "fase/geometry/detail/grid_hull.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "fase/core/random.hpp"
#include "fase/geometry/detail/hull_faces.hpp"

namespace fase::hull {
namespace {

/// The sign of the volume of a, b, c, p in integers wide enough for it.
int orientation(GridPoint a, GridPoint b, GridPoint c, GridPoint p) {
    __extension__ using Wide = __int128;
    const auto u = b - a, v = c - a, w = p - a;
    const Wide volume = Wide{w.x} * (Wide{u.y} * v.z - Wide{u.z} * v.y) +
                        Wide{w.y} * (Wide{u.z} * v.x - Wide{u.x} * v.z) +
                        Wide{w.z} * (Wide{u.x} * v.y - Wide{u.y} * v.x);
    return volume > 0 ? 1 : volume < 0 ? -1 : 0;
}

void expect_exact(std::span<const GridPoint> points) {
    const GridHull hull = quickhull(points, {});
    ASSERT_EQ(hull.dimension, 3);
    for (std::uint32_t t = 0; t < hull.triangles.size(); ++t) {
        const Triangle& triangle = hull.triangles[t];
        const auto [a, b, c] = triangle.corner;
        for (const GridPoint p : points) {
            ASSERT_LE(orientation(points[a], points[b], points[c], p), 0) << "a point outside";
            ASSERT_EQ(triangle.plane.side(p), orientation(points[a], points[b], points[c], p));
        }
        for (std::size_t k = 0; k < 3; ++k) {
            const Triangle& across = hull.triangles[triangle.neighbour[k]];
            const auto from = std::find(across.corner.begin(), across.corner.end(), triangle.corner[(k + 1) % 3]);
            ASSERT_NE(from, across.corner.end());
            const auto edge = static_cast<std::size_t>(from - across.corner.begin());
            ASSERT_EQ(across.corner[(edge + 1) % 3], triangle.corner[k]);
            ASSERT_EQ(across.neighbour[edge], t);
        }
    }
    const MergedFaces exact = merge_coplanar(points, hull.triangles, 0);
    ASSERT_TRUE(exact.redundant || exact.valid);
}

std::int32_t random_int(Random& random, int size) {
    return static_cast<std::int32_t>(random.below(static_cast<std::uint64_t>(2 * size + 1))) - size;
}

TEST(Quickhull, leaves_no_point_outside_for_small_and_large_distances) {
    Random random(1);
    for (const int size : {1, 2, 3, 10, 1000, grid_limit}) {
        for (int round = 0; round < 100; ++round) {
            std::vector<GridPoint> points{{size, 0, 0},  {-size, 0, 0}, {0, size, 0},
                                          {0, -size, 0}, {0, 0, size},  {0, 0, -size}};
            for (int i = 0; i < 60; ++i)
                points.push_back({random_int(random, size), random_int(random, size), random_int(random, size)});
            expect_exact(points);
        }
    }
}

/// The points are in two neighbouring planes of the lattice, a millionth of a step apart: below the precision of
/// double.
TEST(Quickhull, distinguishes_planes_a_millionth_of_a_step_apart) {
    Random random(2);
    for (int round = 0; round < 200; ++round) {
        std::vector<GridPoint> points{{0, 0, 400000000}};
        for (int i = 0; i < 40; ++i) {
            const std::int32_t u = random_int(random, 100), v = random_int(random, 100), layer = random_int(random, 1);
            points.push_back({u * 1024 + layer, u + v * 1024, v});
        }
        expect_exact(points);
    }
}

TEST(Quickhull, reports_the_dimension_of_points_that_are_no_solid) {
    EXPECT_EQ(quickhull({}, {}).dimension, 0);
    const GridPoint one[] = {{1, 2, 3}, {1, 2, 3}};
    EXPECT_EQ(quickhull(one, {}).dimension, 0);
    const GridPoint line[] = {{0, 0, 0}, {1, 2, 3}, {2, 4, 6}, {-3, -6, -9}};
    EXPECT_EQ(quickhull(line, {}).dimension, 1);
    const GridPoint plane[] = {{0, 0, 0}, {5, 0, 5}, {5, 5, 10}, {0, 5, 5}, {1, 2, 3}};
    EXPECT_EQ(quickhull(plane, {}).dimension, 2);
}

}  // namespace
}  // namespace fase::hull
