/// Shapes under scales and other linear maps.
#include "fase/geometry/scaled.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "fase/geometry/bounds.hpp"
#include "fase/geometry/mass.hpp"
#include "fase/geometry/mesh.hpp"
#include "tests/geometry/random_shapes.hpp"

namespace fase {
namespace {

/// The support value of the shape along `direction`.
float reach(const Shape& shape, Vec3 direction) {
    return std::visit(
        [&](const auto& s) -> float {
            if constexpr (ConvexShape<std::decay_t<decltype(s)>>) {
                return dot(s.core_support(direction), direction) + s.core_radius() * length(direction);
            } else {
                return 0;
            }
        },
        shape);
}

/// The image's support value along a direction must be the shape's along the direction mapped by the transposed matrix.
void expect_image(const RotatedShape& image, const Shape& shape, const Mat3& map, float relative_tolerance) {
    Random random(99);
    float largest = 0;
    for (const Vec3 axis : {map.x, map.y, map.z}) largest = std::max(largest, length(axis));
    const float tolerance = relative_tolerance * largest * outer_radius(shape);
    for (int i = 0; i < 100; ++i) {
        const Vec3 direction = normalized(test::random_vector(random));
        const float expected = reach(shape, transpose_times(map, direction));
        const float found = reach(image.shape, rotate_back(image.rotation, direction));
        ASSERT_LE(found, expected + std::min(tolerance, 2e-4f * largest * outer_radius(shape)))
            << name_of(shape) << " as " << name_of(image.shape);
        ASSERT_GE(found, expected - tolerance) << name_of(shape) << " as " << name_of(image.shape);
    }
}

template <class S> S as(const Result<Shape>& shape) {
    EXPECT_TRUE(shape && std::holds_alternative<S>(*shape));
    return shape && std::holds_alternative<S>(*shape) ? std::get<S>(*shape) : S{};
}

TEST(Scaled, shapes_keep_their_kind_where_possible) {
    EXPECT_EQ(as<Sphere>(scaled(Sphere{2}, {3, 3, 3})), Sphere{6});
    EXPECT_EQ(as<Sphere>(scaled(Sphere{2}, {3, -3, 3})), Sphere{6});
    EXPECT_EQ(as<Box>(scaled(Box{{1, 2, 3}}, {2, -3, 4})), (Box{{2, 6, 12}}));
    EXPECT_EQ(as<Capsule>(scaled(Capsule{1, 2}, {-2, -2, -2})), (Capsule{2, 4}));
    EXPECT_EQ(as<Cylinder>(scaled(Cylinder{1, 2}, {2, 5, -2})), (Cylinder{2, 10}));
    EXPECT_EQ(as<HalfSpace>(scaled(HalfSpace{}, {2, 5, -2})), HalfSpace{});
    EXPECT_NEAR(as<Sphere>(scaled(Sphere{1}, {1, 1.00005f, 1})).radius, 1, 1e-4);
}

TEST(Scaled, other_shapes_become_hulls_inside_the_true_shape_and_near_it) {
    for (const auto& [shape, scale] : {std::pair{Shape(Sphere{2}), Vec3{1, 2, 3}},
                                       {Shape(Capsule{1, 2}), Vec3{1, 3, 1}},
                                       {Shape(Cylinder{1, 2}), Vec3{1, 1, -4}},
                                       {Shape(Capsule{1, 0}), Vec3{2, 1, 1}}}) {
        const Result<Shape> image = scaled(shape, scale);
        ASSERT_TRUE(image) << image.error().text();
        ASSERT_TRUE(std::holds_alternative<ConvexHull>(*image));
        EXPECT_LE(std::get<ConvexHull>(*image).vertices.size(), 202u);
        expect_image({*image, {}}, shape, Mat3::diagonal(scale), 0.025f);
    }
    EXPECT_TRUE(std::holds_alternative<ConvexHull>(*scaled(Sphere{1}, {1, 1.001f, 1})));
}

TEST(Scaled, a_mirrored_hull_is_the_mirror_image) {
    Random random(1);
    const ConvexHull hull = *build_convex_hull(test::random_points(random, 30));
    for (const Vec3 scale : {Vec3{-1, 1, 1}, Vec3{1, -2, 1}, Vec3{-1, -1, -1}, Vec3{-3, 2, -1}}) {
        const Result<Shape> image = scaled(hull, scale);
        ASSERT_TRUE(image);
        const ConvexHull& found = std::get<ConvexHull>(*image);
        ASSERT_EQ(found.vertices.size(), hull.vertices.size());
        for (std::size_t i = 0; i < hull.vertices.size(); ++i) {
            EXPECT_EQ(found.vertices[i], multiply(hull.vertices[i], scale));
        }
        EXPECT_EQ(found.edges.size(), hull.edges.size());
        EXPECT_NEAR(mass_properties(found, 1).mass,
                    mass_properties(hull, 1).mass * std::abs(scale.x * scale.y * scale.z), 1e-4);
    }
}

TEST(Scaled, scales_without_volume_or_with_sizes_out_of_range_are_refused) {
    constexpr float nan = std::numeric_limits<float>::quiet_NaN();
    for (const Vec3 scale :
         {Vec3{0, 1, 1}, Vec3{1, 0, 1}, Vec3{1, 1, nan}, Vec3{1, Aabb::infinity, 1}, Vec3{0, 0, 0}}) {
        EXPECT_EQ(scaled(Box{}, scale).status(), Status::BadArgument);
        EXPECT_EQ(scaled(HalfSpace{}, scale).status(), Status::BadArgument);
    }
    EXPECT_EQ(scaled(Sphere{1}, {1e6f, 1e6f, 1e6f}).status(), Status::BadArgument);
    EXPECT_EQ(scaled(Sphere{1}, {1e-6f, 1e-6f, 1e-6f}).status(), Status::BadArgument);
    EXPECT_EQ(scaled(HalfSpace{}, {1, -1, 1}).status(), Status::Unsupported);
    EXPECT_EQ(transformed(Box{}, {{1, 0, 0}, {1, 0, 0}, {0, 0, 1}}).status(), Status::BadArgument);
}

TEST(Transformed, shapes_have_the_extents_of_the_true_image_for_any_map) {
    Random random(2);
    for (int round = 0; round < 200; ++round) {
        const Mat3 turn = to_matrix(test::random_rotation(random)), other = to_matrix(test::random_rotation(random));
        const float s = random.between(0.5f, 2);
        const Vec3 scale{random.between(0.5f, 2), random.between(0.5f, 2),
                         random.between(0.5f, 2) * (round % 2 == 0 ? 1.f : -1.f)};
        const Mat3 maps[] = {turn, turn * s, turn * Mat3::diagonal(scale), turn * Mat3::diagonal({s, scale.y, s}),
                             turn * Mat3::diagonal(scale) * other};
        for (const Shape& shape :
             {Shape(Sphere{0.5f}), Shape(Box{{1, 2, 0.5f}}), Shape(Capsule{0.5f, 1}), Shape(Cylinder{1, 0.5f}),
              Shape(*build_convex_hull(test::random_points(random, 12)))}) {
            for (const Mat3& map : maps) {
                const Result<RotatedShape> image = transformed(shape, map);
                ASSERT_TRUE(image) << image.error().text();
                const bool same_kind = image->shape.index() == shape.index();
                expect_image(*image, shape, map, same_kind ? 3e-6f : 0.025f);
            }
            EXPECT_EQ(transformed(shape, maps[0])->shape.index(), shape.index());
            EXPECT_EQ(transformed(shape, maps[1])->shape.index(), shape.index());
        }
    }
}

TEST(Transformed, a_half_space_keeps_the_image_of_its_plane) {
    Random random(3);
    for (int round = 0; round < 200; ++round) {
        Mat3 map{test::random_vector(random), test::random_vector(random), test::random_vector(random)};
        if (std::abs(determinant(map)) < 0.05f) continue;
        const Result<RotatedShape> image = transformed(HalfSpace{}, map);
        ASSERT_TRUE(image);
        ASSERT_NEAR(length_squared(image->rotation), 1, 1e-5);
        const Vec3 up = rotate(image->rotation, {0, 1, 0});
        ASSERT_NEAR(dot(up, map * Vec3{1, 0, 0}), 0, 1e-5);
        ASSERT_NEAR(dot(up, map * Vec3{0, 0, 1}), 0, 1e-5);
        ASSERT_GT(dot(up, map * Vec3{0, 1, 0}), 0);
    }
}

TEST(Transformed, the_identity_changes_nothing) {
    Random random(4);
    for (const Shape& shape : test::one_of_each(random)) {
        const Result<RotatedShape> image = transformed(shape, Mat3::identity());
        ASSERT_TRUE(image) << image.error().text();
        EXPECT_EQ(image->rotation, Quat{}) << name_of(shape);
        if (const auto* hull = std::get_if<ConvexHull>(&shape)) {
            EXPECT_EQ(std::get<ConvexHull>(image->shape).vertices, hull->vertices);
        } else {
            EXPECT_EQ(image->shape, shape) << name_of(shape);
        }
    }
}

}  // namespace
}  // namespace fase
