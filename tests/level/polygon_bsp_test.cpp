/// Compares 3D BSP trees with brute force and with formulas.
#include "fase/level/polygon_bsp.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <limits>
#include <map>
#include <string>

#include "fase/core/random.hpp"
#include "fase/scene/obj.hpp"
#include "tests/level/solids.hpp"

namespace fase::level {
namespace {

struct Named {
    std::string name;
    TriangleMesh mesh;
};

std::vector<Named> closed_meshes() {
    std::vector<Named> all{{"cube", triangles(Box{{1, 1, 1}})},
                           {"sphere", triangles(Sphere{1}, 24)},
                           {"torus", torus(2, 0.75f, 40, 16)},
                           {"concave L", concave_l()}};
    TriangleMesh overlapping = triangles(Box{{1, 1, 1}});
    append(overlapping, triangles(Sphere{1}, 12), {0.7f, 0.4f, 0.9f});
    all.push_back({"two overlapping solids", overlapping});
    TriangleMesh hollow = triangles(Box{{1, 1, 1}});
    append(hollow, flipped(triangles(Box{{0.5f, 0.5f, 0.5f}})));
    all.push_back({"hollow box", hollow});
    TriangleMesh touching = triangles(Box{{1, 1, 1}});
    append(touching, triangles(Box{{1, 0.5f, 0.5f}}), {2, 0, 0});
    all.push_back({"touching boxes", touching});
    all.push_back({"inside out", flipped(concave_l())});
    return all;
}

std::vector<Named> given_meshes() {
    std::vector<Named> all;
    const auto folder = std::filesystem::path(FASE_SHARED_DATA) / "meshes";
    if (!std::filesystem::exists(folder)) return all;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".obj") continue;
        auto mesh = scene::read_obj(entry.path().string());
        if (mesh) all.push_back({entry.path().filename().string(), *std::move(mesh)});
    }
    std::sort(all.begin(), all.end(), [](const Named& a, const Named& b) { return a.name < b.name; });
    return all;
}

struct Box3 {
    Vec3d lo, hi;
};
Box3 box_of(const TriangleMesh& mesh, double margin) {
    Box3 box{{1e300, 1e300, 1e300}, {-1e300, -1e300, -1e300}};
    for (const std::uint32_t i : mesh.indices) {
        box.lo = min(box.lo, to_double(mesh.positions[i]));
        box.hi = max(box.hi, to_double(mesh.positions[i]));
    }
    const Vec3d more = (box.hi - box.lo) * margin;
    return {box.lo - more, box.hi + more};
}
Vec3d point_in(const Box3& box, Random& random) {
    const auto between = [&](double lo, double hi) { return lo + (hi - lo) * double(random.unit()); };
    return {between(box.lo.x, box.hi.x), between(box.lo.y, box.hi.y), between(box.lo.z, box.hi.z)};
}
/// Returns whether the point is within the tolerance of the tree around a plane.
bool near_surface(const PolygonBsp& tree, Vec3d p) {
    const double near = 4 * tree.thickness();
    for (std::size_t t = 0; t < tree.mesh().indices.size() / 3; ++t) {
        const auto c = corners_of(tree.mesh(), t);
        const Vec3d normal = normalized(cross(c[1] - c[0], c[2] - c[0]));
        if (std::abs(dot(normal, p - c[0])) < near) return true;
    }
    return false;
}

double area(std::span<const Vec3d> corners) {
    Vec3d sum{};
    for (std::size_t i = 2; i < corners.size(); ++i) sum += cross(corners[i - 1] - corners[0], corners[i] - corners[0]);
    return 0.5 * length(sum);
}

PolygonBsp built(const TriangleMesh& mesh, const PolygonBspOptions& options = {}) {
    auto tree = PolygonBsp::build(mesh, options);
    if (!tree) ADD_FAILURE() << mesh.positions.size() << " corners: " << tree.error().text();
    return *std::move(tree);
}

