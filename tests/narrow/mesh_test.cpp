/// Meshes in the narrow phase: queries against a search over all triangles, contacts against planes.
#include <gtest/gtest.h>

#include <numeric>

#include "fase/geometry/bounds.hpp"
#include "fase/narrow/cast_ray.hpp"
#include "fase/narrow/cast_shape.hpp"
#include "fase/narrow/collide_mesh.hpp"
#include "fase/narrow/detail/advance.hpp"
#include "fase/narrow/detail/core_distance.hpp"
#include "fase/narrow/detail/triangle_core.hpp"
#include "fase/narrow/dispatch.hpp"
#include "fase/narrow/distance.hpp"
#include "tests/narrow/random_shapes.hpp"

namespace fase {
namespace {

using namespace test;
using narrow::TriangleCore;

/// A bumpy surface of `n` × `n` squares of 1 m around the origin, rotated by the triangulation's whim.
Mesh make_ground(Random& random, int n, float height, bool two_sided = false, Vec3 scale = {1, 1, 1}) {
    std::vector<Vec3> positions;
    std::vector<std::uint32_t> indices;
    const auto at = [&](int i) { return static_cast<float>(i) - static_cast<float>(n) / 2; };
    for (int i = 0; i <= n; ++i)
        for (int k = 0; k <= n; ++k)
            positions.push_back({at(i) + random.between(-0.3f, 0.3f), random.between(-height, height),
                                 at(k) + random.between(-0.3f, 0.3f)});
    for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(n); ++i)
        for (std::uint32_t k = 0; k < static_cast<std::uint32_t>(n); ++k) {
            const std::uint32_t a = i * (static_cast<std::uint32_t>(n) + 1) + k, b = a + 1,
                                c = a + static_cast<std::uint32_t>(n) + 1, d = c + 1;
            if (random.below(2) == 0) {
                indices.insert(indices.end(), {a, b, c, c, b, d});
            } else {
                indices.insert(indices.end(), {a, b, d, a, d, c});
            }
        }
    return {*CollisionMesh::build(positions, indices, {.two_sided = two_sided}), scale};
}

Vec3 random_scale(Random& random) {
    const auto one = [&] { return random.between(0.5f, 2) * (random.below(4) == 0 ? -1.0f : 1.0f); };
    return random.below(2) == 0 ? Vec3{1, 1, 1} : Vec3{one(), one(), one()};
}

TEST(MeshDistance, is_the_smallest_over_all_triangles) {
    Random random(1);
    for (int round = 0; round < 2000; ++round) {
        const Mesh mesh = make_ground(random, 6, 1, false, random_scale(random));
        const Shape shape = random_shape(random, random.below(bounded_kinds));
        const TransformD x = random_transform(random, 5);
        double expected = 1e300;
        for (std::size_t place = 0; place < mesh.data->size(); ++place) {
            const TriangleCore triangle(mesh, place);
            std::visit(
                [&]<class S>(const S& s) {
                    if constexpr (ConvexShape<S>) {
                        const auto d = narrow::distance_of_cores(narrow::core_view(triangle), narrow::core_view(s), x);
                        expected = std::min(expected, d.distance);
                    }
                },
                shape);
        }
        const narrow::Distance found = narrow::signed_distance(mesh, shape, x);
        const narrow::Distance flipped = narrow::signed_distance(shape, mesh, inverse(x));
        ASSERT_EQ(found.distance, expected) << round << name_of(shape);
        ASSERT_EQ(narrow::overlaps(mesh, shape, x), expected <= 0) << round << name_of(shape);
        ASSERT_NEAR(flipped.distance, expected, 1e-6) << round << name_of(shape);
        ASSERT_LT(length(found.on_b - found.on_a - found.normal * found.distance), 1e-9);
    }
}

TEST(MeshDistance, of_a_half_space_is_that_of_the_lowest_vertex) {
    Random random(2);
    const Mesh mesh = make_ground(random, 6, 1);
    for (int round = 0; round < 100; ++round) {
        const TransformD ground = random_transform(random, 5);
        double lowest = 1e300;
        for (const Vec3 v : mesh.data->vertices())
            lowest = std::min(lowest, dot(ground.rotation.y, to_double(v) - ground.position));
        EXPECT_NEAR(narrow::signed_distance(mesh, HalfSpace{}, ground).distance, lowest, 1e-12);
        EXPECT_EQ(narrow::overlaps(HalfSpace{}, mesh, inverse(ground)), lowest <= 0);
    }
}

/// The nearest hit by the formula of the plane and a test of the three sides.
double brute_ray(const Mesh& mesh, const Ray& ray) {
    double nearest = 1e300;
    const Vec3d direction = to_double(ray.direction);
    for (std::size_t place = 0; place < mesh.data->size(); ++place) {
        const TriangleCore t(mesh, place);
        const double slope = dot(t.normal, direction);
        if (slope == 0 || (slope > 0 && !mesh.data->two_sided())) continue;
        const double distance = -t.height(ray.origin) / slope;
        if (!(distance >= 0 && distance <= double(ray.length))) continue;
        const Vec3d point = ray.origin + direction * distance;
        bool inside = true;
        for (std::size_t k = 0; k < 3; ++k)
            inside =
                inside && dot(cross(t.normal, t.corners[(k + 1) % 3] - t.corners[k]), point - t.corners[k]) >= -1e-9;
        if (inside) nearest = std::min(nearest, distance);
    }
    return nearest;
}

TEST(MeshRays, agree_with_a_search_over_all_triangles) {
    Random random(3);
    int hits = 0;
    for (int round = 0; round < 5000; ++round) {
        const Mesh mesh = make_ground(random, 6, 1, round % 2 == 0, random_scale(random));
        const Ray ray{to_double(random_in_cube(random)) * 5.0, to_float(random_direction(random)),
                      round % 3 == 0 ? random.between(0, 4) : Aabb::infinity};
        const auto hit = narrow::cast_ray(mesh, {}, ray);
        const double expected = brute_ray(mesh, ray);
        ASSERT_EQ(bool(hit), expected < 1e300) << round;
        if (!hit) continue;
        ++hits;
        ASSERT_NEAR(hit->distance, expected, 1e-6);
        ASSERT_LT(hit->triangle, mesh.data->size());
        ASSERT_LE(dot(hit->normal, ray.direction), 0);
    }
    EXPECT_GT(hits, 300);
}

TEST(MeshRays, through_edges_and_vertices_never_pass) {
    Random random(4);
    const Mesh mesh = make_ground(random, 8, 0.5f);
    for (std::size_t place = 0; place < mesh.data->size(); ++place) {
        const TriangleCore t(mesh, place);
        for (int round = 0; round < 20; ++round) {
            const double a = round < 3 ? (round == 0 ? 1 : 0) : double(random.unit()),
                         b = round < 3 ? (round == 1) : 1 - a;
            const Vec3d target = t.corners[0] * a + t.corners[1] * b + t.corners[2] * (round == 2 ? 1.0 : 0.0);
            if (std::abs(target.x) > 3 || std::abs(target.z) > 3) continue;  // the border is open
            const Vec3d origin = target + Vec3d{double(random.between(-1, 1)), 3, double(random.between(-1, 1))};
            const Vec3 direction = normalized(to_float(target - origin));
            ASSERT_TRUE(narrow::cast_ray(mesh, {}, {origin, direction, 100})) << place << " " << round;
        }
    }
}

TEST(MeshCasts, stop_where_a_search_over_all_triangles_does) {
    Random random(5);
    int hits = 0;
    for (int round = 0; round < 1000; ++round) {
        const Mesh mesh = make_ground(random, 6, 1, true, random_scale(random));
        const Shape mover = random_shape(random, random.below(bounded_kinds), 4);
        const TransformD start = random_transform(random, 6);
        const Vec3d direction = random_direction(random);
        const double length = random.between(0, 20);
        std::optional<narrow::Advance> expected;
        const double size = double(outer_radius(mesh)) + double(outer_radius(mover));
        for (std::size_t place = 0; place < mesh.data->size(); ++place) {
            const TriangleCore triangle(mesh, place);
            std::visit(
                [&]<class S>(const S& s) {
                    if constexpr (ConvexShape<S>) {
                        const auto here = narrow::advance_cores(narrow::core_view(triangle), narrow::core_view(s),
                                                                start, direction, length, 1e-7, size);
                        if (here && (!expected || here->distance < expected->distance)) expected = here;
                    }
                },
                mover);
        }
        const auto found = narrow::advance(mesh, mover, start, direction, length);
        ASSERT_EQ(bool(found), bool(expected)) << round << name_of(mover);
        if (!found) continue;
        ++hits;
        ASSERT_NEAR(found->distance, expected->distance, 1e-5) << round << name_of(mover);
        // The mesh as the mover.
        const auto back =
            narrow::advance(mover, mesh, inverse(start), transpose_times(start.rotation, -direction), length);
        ASSERT_TRUE(back);
        ASSERT_NEAR(back->distance, expected->distance, 1e-5);
    }
    EXPECT_GT(hits, 100);
}

TEST(MeshCasts, from_behind_pass_a_one_sided_mesh) {
    Random random(6);
    const Mesh one = make_ground(random, 6, 0.1f), two = make_ground(random, 6, 0.1f, true);
    const Pose below{{0, -5, 0}, {}};
    EXPECT_FALSE(narrow::cast_shape(Sphere{0.5f}, below, {0, 1, 0}, 20, one, {}));
    EXPECT_TRUE(narrow::cast_shape(Sphere{0.5f}, below, {0, 1, 0}, 20, two, {}));
    EXPECT_TRUE(narrow::cast_shape(Sphere{0.5f}, {{0, 5, 0}, {}}, {0, -1, 0}, 20, one, {}));
    EXPECT_FALSE(narrow::cast_ray(one, {}, {{0, -5, 0}, {0, 1, 0}, 20}));
    EXPECT_TRUE(narrow::cast_ray(two, {}, {{0, -5, 0}, {0, 1, 0}, 20}));
}

/// What each shape has on a flat mesh of any triangulation: the contact of a plane.
TEST(MeshContacts, on_a_flat_mesh_are_those_of_a_plane) {
    Random random(7);
    narrow::MeshContacts contacts;
    for (int round = 0; round < 4000; ++round) {
        const Mesh mesh = make_ground(random, 8, 0);
        const std::size_t kind = random.below(bounded_kinds);
        const Shape shape = random_shape(random, kind);
        const bool lies = random.below(2) == 0;
        TransformD x = random_transform(random, 1);
        if (lies) x.rotation = to_matrix(normalized(to_double(rotation_about(Vec3{0, 1, 0}, random.between(0, 6)))));
        x.position.y = 0;
        const double lowest = dot(Vec3d{0, 1, 0}, x.rotation * support(shape, transpose_times(x.rotation, {0, -1, 0})));
        const double gap = random.between(-0.005f, 0.01f);
        x.position.y = gap - lowest;
        const auto found = contacts.find(mesh, shape, x, 0.02f);
        ASSERT_EQ(found.size(), 1u) << round << name_of(shape);
        const narrow::Manifold& manifold = found[0].manifold;
        ASSERT_GT(manifold.normal.y, 0.999999f) << round << name_of(shape);
        const narrow::Manifold plane =
            narrow::collide(HalfSpace{}, shape, {to_float(x.position), to_float(to_quat(x.rotation))}, 0.02f);
        float nearest = 1, expected = 1;
        for (std::size_t i = 0; i < static_cast<std::size_t>(manifold.count); ++i)
            nearest = std::min(nearest, manifold.points[i].separation);
        for (std::size_t i = 0; i < static_cast<std::size_t>(plane.count); ++i)
            expected = std::min(expected, plane.points[i].separation);
        ASSERT_NEAR(nearest, expected, 2e-5) << round << name_of(shape);
        if (lies && (kind == 1 || kind == 3)) ASSERT_GE(manifold.count, 4) << round << name_of(shape);
    }
}

TEST(MeshContacts, triangles_that_scaling_makes_flat_have_none) {
    const std::vector<Vec3> corners{{1, 0, 0}, {1, 1, 0.5f}, {1, 2, 1.0001f}, {0, 0, 0}, {0, 0, 1}, {1, 0, 0}};
    const std::vector<std::uint32_t> indices{0, 1, 2, 3, 4, 5};
    const Mesh mesh{*CollisionMesh::build(corners, indices), {1e-4f, 1e-4f, 1e4f}};
    narrow::MeshContacts contacts;
    TransformD x;
    x.position = {0, 0.2, 0.5};
    for (const float margin : {0.0f, 1.0f, 1e4f}) EXPECT_LE(contacts.find(mesh, Sphere{0.25f}, x, margin).size(), 2u);
}

TEST(MeshContacts, of_a_closed_surface_push_outward_by_the_distance) {
    Random random(8);
    narrow::MeshContacts contacts;
    int touching = 0;
    for (int round = 0; round < 3000; ++round) {
        const ConvexHull hull = random_hull(random, 12, {1, 1, 1});
        const TriangleMesh surface = triangles(hull);
        const Mesh mesh{*CollisionMesh::build(surface.positions, surface.indices)};
        const Shape shape = random_shape(random, random.below(bounded_kinds));
        const TransformD x = random_transform(random, 2.5);
        const double distance = narrow::signed_distance(hull, shape, x).distance;
        if (distance < 0 || distance > 0.5) continue;
        const auto found = contacts.find(mesh, shape, x, 0.5f);
        ASSERT_FALSE(found.empty()) << round << name_of(shape) << distance;
        ++touching;
        float nearest = 1;
        for (const narrow::MeshManifold& m : found)
            for (std::size_t i = 0; i < static_cast<std::size_t>(m.manifold.count); ++i)
                nearest = std::min(nearest, m.manifold.points[i].separation);
        ASSERT_NEAR(nearest, distance, 0.02) << round << name_of(shape);
    }
    EXPECT_GT(touching, 300);
}

}  // namespace
}  // namespace fase
