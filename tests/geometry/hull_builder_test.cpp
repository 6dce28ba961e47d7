/// Convex hulls: known solids, comparison with qhull, and degenerate input.
#include "fase/geometry/hull_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fase/geometry/bounds.hpp"
#include "fase/geometry/mass.hpp"
#include "tests/geometry/random_shapes.hpp"

#ifdef FASE_HAS_QHULL
extern "C" {
#include <libqhull_r/qhull_ra.h>
}
#endif

namespace fase {
namespace {

std::vector<Vec3> cube_corners() {
    std::vector<Vec3> points;
    for (int i = 0; i < 8; ++i) points.push_back({i & 1 ? 1.f : -1.f, i & 2 ? 1.f : -1.f, i & 4 ? 1.f : -1.f});
    return points;
}

double surface(const ConvexHull& hull) {
    double area = 0;
    for (const ConvexHull::Face& face : hull.faces) {
        Vec3d sum;
        const auto corner = [&](std::uint32_t i) {
            return to_double(hull.vertices[hull.face_vertices[face.first + i]]);
        };
        for (std::uint32_t i = 1; i + 1 < face.count; ++i) {
            sum += cross(corner(i) - corner(0), corner(i + 1) - corner(0));
        }
        area += length(sum) / 2;
    }
    return area;
}

double volume(const ConvexHull& hull) { return mass_properties(hull, 1).mass; }

double farthest_outside(const ConvexHull& hull, std::span<const Vec3> points) {
    double farthest = -1e30;
    for (const ConvexHull::Face& face : hull.faces) {
        const Vec3d normal = to_double(face.plane.normal);
        for (const Vec3 p : points) farthest = std::max(farthest, dot(normal, to_double(p)) - face.plane.offset);
    }
    return farthest;
}

/// Checks that every vertex is one of the points, all faces are convex and flat, and check() passes.
void expect_valid(const ConvexHull& hull, std::span<const Vec3> points) {
    const Result<void> fit = check(Shape(hull));
    ASSERT_TRUE(fit) << fit.error().text();
    if (points.size() <= 20000) {
        for (const Vec3 v : hull.vertices) ASSERT_TRUE(std::find(points.begin(), points.end(), v) != points.end());
    }
    float size = 0;
    for (const Vec3 v : hull.vertices) size = std::max({size, std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    for (const ConvexHull::Face& face : hull.faces) {
        const auto corner = [&](std::uint32_t i) {
            return to_double(hull.vertices[hull.face_vertices[face.first + i % face.count]]);
        };
        for (std::uint32_t i = 0; i < face.count; ++i) {
            const Vec3d out = cross(corner(i + 1) - corner(i), to_double(face.plane.normal));
            const double inward = dot(corner(i + 2) - corner(i), normalized(out));
            ASSERT_LE(inward, 4e-6 * size) << "a face that is not convex";
            ASSERT_LE(std::abs(signed_distance(face.plane, to_float(corner(i)))), 4e-6f * size)
                << "a face that is not flat";
        }
    }
}

TEST(ConvexHull, of_a_cube_has_8_vertices_12_edges_and_6_square_faces) {
    const std::vector<Vec3> points = cube_corners();
    const Result<ConvexHull> hull = build_convex_hull(points);
    ASSERT_TRUE(hull) << hull.error().text();
    expect_valid(*hull, points);
    EXPECT_EQ(hull->vertices, points) << "vertices keep the order of the points";
    EXPECT_EQ(hull->edges.size(), 12u);
    ASSERT_EQ(hull->faces.size(), 6u);
    for (const ConvexHull::Face& face : hull->faces) {
        EXPECT_EQ(face.count, 4u);
        EXPECT_EQ(face.plane.offset, 1);
    }
    EXPECT_EQ(volume(*hull), 8);
    EXPECT_EQ(surface(*hull), 24);
}

TEST(ConvexHull, of_a_tetrahedron_lists_each_edge_with_its_two_faces) {
    const Vec3 points[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const Result<ConvexHull> hull = build_convex_hull(points);
    ASSERT_TRUE(hull);
    expect_valid(*hull, points);
    ASSERT_EQ(hull->edges.size(), 6u);
    for (std::size_t e = 0; e < 6; ++e) {
        const ConvexHull::Edge& edge = hull->edges[e];
        EXPECT_LT(edge.from, edge.to);
        EXPECT_NE(edge.face_a, edge.face_b);
        if (e == 0) continue;
        EXPECT_LT(std::pair(hull->edges[e - 1].from, hull->edges[e - 1].to), std::pair(edge.from, edge.to));
    }
    EXPECT_FLOAT_EQ(float(volume(*hull)), 1.0f / 6);
}

TEST(ConvexHull, drops_points_inside_the_hull_its_faces_and_its_edges) {
    Random random(1);
    std::vector<Vec3> points;
    for (int i = 0; i < 3000; ++i) {
        Vec3 p = test::random_vector(random);
        if (i % 3 >= 1) p[static_cast<int>(random.below(3))] = random.below(2) == 0 ? -1.f : 1.f;
        if (i % 3 == 2) p[static_cast<int>(random.below(3))] = random.below(2) == 0 ? -1.f : 1.f;
        points.push_back(p);
    }
    for (const Vec3 corner : cube_corners()) points.push_back(corner);
    for (const Vec3 corner : cube_corners()) points.push_back(corner);
    const Result<ConvexHull> hull = build_convex_hull(points);
    ASSERT_TRUE(hull);
    expect_valid(*hull, points);
    EXPECT_EQ(hull->vertices.size(), 8u);
    EXPECT_EQ(hull->faces.size(), 6u);
}

TEST(ConvexHull, of_a_rotated_and_translated_lattice_has_6_faces) {
    Random random(2);
    for (int round = 0; round < 300; ++round) {
        const Quat turn = test::random_rotation(random);
        const Vec3 away = test::random_vector(random, 20);
        const Vec3 step{random.between(0.05f, 0.3f), random.between(0.05f, 0.3f), random.between(0.05f, 0.3f)};
        std::vector<Vec3> points;
        for (int i = 0; i < 216; ++i) {
            points.push_back(away + rotate(turn, multiply(step, {float(i % 6), float(i / 6 % 6), float(i / 36)})));
        }
        const Result<ConvexHull> hull = build_convex_hull(points);
        ASSERT_TRUE(hull) << hull.error().text();
        expect_valid(*hull, points);
        ASSERT_EQ(hull->faces.size(), 6u) << "round " << round;
        ASSERT_EQ(hull->vertices.size(), 8u) << "round " << round;
        ASSERT_NEAR(volume(*hull), 125.0 * step.x * step.y * step.z, 2e-4);
    }
}

TEST(ConvexHull, of_prisms_has_two_polygonal_faces_and_quadrilateral_sides) {
    Random random(3);
    for (std::uint32_t corners = 3; corners <= 120; corners += 9) {
        const Quat turn = test::random_rotation(random);
        std::vector<Vec3> points;
        for (std::uint32_t i = 0; i < corners; ++i) {
            const float angle = 6.2831853f * float(i) / float(corners);
            for (const float y : {-0.5f, 0.5f}) points.push_back(rotate(turn, {std::cos(angle), y, std::sin(angle)}));
        }
        const Result<ConvexHull> hull = build_convex_hull(points);
        ASSERT_TRUE(hull) << hull.error().text();
        expect_valid(*hull, points);
        EXPECT_EQ(hull->vertices.size(), 2 * corners);
        EXPECT_EQ(hull->faces.size(), corners + 2);
        EXPECT_EQ(hull->edges.size(), 3 * corners);
    }
}

TEST(ConvexHull, gives_the_same_bits_again_and_for_its_own_vertices) {
    Random random(4);
    const std::vector<Vec3> points = test::random_points(random, 500);
    const Result<ConvexHull> once = build_convex_hull(points), again = build_convex_hull(points);
    ASSERT_TRUE(once && again);
    EXPECT_EQ(*once, *again);
    const Result<ConvexHull> of_itself = build_convex_hull(once->vertices);
    ASSERT_TRUE(of_itself);
    EXPECT_EQ(of_itself->vertices, once->vertices);
    EXPECT_EQ(of_itself->faces, once->faces);
}

TEST(ConvexHull, of_a_million_points_is_simplified_inward_to_max_vertices) {
    Random random(5);
    std::vector<Vec3> points;
    for (int i = 0; i < 1000000; ++i) points.push_back(normalized(test::random_vector(random)));
    double last = 0;
    for (const int max_vertices : {8, 255}) {
        const Result<ConvexHull> hull = build_convex_hull(points, {max_vertices});
        ASSERT_TRUE(hull) << hull.error().text();
        expect_valid(*hull, points);
        EXPECT_LE(hull->vertices.size(), static_cast<std::size_t>(max_vertices));
        for (const Vec3 v : hull->vertices) ASSERT_NEAR(length(v), 1, 1e-6) << "a vertex that is not one of the points";
        EXPECT_GT(volume(*hull), last) << "more vertices approximate the sphere better";
        last = volume(*hull);
    }
    EXPECT_GT(last, 4.0 / 3 * 3.14159265 * 0.97);
    EXPECT_LT(last, 4.0 / 3 * 3.14159265);
}

TEST(ConvexHull, limited_to_few_vertices_keeps_the_corners_of_a_box) {
    Random random(6);
    std::vector<Vec3> points = test::random_points(random, 5000, {0.99f, 0.99f, 0.99f});
    for (const Vec3 corner : cube_corners()) points.push_back(corner);
    const Result<ConvexHull> hull = build_convex_hull(points, {8});
    ASSERT_TRUE(hull);
    EXPECT_EQ(hull->vertices, cube_corners());
}

struct Refusal {
    const char* what;
    std::vector<Vec3> points;
    const char* message;
};

TEST(ConvexHull, of_points_without_volume_is_refused_with_the_counts) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = Aabb::infinity;
    Random random(7);
    std::vector<Vec3> line, rotated_plane, sliver;
    for (int i = 0; i < 100; ++i) {
        line.push_back(Vec3{1, 2, 3} * random.between(-1, 1));
        rotated_plane.push_back(
            rotate(Quat{0.1f, 0.7f, 0.1f, 0.7f}, {random.between(-1, 1), 0.5f, random.between(-1, 1)}));
        sliver.push_back({random.between(-1, 1), random.between(0, 5e-5f), random.between(-1, 1)});
    }
    std::vector<Vec3> three(1000000, Vec3{1, 2, 3});
    three[77] = {1, 2, 4};
    three[7777] = {1, 3, 4};
    const Refusal refusals[] = {
        {"nothing", {}, "0 points, 0 distinct"},
        {"one point", {{1, 2, 3}}, "1 points, 1 distinct"},
        {"two", {{1, 2, 3}, {3, 2, 1}}, "2 points, 2 distinct"},
        {"three", {{1, 2, 3}, {3, 2, 1}, {0, 0, 0}}, "3 points, 3 distinct"},
        {"a million of one", std::vector<Vec3>(1000000, Vec3{1, 2, 3}), "1000000 points, 1 distinct"},
        {"a million of three", three, "1000000 points, 3 distinct"},
        {"a line", line, "on one line"},
        {"a plane", {{0, 0, 0}, {1, 0, 0}, {0, 0, 1}, {1, 0, 1}, {0.5f, 0, 0.3f}}, "in one plane"},
        {"a rotated plane", rotated_plane, "in one plane"},
        {"a sliver", sliver, "in one plane"},
        {"a speck", {{0, 0, 0}, {1e-5f, 0, 0}, {0, 1e-5f, 0}, {0, 0, 1e-5f}}, "at one point"},
        {"NaN", {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, nan, 1}}, "point 3 of 4"},
        {"infinity", {{0, 0, 0}, {-inf, 0, 0}, {0, 1, 0}, {0, 0, 1}}, "point 1 of 4"},
        {"far away", {{0, 0, 0}, {1, 0, 0}, {0, 1.1e5f, 0}, {0, 0, 1}}, "point 2 of 4"},
    };
    for (const Refusal& refusal : refusals) {
        const Result<ConvexHull> hull = build_convex_hull(refusal.points);
        ASSERT_FALSE(hull) << refusal.what;
        EXPECT_EQ(hull.status(), Status::BadArgument) << refusal.what;
        EXPECT_NE(hull.error().text().find(refusal.message), std::string::npos)
            << refusal.what << ": " << hull.error().text();
    }
    EXPECT_EQ(build_convex_hull(cube_corners(), {3}).status(), Status::BadArgument);
}

TEST(ConvexHull, is_valid_with_noise_of_any_size_on_flat_and_round_bodies) {
    Random random(8);
    for (int round = 0; round < 3000; ++round) {
        const float noise = std::pow(10.0f, random.between(-9, -1));
        const Vec3 size{test::random_size(random), test::random_size(random), test::random_size(random)};
        std::vector<Vec3> points;
        for (int i = 0; i < 200; ++i) {
            Vec3 p = test::random_vector(random);
            const int axis = static_cast<int>(random.below(3));
            if (round % 3 == 0) p[axis] = p[axis] < 0 ? -1.f : 1.f;                               // a box
            if (round % 3 == 1) p = normalized(p);                                                // a ball
            if (round % 3 == 2) p = {float(i % 5) / 2, float(i / 5 % 5) / 2, float(i / 25) / 4};  // a lattice
            points.push_back(multiply(p + test::random_vector(random, noise), size));
        }
        const Result<ConvexHull> hull = build_convex_hull(points);
        if (!hull) {
            EXPECT_LT(std::min({size.x, size.y, size.z}), 1e-3f * std::max({1.f, size.x, size.y, size.z}))
                << hull.error().text();
            continue;
        }
        expect_valid(*hull, points);
        Vec3 largest;
        for (const Vec3 p : points) largest = max(largest, abs(p));
        const double sum = double(largest.x) + largest.y + largest.z;
        ASSERT_LE(farthest_outside(*hull, points), 1e-6 * sum) << "round " << round;
    }
}

#ifdef FASE_HAS_QHULL

/// The result of qhull, as the reference.
struct Reference {
    double volume = 0, area = 0;
};
Reference run_qhull(std::span<const Vec3> points) {
    std::vector<double> coordinates;
    for (const Vec3 p : points) coordinates.insert(coordinates.end(), {p.x, p.y, p.z});
    qhT memory;
    qh_zero(&memory, stderr);
    char command[] = "qhull Qt";
    Reference found;
    if (qh_new_qhull(&memory, 3, static_cast<int>(points.size()), coordinates.data(), 0, command, nullptr, stderr) ==
        0) {
        qh_getarea(&memory, memory.facet_list);
        found = {memory.totvol, memory.totarea};
    }
    qh_freeqhull(&memory, !qh_ALL);
    int blocks = 0, bytes = 0;
    qh_memfreeshort(&memory, &blocks, &bytes);
    return found;
}

TEST(ConvexHull, has_the_volume_and_area_that_qhull_finds_and_leaves_no_point_outside) {
    Random random(9);
    for (int round = 0; round < 300; ++round) {
        const std::size_t count = 4 + random.below(round % 50 == 0 ? 20000 : 300);
        const Vec3 size{test::random_size(random) + 0.1f, test::random_size(random) + 0.1f,
                        test::random_size(random) + 0.1f};
        std::vector<Vec3> points = test::random_points(random, count);
        for (Vec3& p : points) {
            if (round % 3 == 1) p = normalized(p);
            if (round % 3 == 2) p = {std::round(p.x * 4), std::round(p.y * 4), std::round(p.z * 4)};
            p = multiply(p, size);
        }
        const Result<ConvexHull> hull = build_convex_hull(points, {1 << 20});
        if (!hull) continue;
        expect_valid(*hull, points);
        const Reference truth = run_qhull(points);
        const double largest = double(size.x) + size.y + size.z;
        ASSERT_LE(farthest_outside(*hull, points), 2e-6 * largest);
        ASSERT_NEAR(volume(*hull), truth.volume, 2e-6 * largest * truth.area + 1e-6 * truth.volume)
            << "round " << round;
        ASSERT_NEAR(surface(*hull), truth.area, 1e-5 * largest * largest) << "round " << round;
    }
}

#endif

}  // namespace
}  // namespace fase