TEST(PolygonBsp, FindsTheInteriorOfClosedMeshesSolid) {
    for (const Named& one : closed_meshes()) {
        const PolygonBsp tree = built(one.mesh);
        EXPECT_TRUE(tree.stats().closed) << one.name;
        EXPECT_EQ(tree.stats().mixed, 0u) << one.name;
        Random random(7);
        const Box3 box = box_of(one.mesh, 0.2);
        std::size_t solid = 0;
        for (int i = 0; i < 4000; ++i) {
            const Vec3d p = point_in(box, random);
            const bool expected = winding_number(one.mesh, p) != 0;
            if (tree.is_solid(p) != expected) {
                EXPECT_TRUE(near_surface(tree, p)) << one.name << ": " << p.x << ", " << p.y << ", " << p.z;
            }
            solid += expected ? 1 : 0;
        }
        EXPECT_GT(solid, 200u) << one.name;
        EXPECT_LT(solid, 3800u) << one.name;
    }
}

TEST(PolygonBsp, AgreesWithFormulasOfShapes) {
    const PolygonBsp l = built(concave_l()), ring = built(torus(2, 0.75f, 64, 32)),
                     ball = built(triangles(Sphere{1}, 48));
    Random random(3);
    const Box3 box{{-3, -3, -1}, {3, 3, 2}};
    for (int i = 0; i < 4000; ++i) {
        const Vec3d p = point_in(box, random);
        const bool in_l = p.z > 0 && p.z < 1 && p.x > 0 && p.y > 0 && p.x < 2 && p.y < 2 && (p.x < 1 || p.y < 1);
        EXPECT_EQ(l.is_solid(p), in_l);
        const double out = std::sqrt(p.x * p.x + p.y * p.y) - 2, from_tube = std::sqrt(out * out + p.z * p.z);
        if (std::abs(from_tube - 0.75) > 0.02) {
            EXPECT_EQ(ring.is_solid(p), from_tube < 0.75);
        }
        if (std::abs(length(p) - 1) > 0.02) {
            EXPECT_EQ(ball.is_solid(p), length(p) < 1);
        }
    }
}

TEST(PolygonBsp, CastsRaysLikeBruteForce) {
    auto meshes = closed_meshes();
    for (Named& one : given_meshes()) meshes.push_back(std::move(one));
    for (const Named& one : meshes) {
        const PolygonBsp tree = built(one.mesh);
        Random random(11);
        const Box3 box = box_of(one.mesh, 0.3);
        std::size_t hits = 0;
        for (int i = 0; i < 1500; ++i) {
            const Vec3d from = point_in(box, random);
            Vec3d to = point_in(box, random);
            if (i % 5 == 0) {  // straight at a corner of a triangle
                const std::uint32_t index = one.mesh.indices[random.below(one.mesh.indices.size())];
                to = to_double(one.mesh.positions[index]);
            }
            Ray ray{from, normalized(to_float(to - from))};
            if (i % 7 == 0) ray.direction = {0, i % 2 == 0 ? 1.0f : -1.0f, 0};
            if (i % 3 == 0) ray.length = static_cast<float>(length(to - from));
            const auto expected = cast_ray_brute_force(one.mesh, ray);
            EXPECT_EQ(tree.cast_ray(ray), expected) << one.name << " ray " << i;
            hits += expected ? 1 : 0;
        }
        if (one.mesh.indices.size() > 30) {
            EXPECT_GT(hits, 50u) << one.name;
        }
    }
}

TEST(PolygonBsp, LosesNoAreaToSplits) {
    auto meshes = closed_meshes();
    for (Named& one : given_meshes()) meshes.push_back(std::move(one));
    for (const Named& one : meshes) {
        const PolygonBsp tree = built(one.mesh);
        std::vector<double> sums(one.mesh.indices.size() / 3, 0.0);
        for (const PolygonBsp::Piece& piece : tree.pieces()) sums[piece.triangle] += area(tree.corners(piece));
        double scale = 0;
        for (std::size_t t = 0; t < sums.size(); ++t) scale = std::max(scale, area(corners_of(one.mesh, t)));
        for (std::size_t t = 0; t < sums.size(); ++t)
            EXPECT_NEAR(sums[t], area(corners_of(one.mesh, t)), 1e-12 * scale) << one.name << " triangle " << t;
    }
}

