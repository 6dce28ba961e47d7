/// Mass, centre and inertia: known formulas, Monte Carlo integration, and invariance under rigid transforms.
#include "fase/geometry/mass.hpp"

#include <gtest/gtest.h>

#include "fase/geometry/bounds.hpp"
#include "fase/geometry/mesh.hpp"
#include "tests/geometry/random_shapes.hpp"

namespace fase {
namespace {

constexpr double pi = 3.14159265358979323846;

void expect_near(const Mat3& a, const Mat3& b, float tolerance) {
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            ASSERT_NEAR(a[column][row], b[column][row], tolerance) << "row " << row << " column " << column;
        }
    }
}
float trace(const Mat3& m) { return m.x.x + m.y.y + m.z.z; }

TEST(MassProperties, of_every_shape_match_the_formulas) {
    const MassProperties sphere = mass_properties(Sphere{2}, 3);
    EXPECT_FLOAT_EQ(sphere.mass, float(3 * 4.0 / 3 * pi * 8));
    EXPECT_FLOAT_EQ(sphere.inertia.x.x, 0.4f * sphere.mass * 4);

    const MassProperties box = mass_properties(Box{{1, 2, 3}}, 10);
    EXPECT_FLOAT_EQ(box.mass, 480);
    EXPECT_EQ(box.inertia, Mat3::diagonal({480.f / 3 * 13, 480.f / 3 * 10, 480.f / 3 * 5}));

    const MassProperties cylinder = mass_properties(Cylinder{2, 3}, 1);
    EXPECT_FLOAT_EQ(cylinder.mass, float(pi * 4 * 6));
    EXPECT_FLOAT_EQ(cylinder.inertia.y.y, cylinder.mass * 4 / 2);
    EXPECT_FLOAT_EQ(cylinder.inertia.x.x, cylinder.mass * (3 * 4 + 36) / 12);

    const MassProperties capsule = mass_properties(Capsule{1, 2}, 1);
    EXPECT_FLOAT_EQ(capsule.mass, float(pi * 4 + 4.0 / 3 * pi));
    EXPECT_FLOAT_EQ(capsule.inertia.y.y, float(pi * 4 / 2 + 4.0 / 3 * pi * 0.4));

    EXPECT_EQ(mass_properties(HalfSpace{}, 1).mass, 0);
}

TEST(MassProperties, of_a_capsule_of_length_0_equal_those_of_a_sphere) {
    const MassProperties capsule = mass_properties(Capsule{0.7f, 0}, 5), sphere = mass_properties(Sphere{0.7f}, 5);
    EXPECT_FLOAT_EQ(capsule.mass, sphere.mass);
    expect_near(capsule.inertia, sphere.inertia, 1e-6f * trace(sphere.inertia));
}

/// Compares the formula with the hull of a fine tessellation.
TEST(MassProperties, of_round_shapes_match_those_of_a_finely_tessellated_hull) {
    Random random(1);
    for (int round = 0; round < 4; ++round) {
        for (const Shape& shape :
             {Shape(Sphere{random.between(0.2f, 2)}), Shape(Capsule{random.between(0.2f, 2), random.between(0, 2)}),
              Shape(Cylinder{random.between(0.2f, 2), random.between(0.2f, 2)})}) {
            const Result<ConvexHull> hull = build_convex_hull(sample_points(shape, 128), {1 << 20});
            ASSERT_TRUE(hull) << hull.error().text();
            const MassProperties of_shape = mass_properties(shape, 2), of_hull = mass_properties(*hull, 2);
            EXPECT_NEAR(of_hull.mass / of_shape.mass, 1, 2e-3) << name_of(shape);
            EXPECT_LT(of_hull.mass, of_shape.mass);
            EXPECT_LT(length(of_hull.centre), 1e-5f);
            expect_near(of_hull.inertia, of_shape.inertia, 3e-3f * trace(of_shape.inertia));
        }
    }
}

