/// check(Shape): valid shapes, refused shapes and their error messages.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "fase/geometry/mass.hpp"
#include "tests/geometry/random_shapes.hpp"

namespace fase {
namespace {

std::string complaint(const Shape& shape) {
    const Result<void> result = check(shape);
    return result ? "" : result.error().text();
}

TEST(ShapeCheck, passes_random_shapes_of_every_kind) {
    Random random(1);
    for (int round = 0; round < 200; ++round) {
        for (const Shape& shape : test::one_of_each(random)) EXPECT_EQ(complaint(shape), "");
    }
}

TEST(ShapeCheck, names_the_size_that_is_out_of_range) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    for (const float bad : {0.f, -1.f, 0.9e-4f, 1.1e5f, nan, inf, -inf}) {
        EXPECT_NE(complaint(Sphere{bad}).find("sphere.radius"), std::string::npos) << bad;
        EXPECT_NE(complaint(Box{{bad, 1, 1}}).find("box.half.x"), std::string::npos) << bad;
        EXPECT_NE(complaint(Box{{1, bad, 1}}).find("box.half.y"), std::string::npos) << bad;
        EXPECT_NE(complaint(Box{{1, 1, bad}}).find("box.half.z"), std::string::npos) << bad;
        EXPECT_NE(complaint(Capsule{bad, 1}).find("capsule.radius"), std::string::npos) << bad;
        EXPECT_NE(complaint(Cylinder{bad, 1}).find("cylinder.radius"), std::string::npos) << bad;
        EXPECT_NE(complaint(Cylinder{1, bad}).find("cylinder.half_height"), std::string::npos) << bad;
        if (bad == 0) continue;
        EXPECT_NE(complaint(Capsule{1, bad}).find("capsule.half_length"), std::string::npos) << bad;
    }
    EXPECT_EQ(complaint(Capsule{1, 0}), "") << "a capsule may be a sphere";
    EXPECT_EQ(complaint(Sphere{1e-4f}), "");
    EXPECT_EQ(complaint(Sphere{1e5f}), "");
    EXPECT_EQ(complaint(Sphere{-2}), "sphere.radius: found -2; expected a length from 1e-4 to 1e5 m");
}

TEST(ShapeCheck, refuses_corrupted_hulls) {
    Random random(2);
    const ConvexHull good = *build_convex_hull(test::random_points(random, 30));
    const auto corrupted = [&](const std::function<void(ConvexHull&)>& change) {
        ConvexHull hull = good;
        change(hull);
        return complaint(hull);
    };
    EXPECT_EQ(corrupted([](ConvexHull&) {}), "");
    EXPECT_NE(complaint(ConvexHull{}), "");
    EXPECT_NE(corrupted([](ConvexHull& h) { h.vertices.resize(3); }), "");
    EXPECT_NE(corrupted([](ConvexHull& h) { h.vertices.pop_back(); }), "");
    EXPECT_NE(corrupted([](ConvexHull& h) { h.vertices[0] = h.vertices[0] * 3; }), "");
    EXPECT_NE(corrupted([](ConvexHull& h) { h.vertices[0].y = std::numeric_limits<float>::quiet_NaN(); }), "");
    EXPECT_NE(corrupted([](ConvexHull& h) { h.vertices[1].x = 2e5f; }), "");
    EXPECT_NE(corrupted([](ConvexHull& h) { h.faces.pop_back(); }), "");
    EXPECT_NE(corrupted([](ConvexHull& h) { h.faces[1].first = 0; }), "");
    EXPECT_NE(corrupted([](ConvexHull& h) { h.faces[1].count = 0xffffffff; }), "");
    EXPECT_NE(corrupted([](ConvexHull& h) { h.faces[1].plane.normal = h.faces[1].plane.normal * 2; }), "");
    EXPECT_NE(corrupted([](ConvexHull& h) { h.faces[1].plane.offset -= 0.1f; }), "");
    EXPECT_NE(corrupted([](ConvexHull& h) { h.face_vertices[2] = 1000; }), "");
    EXPECT_NE(corrupted([](ConvexHull& h) { std::swap(h.face_vertices[0], h.face_vertices[1]); }), "");
    EXPECT_NE(corrupted([](ConvexHull& h) { h.edges.pop_back(); }), "");
    EXPECT_NE(corrupted([](ConvexHull& h) { std::swap(h.edges[3].face_a, h.edges[3].face_b); }), "");
    EXPECT_NE(corrupted([](ConvexHull& h) { h.edges[3].face_a = 5000; }), "");
    EXPECT_NE(corrupted([](ConvexHull& h) { std::swap(h.edges[3].from, h.edges[3].to); }), "");
}

}  // namespace
}  // namespace fase