/// Returns the position of each piece in the order of front_to_back().
std::vector<std::size_t> order_from(const PolygonBsp& tree, Vec3d eye) {
    std::vector<std::size_t> position(tree.pieces().size(), 0);
    std::size_t next = 0;
    tree.front_to_back(eye, [&](const PolygonVisit& sight) {
        ++next;
        for (const std::uint32_t piece : sight.pieces) position[piece] = next;
        return true;
    });
    return position;
}

TEST(PolygonBsp, OrdersPiecesSoThatNoneHidesAnEarlierOne) {
    for (const Named& one : closed_meshes()) {
        const PolygonBsp tree = built(one.mesh);
        Random random(5);
        const Box3 box = box_of(one.mesh, 0.5);
        for (int eye_number = 0; eye_number < 8; ++eye_number) {
            const Vec3d eye = point_in(box, random);
            const std::vector<std::size_t> position = order_from(tree, eye);
            EXPECT_EQ(std::count(position.begin(), position.end(), std::size_t{0}), 0) << one.name;
            for (int i = 0; i < 60; ++i) {
                const Vec3d direction = point_in(box, random) - eye;
                std::vector<std::pair<double, std::size_t>> hits_on_ray;
                for (std::size_t p = 0; p < tree.pieces().size(); ++p) {
                    const auto corners = tree.corners(tree.pieces()[p]);
                    for (std::size_t k = 2; k < corners.size(); ++k) {
                        const auto hit = ray_triangle(eye, direction, {corners[0], corners[k - 1], corners[k]});
                        if (hit && hit->margin > 1e-4) hits_on_ray.emplace_back(hit->distance, position[p]);
                    }
                }
                std::sort(hits_on_ray.begin(), hits_on_ray.end());
                for (std::size_t k = 1; k < hits_on_ray.size(); ++k) {
                    if (hits_on_ray[k].first > hits_on_ray[k - 1].first + 1e-5) {
                        EXPECT_GE(hits_on_ray[k].second, hits_on_ray[k - 1].second) << one.name;
                    }
                }
            }
        }
    }
}

TEST(PolygonBsp, StopsWhenVisitReturnsFalse) {
    const PolygonBsp tree = built(triangles(Sphere{1}, 12));
    int calls = 0;
    tree.front_to_back({3, 0, 0}, [&](const PolygonVisit&) { return ++calls < 4; });
    EXPECT_EQ(calls, 4);
}

TEST(PolygonBsp, TreatsAWallOfManyTrianglesAsOnePlane) {
    // A rotated square of 8 by 8 cells, with rounded coordinates: 128 triangles, two leaves.
    TriangleMesh mesh;
    const Vec3 right = normalized(Vec3{1, 0.3f, 0.7f}), up = normalized(cross(right, Vec3{0.2f, 0.9f, -0.4f}));
    for (std::uint32_t i = 0; i <= 8; ++i)
        for (std::uint32_t k = 0; k <= 8; ++k)
            mesh.positions.push_back(right * (0.37f * static_cast<float>(i)) + up * (0.37f * static_cast<float>(k)));
    for (std::uint32_t i = 0; i < 8; ++i)
        for (std::uint32_t k = 0; k < 8; ++k)
            for (const std::uint32_t c :
                 {i * 9 + k, i * 9 + k + 9, i * 9 + k + 10, i * 9 + k, i * 9 + k + 10, i * 9 + k + 1})
                mesh.indices.push_back(c);
    const PolygonBsp tree = built(mesh, {.small_set = 1000});
    EXPECT_EQ(tree.stats().nodes, 1u);
    EXPECT_EQ(tree.stats().splits, 0u);
    EXPECT_FALSE(tree.stats().closed);
}

TEST(PolygonBsp, IsShallowForConvexSets) {
    const PolygonBsp tree = built(triangles(Sphere{1}, 64));
    EXPECT_GT(tree.stats().triangles, 3000u);
    EXPECT_LT(tree.stats().worst_depth, 64u);
    EXPECT_LT(tree.stats().mean_depth, 30);
}

