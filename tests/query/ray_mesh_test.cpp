/// Ray casts against meshes: watertight, accurate, and the nearest of all triangles.
#include "fase/query/ray_mesh.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fase/core/random.hpp"
#include "fase/geometry/mesh.hpp"

namespace fase::query {
namespace {

Vec3d point_in(Random& random, double size) {
    const auto one = [&] { return size * double(random.between(-1, 1)); };
    const double x = one(), y = one(), z = one();
    return {x, y, z};
}

Ray ray_to(Vec3d from, Vec3d to) {
    const Vec3d path = to - from;
    return {from, to_float(path * (1 / length(path)))};
}

/// Random triangles in a cube around the origin.
TriangleMesh random_triangles(Random& random, std::size_t count, double size) {
    TriangleMesh mesh;
    for (std::size_t i = 0; i < count; ++i) {
        const Vec3d at = point_in(random, size);
        for (std::uint32_t k = 0; k < 3; ++k) {
            mesh.indices.push_back(static_cast<std::uint32_t>(mesh.positions.size()));
            mesh.positions.push_back(to_float(at + point_in(random, 1)));
        }
    }
    return mesh;
}

/// Returns the distance to one triangle in double; negative for a miss. `clear` is false when the result is within
/// rounding error. Source: Möller, Trumbore 1997, Fast, minimum storage ray/triangle intersection.
double distance_to(const TriangleMesh& mesh, std::size_t triangle, const Ray& ray, bool& clear) {
    const auto corner = [&](std::size_t k) { return to_double(mesh.positions[mesh.indices[3 * triangle + k]]); };
    const Vec3d a = corner(0), ab = corner(1) - a, ac = corner(2) - a, d = to_double(ray.direction);
    const Vec3d p = cross(d, ac), from_a = ray.origin - a, q = cross(from_a, ab);
    const double det = dot(ab, p), u = dot(from_a, p) / det, v = dot(d, q) / det, t = dot(ac, q) / det;
    const double edge = std::min(u, std::min(v, 1 - u - v));
    clear = std::abs(edge) > 1e-3 && std::abs(t) > 1e-3 && std::abs(det) > 1e-2;
    return edge >= 0 && t >= 0 ? t : -1;
}

TEST(RayMesh, FindsTheNearestOfAllTriangles) {
    Random random(1);
    for (const std::size_t count : {1u, 7u, 60u, 900u}) {
        const TriangleMesh mesh = random_triangles(random, count, 6);
        const RayMesh rays = *RayMesh::of(mesh.positions, mesh.indices);
        EXPECT_EQ(rays.size(), count);
        EXPECT_EQ(rays.tree().broken_invariant(), "");
        std::size_t hits = 0;
        for (int i = 0; i < 1000; ++i) {
            Ray ray = ray_to(point_in(random, 8), point_in(random, 8));
            if (i % 3 == 0) ray.length = 4;
            double nearest = std::numeric_limits<double>::infinity();
            bool all_clear = true;
            for (std::size_t t = 0; t < count; ++t) {
                bool clear = true;
                const double at = distance_to(mesh, t, ray, clear);
                all_clear = all_clear && (clear || at < 0 || at > nearest) && std::abs(at - double(ray.length)) > 1e-3;
                if (at >= 0 && at <= double(ray.length) && at < nearest) nearest = at;
            }
            if (!all_clear) continue;
            const auto hit = rays.nearest_hit(ray);
            ASSERT_EQ(hit.has_value(), std::isfinite(nearest)) << count << ' ' << i;
            EXPECT_EQ(rays.any_hit(ray), hit.has_value());
            if (!hit) continue;
            ++hits;
            ASSERT_NEAR(double(hit->distance), nearest, 2e-5 * (1 + nearest));
        }
        EXPECT_GT(hits, count > 50 ? 50u : 0u);
    }
}

TEST(RayMesh, IsWatertightAtEdgesAndVertices) {
    Random random(2);
    for (const double offset : {0.0, 300.0}) {
        TriangleMesh ball = triangles(Shape{Sphere{1}}, 24);
        for (Vec3& at : ball.positions) at = at + Vec3{float(offset), 0, float(-offset)};
        const RayMesh rays = *RayMesh::of(ball.positions, ball.indices);
        const auto at = [&](std::size_t i) { return to_double(ball.positions[ball.indices[i]]); };
        for (int i = 0; i < 20000; ++i) {
            const std::size_t t = 3 * random.below(ball.indices.size() / 3);
            const Vec3d inside = Vec3d{offset, 0, -offset} + point_in(random, 0.3);
            const double share = double(random.between(0, 1));
            const Vec3d on_edge = at(t) * share + at(t + 1) * (1 - share);
            const Ray ray = ray_to(inside, i % 3 == 0 ? at(t) : on_edge);
            const auto hit = rays.nearest_hit(ray);
            ASSERT_TRUE(hit.has_value()) << i;
            ASSERT_NEAR(double(hit->distance), length((i % 3 == 0 ? at(t) : on_edge) - inside), 1e-3);
        }
    }
}

TEST(RayMesh, HitsTheFirstOfCoincidentTriangles) {
    const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const RayMesh rays = *RayMesh::of(positions, std::vector<std::uint32_t>{0, 1, 2, 1, 2, 0, 0, 2, 1});
    for (const float side : {1.0f, -1.0f}) {
        const auto hit = rays.nearest_hit({{0.25, 0.25, double(3 * side)}, {0, 0, -side}});
        ASSERT_TRUE(hit);
        EXPECT_EQ(hit->proxy, 0u);
        EXPECT_EQ(hit->distance, 3);
    }
    EXPECT_EQ(rays.normal(0), (Vec3{0, 0, 1}));
    EXPECT_EQ(rays.normal(2), (Vec3{0, 0, -1}));
}

TEST(RayMesh, HitsATriangleAtTheEndOfTheRayAndNoneBehindIt) {
    const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    const RayMesh rays = *RayMesh::of(positions, std::vector<std::uint32_t>{0, 1, 2});
    const Vec3d from{0.25, 0.25, 2};
    EXPECT_TRUE(rays.any_hit({from, {0, 0, -1}, 2}));
    EXPECT_FALSE(rays.any_hit({from, {0, 0, -1}, 1.999f}));
    EXPECT_FALSE(rays.any_hit({from, {0, 0, 1}}));
    EXPECT_FALSE(rays.any_hit({{0.75, 0.75, 2}, {0, 0, -1}}));
    EXPECT_EQ(rays.nearest_hit({{0.25, 0.25, 0}, {0, 0, -1}})->distance, 0);
}

TEST(RayMesh, IgnoresDegenerateTriangles) {
    const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}};
    const RayMesh rays = *RayMesh::of(positions, std::vector<std::uint32_t>{0, 1, 2, 0, 0, 0, 1, 1, 2});
    EXPECT_FALSE(rays.any_hit({{0.5, 0, 2}, {0, 0, -1}}));
    EXPECT_FALSE(rays.any_hit({{0, 0, 0}, {1, 0, 0}}));
    EXPECT_EQ(rays.normal(0), (Vec3{}));
    EXPECT_FALSE(RayMesh().any_hit({{0, 0, 2}, {0, 0, -1}}));
}

TEST(RayMesh, RejectsInvalidMeshes) {
    const std::vector<Vec3> positions{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    EXPECT_EQ(RayMesh::of(positions, std::vector<std::uint32_t>{0, 1}).error().status, Status::BadArgument);
    EXPECT_NE(RayMesh::of(positions, std::vector<std::uint32_t>{0, 1, 3}).error().text().find("index 3 at 2"),
              std::string::npos);
    for (const float bad : {std::nanf(""), std::numeric_limits<float>::infinity(), 1e30f}) {
        std::vector<Vec3> broken = positions;
        broken[1].y = bad;
        EXPECT_EQ(RayMesh::of(broken, std::vector<std::uint32_t>{0, 1, 2}).error().status, Status::BadArgument);
    }
}

}  // namespace
}  // namespace fase::query
