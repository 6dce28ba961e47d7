/// Meshes of shapes: closed, facing outward, on the surface, of the right volume.
#include "fase/geometry/mesh.hpp"

#include <gtest/gtest.h>

#include <map>

#include "fase/geometry/bounds.hpp"
#include "fase/geometry/mass.hpp"
#include "tests/geometry/random_shapes.hpp"

namespace fase {
namespace {

double volume(const TriangleMesh& mesh) {
    double six = 0;
    for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
        const auto corner = [&](std::size_t k) { return to_double(mesh.positions[mesh.indices[i + k]]); };
        six += dot(corner(0), cross(corner(1), corner(2)));
    }
    return six / 6;
}

TEST(TriangleMesh, of_every_solid_is_closed_and_faces_outward) {
    Random random(1);
    for (int round = 0; round < 50; ++round) {
        for (const Shape& shape : test::one_of_each(random)) {
            if (!is_solid(shape)) continue;
            const int detail = 1 + static_cast<int>(random.below(40));
            const TriangleMesh mesh = triangles(shape, detail);
            ASSERT_EQ(mesh.indices.size() % 3, 0u);
            std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
            for (std::size_t i = 0; i < mesh.indices.size(); ++i) {
                const std::uint32_t from = mesh.indices[i], to = mesh.indices[i % 3 == 2 ? i - 2 : i + 1];
                ASSERT_LT(from, mesh.positions.size());
                ++edges[{from, to}];
            }
            for (const auto& [edge, count] : edges) {
                ASSERT_EQ(count, 1) << name_of(shape) << ": an edge twice in the same direction";
                ASSERT_TRUE(edges.contains({edge.second, edge.first})) << name_of(shape) << ": an open edge";
            }
            ASSERT_EQ(mesh.positions.size() + mesh.indices.size() / 3, edges.size() / 2 + 2) << name_of(shape);
            ASSERT_GT(volume(mesh), 0) << name_of(shape);
        }
    }
}

TEST(TriangleMesh, of_every_solid_has_its_volume_within_the_stated_tolerance) {
    Random random(2);
    for (int round = 0; round < 50; ++round) {
        for (const Shape& shape : test::one_of_each(random)) {
            if (!is_solid(shape)) continue;
            const double expected = mass_properties(shape, 1).mass;
            const double found = volume(triangles(shape, 64));
            ASSERT_LE(found, expected * (1 + 1e-5)) << name_of(shape);
            ASSERT_GE(found, expected * (1 - 0.006)) << name_of(shape);
            if (std::holds_alternative<Box>(shape) || std::holds_alternative<ConvexHull>(shape)) {
                ASSERT_NEAR(found / expected, 1, 1e-4) << name_of(shape);
            }
        }
    }
}

TEST(TriangleMesh, has_its_vertices_on_the_surface_and_its_triangles_near_it) {
    const float radius = 2;
    for (const int detail : {8, 20, 32}) {
        const TriangleMesh mesh = triangles(Sphere{radius}, detail);
        const double relative_error = std::sin(3.14159265 / detail) * std::sin(3.14159265 / detail);
        for (const Vec3 p : mesh.positions) ASSERT_NEAR(length(p), radius, 1e-6);
        for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
            const Vec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                       c = mesh.positions[mesh.indices[i + 2]];
            const Vec3 n = normalized(cross(b - a, c - a));
            ASSERT_GE(dot(n, a), radius * (1 - relative_error) - 1e-5f) << "detail " << detail;
        }
    }
}

TEST(TriangleMesh, of_a_half_space_is_a_square_that_faces_up) {
    const TriangleMesh mesh = triangles(HalfSpace{});
    ASSERT_EQ(mesh.positions.size(), 4u);
    ASSERT_EQ(mesh.indices.size(), 6u);
    for (const Vec3 p : mesh.positions) EXPECT_EQ(abs(p), (Vec3{100, 0, 100}));
    for (const std::size_t i : {0u, 3u}) {
        const Vec3 a = mesh.positions[mesh.indices[i]];
        EXPECT_GT(cross(mesh.positions[mesh.indices[i + 1]] - a, mesh.positions[mesh.indices[i + 2]] - a).y, 0);
    }
}

TEST(SamplePoints, reach_as_far_as_the_shape) {
    Random random(3);
    for (const Shape& shape : test::one_of_each(random)) {
        if (!is_solid(shape)) continue;
        const Aabb box = bounds(shape, {});
        Aabb around;
        for (const Vec3 p : sample_points(shape, 8)) around = merge(around, {p, p});
        EXPECT_LT(length(around.lo - box.lo) + length(around.hi - box.hi), 1e-5f * outer_radius(shape))
            << name_of(shape);
    }
}

}  // namespace
}  // namespace fase