/// An independent reference for all shapes: Monte Carlo integration over the bounding box.
TEST(MassProperties, of_every_shape_match_monte_carlo_integration) {
    Random random(2);
    for (const Shape& shape :
         {Shape(Sphere{0.8f}), Shape(Box{{0.3f, 0.7f, 0.5f}}), Shape(Capsule{0.4f, 0.6f}), Shape(Cylinder{0.5f, 0.4f}),
          Shape(*build_convex_hull(test::random_points(random, 30)))}) {
        const Aabb box = bounds(shape, {});
        const Vec3 size = extent(box);
        constexpr int samples = 400000;
        double inside = 0;
        Vec3d sum;
        Mat3d squares;
        for (int i = 0; i < samples; ++i) {
            const Vec3 p = box.lo + multiply(size, {random.unit(), random.unit(), random.unit()});
            if (!test::is_inside(shape, p)) continue;
            const Vec3d d = to_double(p);
            inside += 1;
            sum += d;
            squares = squares + Mat3d{d * d.x, d * d.y, d * d.z};
        }
        const MassProperties found = mass_properties(shape, 7);
        const double sample_mass = 7.0 * size.x * size.y * size.z / samples;
        EXPECT_NEAR(found.mass / (inside * sample_mass), 1, 0.01) << name_of(shape);
        const Vec3d centre = sum * (1 / inside);
        EXPECT_LT(length(to_float(centre) - found.centre), 0.004f) << name_of(shape);
        const Mat3d second = squares * sample_mass -
                             Mat3d{centre * centre.x, centre * centre.y, centre * centre.z} * (inside * sample_mass);
        const double t = second.x.x + second.y.y + second.z.z;
        expect_near(to_float(Mat3d::diagonal({t, t, t}) - second), found.inertia, 0.01f * trace(found.inertia));
    }
}

TEST(MassProperties, of_a_box_hull_far_from_its_origin_equal_those_of_the_box) {
    const Box box{{0.5f, 1, 0.25f}};
    std::vector<Vec3> points = sample_points(box);
    for (Vec3& p : points) p += Vec3{1000, -2000, 3000};
    const MassProperties found = mass_properties(*build_convex_hull(points), 10), expected = mass_properties(box, 10);
    EXPECT_FLOAT_EQ(found.mass, expected.mass);
    EXPECT_EQ(found.centre, (Vec3{1000, -2000, 3000}));
    expect_near(found.inertia, expected.inertia, 1e-5f * trace(expected.inertia));
}

TEST(MassProperties, of_a_transformed_hull_equal_the_transformed_properties) {
    Random random(3);
    for (int round = 0; round < 100; ++round) {
        const std::vector<Vec3> points = test::random_points(random, 20);
        const LocalPose pose{test::random_vector(random, 2), test::random_rotation(random)};
        std::vector<Vec3> there = points;
        for (Vec3& p : there) p = transform(pose, p);
        const MassProperties after = transformed(mass_properties(*build_convex_hull(points), 3), pose);
        const MassProperties before = mass_properties(*build_convex_hull(there), 3);
        ASSERT_NEAR(after.mass, before.mass, 1e-4f);
        ASSERT_LT(length(after.centre - before.centre), 1e-5f);
        expect_near(after.inertia, before.inertia, 1e-4f);
    }
}

TEST(CombinedMass, of_a_box_cut_in_eight_is_the_box) {
    const MassProperties eighth = mass_properties(Box{{0.5f, 1, 1.5f}}, 4);
    std::vector<MassProperties> parts;
    for (int i = 0; i < 8; ++i) {
        const Vec3 side{i & 1 ? 1.f : -1.f, i & 2 ? 1.f : -1.f, i & 4 ? 1.f : -1.f};
        parts.push_back(transformed(eighth, {multiply({0.5f, 1, 1.5f}, side) + Vec3{9, 8, 7}, {}}));
    }
    const MassProperties found = combined(parts), expected = mass_properties(Box{{1, 2, 3}}, 4);
    EXPECT_FLOAT_EQ(found.mass, expected.mass);
    EXPECT_EQ(found.centre, (Vec3{9, 8, 7}));
    expect_near(found.inertia, expected.inertia, 1e-5f * trace(expected.inertia));
}

TEST(CombinedMass, of_no_parts_or_massless_parts_is_zero) {
    EXPECT_EQ(combined({}).mass, 0);
    const MassProperties ground[] = {mass_properties(HalfSpace{}, 1)};
    EXPECT_EQ(combined(ground).mass, 0);
    EXPECT_EQ(combined(ground).inertia, Mat3{});
}

TEST(PrincipalInertia, of_a_diagonal_matrix_is_exactly_its_diagonal_without_a_rotation) {
    for (const Vec3 d : {Vec3{1, 2, 3}, Vec3{3, 2, 1}, Vec3{2, 2, 2}, Vec3{1e-20f, 1e20f, 1}, Vec3{5, 5, 1}}) {
        const PrincipalInertia found = principal(Mat3::diagonal(d));
        EXPECT_EQ(found.moments, d);
        EXPECT_EQ(found.axes, Quat{});
    }
}