TEST(PolygonBsp, AnswersTheSameWithMixedLeaves) {
    const TriangleMesh mesh = torus(2, 0.75f, 40, 16);
    for (const PolygonBspOptions& options :
         {PolygonBspOptions{.max_depth = 3}, PolygonBspOptions{.max_pieces = 1}, PolygonBspOptions{.max_depth = 1}}) {
        const PolygonBsp tree = built(mesh, options);
        EXPECT_GT(tree.stats().mixed, 0u);
        EXPECT_LE(tree.stats().worst_depth, options.max_depth);
        Random random(2);
        const Box3 box = box_of(mesh, 0.2);
        for (int i = 0; i < 300; ++i) {
            const Vec3d p = point_in(box, random);
            EXPECT_EQ(tree.is_solid(p), winding_number(mesh, p) != 0);
            const Ray ray{p, normalized(to_float(point_in(box, random) - p))};
            EXPECT_EQ(tree.cast_ray(ray), cast_ray_brute_force(mesh, ray));
        }
    }
}

TEST(PolygonBsp, GivesOpenMeshesTheInteriorOfTheirWindingNumber) {
    TriangleMesh lidless = concave_l();
    lidless.indices.resize(lidless.indices.size() - 3);  // a hole in the floor
    const PolygonBsp tree = built(lidless);
    EXPECT_FALSE(tree.stats().closed);
    EXPECT_TRUE(tree.is_solid({0.5, 0.5, 0.9}));
    EXPECT_FALSE(tree.is_solid({0.5, 0.5, 1.1}));
    EXPECT_FALSE(tree.is_solid({1.5, 1.5, 0.5}));
    EXPECT_FALSE(tree.is_solid({0.5, 0.5, -5}));
}

TEST(PolygonBsp, HasTheWindingNumberOfAllSolidAngles) {
    auto meshes = closed_meshes();
    for (Named& one : given_meshes()) meshes.push_back(std::move(one));
    TriangleMesh half = triangles(Sphere{1}, 12);
    half.indices.resize(half.indices.size() / 6 * 3);
    meshes.push_back({"half a sphere", half});
    for (const Named& one : meshes) {
        const PolygonBsp tree = built(one.mesh);
        if (one.mesh.indices.size() == 3) continue;  // flat: winding numbers are ambiguous
        Random random(17);
        const Box3 box = box_of(one.mesh, 0.2);
        for (int i = 0; i < 300; ++i) {
            const Vec3d p = point_in(box, random);
            EXPECT_EQ(tree.winding(p), winding_number(one.mesh, p)) << one.name;
        }
    }
}

TEST(PolygonBsp, IsTheSameTreeForAnyNumberOfThreads) {
    const TriangleMesh mesh = torus(2, 0.75f, 40, 16);
    const auto runner = make_thread_runner(2);
    const PolygonBsp one = built(mesh), two = built(mesh, {.tasks = runner.get()});
    ASSERT_EQ(one.nodes().size(), two.nodes().size());
    ASSERT_EQ(one.leaves().size(), two.leaves().size());
    for (std::size_t i = 0; i < one.leaves().size(); ++i) EXPECT_EQ(one.leaves()[i].inside, two.leaves()[i].inside);
    for (std::size_t i = 0; i < one.nodes().size(); ++i) {
        EXPECT_EQ(one.nodes()[i].plane.normal, two.nodes()[i].plane.normal);
        EXPECT_EQ(one.nodes()[i].children[0], two.nodes()[i].children[0]);
    }
}

TEST(PolygonBsp, DropsTrianglesWithoutArea) {
    TriangleMesh mesh = triangles(Box{{1, 1, 1}});
    mesh.indices.insert(mesh.indices.end(), {0, 0, 1, 2, 2, 2});
    const PolygonBsp tree = built(mesh);
    EXPECT_EQ(tree.stats().dropped, 2u);
    EXPECT_TRUE(tree.is_solid({0, 0, 0}));
    EXPECT_TRUE(tree.stats().closed);
}