TEST(PrincipalInertia, reproduces_the_matrix) {
    Random random(4);
    for (int round = 0; round < 2000; ++round) {
        Vec3 moments{test::random_size(random), test::random_size(random), test::random_size(random)};
        if (round % 5 == 0) moments.y = moments.x;
        if (round % 25 == 0) moments.z = moments.x;
        const Mat3 r = to_matrix(test::random_rotation(random));
        const Mat3 inertia = r * Mat3::diagonal(moments) * transpose(r);
        const PrincipalInertia found = principal(inertia);
        ASSERT_NEAR(length_squared(found.axes), 1, 1e-6);
        const Mat3 axes = to_matrix(found.axes);
        expect_near(axes * Mat3::diagonal(found.moments) * transpose(axes), inertia, 2e-6f * trace(inertia));
    }
}

/// No other permutation of the axes has a smaller rotation: each axis is within 90° of its world axis, and the angle is
/// at most 63° (the largest distance of a rotation from the 24 rotations of a cube).
TEST(PrincipalInertia, has_the_smallest_possible_rotation) {
    Random random(5);
    for (int round = 0; round < 2000; ++round) {
        const Mat3 r = to_matrix(test::random_rotation(random));
        const PrincipalInertia found = principal(r * Mat3::diagonal({1, 2, 3}) * transpose(r));
        ASSERT_GE(found.axes.w, std::cos(63.0f / 2 * 3.14159265f / 180)) << "round " << round;
    }
}

TEST(PrincipalInertia, of_NaN_and_infinity_terminates) {
    const float nan = std::nanf("");
    (void)principal(Mat3::diagonal({nan, 1, 2}));
    (void)principal({{1, nan, 0}, {nan, 1, 0}, {0, 0, 1}});
    (void)principal({{1, Aabb::infinity, 0}, {Aabb::infinity, 1, 0}, {0, 0, 1}});
}

std::string complaint(const MassProperties& properties) {
    const Result<void> result = check(properties);
    return result ? "" : result.error().text();
}

TEST(MassCheck, passes_the_properties_of_every_solid) {
    Random random(6);
    for (int round = 0; round < 300; ++round) {
        for (const Shape& shape : test::one_of_each(random)) {
            if (!is_solid(shape)) continue;
            EXPECT_EQ(complaint(mass_properties(shape, random.between(0.01f, 1e4f))), "") << name_of(shape);
        }
    }
}

TEST(MassCheck, names_the_fault) {
    const float nan = std::nanf(""), inf = Aabb::infinity;
    const MassProperties good{1, {}, Mat3::diagonal({1, 2, 3})};
    EXPECT_EQ(complaint(good), "") << "the flat limit of the triangle rule is allowed";
    const auto with_mass = [&](float mass) { return MassProperties{mass, good.centre, good.inertia}; };
    const auto with_inertia = [&](const Mat3& inertia) { return MassProperties{1, {}, inertia}; };
    for (const float mass : {0.f, -2.f, nan, inf}) {
        EXPECT_NE(complaint(with_mass(mass)).find("mass"), std::string::npos) << mass;
    }
    EXPECT_NE(complaint({1, {0, nan, 0}, good.inertia}).find("centre"), std::string::npos);
    EXPECT_NE(complaint(with_inertia(Mat3::diagonal({1, nan, 1}))).find("not finite"), std::string::npos);
    EXPECT_NE(complaint(with_inertia({{1, 0.5f, 0}, {0, 1, 0}, {0, 0, 1}})).find("not symmetric"), std::string::npos);
    EXPECT_NE(complaint(with_inertia(Mat3::diagonal({1, 0, 1}))).find("above 0"), std::string::npos);
    EXPECT_NE(complaint(with_inertia(Mat3::diagonal({-1, 1, 1}))).find("above 0"), std::string::npos);
    EXPECT_NE(complaint(with_inertia({{1, 2, 0}, {2, 1, 0}, {0, 0, 1}})).find("above 0"), std::string::npos);
    EXPECT_NE(complaint(with_inertia(Mat3::diagonal({1, 1, 2.1f}))).find("sum of the other two"), std::string::npos);
    EXPECT_EQ(complaint(with_inertia(Mat3::diagonal({1, 1, 2.0001f}))), "") << "a rounding beyond the flat limit";
}

}  // namespace
}  // namespace fase