TEST(PolygonBsp, RejectsInvalidMeshes) {
    const TriangleMesh cube = triangles(Box{{1, 1, 1}});
    const auto refusal = [](const TriangleMesh& mesh, const PolygonBspOptions& options = {}) {
        const auto tree = PolygonBsp::build(mesh, options);
        return tree ? std::string("built") : tree.error().text();
    };
    EXPECT_EQ(refusal({}), "indices: found 0 triangles without area; expected at least one with area");
    EXPECT_EQ(refusal({{{0, 0, 0}}, {0, 0, 0}}),
              "indices: found 1 triangles without area; expected at least one with area");
    EXPECT_EQ(refusal({{{0, 0, 0}}, {0, 0}}), "indices: found 2 indices; expected a multiple of three");
    EXPECT_EQ(refusal({{{0, 0, 0}}, {0, 0, 1}}), "indices[2]: found corner 1; expected less than 1");
    for (const float bad : {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity(), 2e9f}) {
        TriangleMesh mesh = cube;
        mesh.positions[3].y = bad;
        EXPECT_EQ(PolygonBsp::build(mesh).status(), Status::OutOfRange);
    }
    EXPECT_EQ(PolygonBsp::build(cube, {.weights = {-1, 2}}).status(), Status::BadArgument);
    EXPECT_EQ(PolygonBsp::build(cube, {.candidates = 0}).status(), Status::BadArgument);
    EXPECT_EQ(PolygonBsp::build(cube, {.thickness = -1}).status(), Status::BadArgument);
    EXPECT_EQ(PolygonBsp::build(cube, {.max_depth = 0}).status(), Status::BadArgument);
    EXPECT_EQ(PolygonBsp::build(cube, {.max_depth = 5000}).status(), Status::BadArgument);
}

TEST(PolygonBsp, HandlesExtremePointsAndRays) {
    const PolygonBsp tree = built(triangles(Box{{1, 1, 1}}));
    const double nan = std::numeric_limits<double>::quiet_NaN(), far = 1e300;
    EXPECT_FALSE(tree.is_solid({nan, 0, 0}));
    EXPECT_FALSE(tree.is_solid({far, far, far}));
    EXPECT_FALSE(tree.cast_ray({{nan, 0, 0}, {1, 0, 0}}));
    EXPECT_FALSE(tree.cast_ray({{0, 0, 0}, {0, 0, 0}}));
    const auto hit = tree.cast_ray({{1000, 0.25, 0.5}, {-1, 0, 0}});
    ASSERT_TRUE(hit);
    EXPECT_EQ(hit->distance, 999);
}

TEST(WindingNumber, CountsNestedAndFlippedMeshes) {
    TriangleMesh nested = triangles(Sphere{3}, 16);
    append(nested, triangles(Sphere{2}, 16));
    append(nested, triangles(Box{{0.5f, 0.5f, 0.5f}}));
    EXPECT_EQ(winding_number(nested, {0.1, 0.2, 0.3}), 3);
    EXPECT_EQ(winding_number(nested, {1.1, 0.2, 0.3}), 2);
    EXPECT_EQ(winding_number(nested, {0, 2.5, 0}), 1);
    EXPECT_EQ(winding_number(nested, {0, 4, 0}), 0);
    EXPECT_EQ(winding_number(flipped(nested), {0.1, 0.2, 0.3}), -3);
}

TEST(Boundary, IsEmptyForClosedMeshesAndTheRimOfHoles) {
    for (const Named& one : closed_meshes()) EXPECT_TRUE(boundary_of(one.mesh).empty()) << one.name;
    TriangleMesh open = triangles(Box{{1, 1, 1}});
    open.indices.resize(open.indices.size() - 3);
    EXPECT_EQ(boundary_of(open).size(), 3u);
    append(open, TriangleMesh(open));
    const auto twice = boundary_of(open);
    ASSERT_EQ(twice.size(), 3u);
    EXPECT_EQ(twice[0].count, 2);
}

}  // namespace
}  // namespace fase::level
