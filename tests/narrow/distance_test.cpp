/// Signed distances: proofs by witness points and separating planes, exact formulas, symmetry, degenerate poses.
#include "fase/narrow/distance.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>
#include <vector>

#include "tests/narrow/random_shapes.hpp"

namespace fase {
namespace {

using narrow::Distance;
using narrow::signed_distance;
using namespace test;

/// Checks a distance by its witness points and plane; returns the fault, or an empty string.
std::string wrong_with(const Distance& d, const Shape& a, const Shape& b, const TransformD& x, double tolerance) {
    if (!(std::abs(length(d.normal) - 1) < 1e-12)) return "normal not unit";
    if (!(length(d.on_b - d.on_a - d.normal * d.distance) < tolerance)) return "points are not `distance` apart";
    // The gap along the normal proves that the shapes are at least that far apart; the points prove that they are no
    // farther. When the shapes overlap, the translation along the normal separates them.
    if (!(std::abs(gap_along(a, b, x, d.normal) - d.distance) < tolerance)) return "gap along the normal differs";
    const double out_a = outside(a, d.on_a), out_b = outside(b, transform_back(x, d.on_b));
    if (!(std::abs(out_a) < tolerance)) return "point of a off its surface by " + std::to_string(out_a * 1e9) + " nm";
    if (!(std::abs(out_b) < tolerance)) return "point of b off its surface by " + std::to_string(out_b * 1e9) + " nm";
    return "";
}

double tolerance_of(const Shape& a, const Shape& b) {
    const auto either = [&]<class S>(std::type_identity<S>) {
        return std::holds_alternative<S>(a) || std::holds_alternative<S>(b);
    };
    // The planes of a hull are floats, and so is the reference for its points; penetrations of cylinders are iterative;
    // cores that nearly touch have a normal accurate to the square root of rounding.
    if (either(std::type_identity<ConvexHull>{})) return 3e-6;
    return either(std::type_identity<Cylinder>{}) ? 3e-6 : 3e-9;
}

TEST(Distance, IsProvedByItsPointsAndPlaneForRandomPairsOfAllKinds) {
    Random random(1);
    int apart = 0, deep = 0;
    for (int i = 0; i < 100000; ++i) {
        const Shape a = random_shape(random, random.below(bounded_kinds));
        const Shape b = random_shape(random, random.below(bounded_kinds));
        const TransformD x = random_transform(random, 2);
        const Distance d = signed_distance(a, b, x);
        (d.distance > 0 ? apart : deep) += 1;
        const std::string wrong = wrong_with(d, a, b, x, tolerance_of(a, b));
        ASSERT_EQ(wrong, "") << i << " " << name_of(a) << " " << name_of(b) << " " << d.distance;
    }
    EXPECT_GT(apart, 20000);
    EXPECT_GT(deep, 10000);
}

TEST(Distance, IsProvedForNeedlesPlatesAndDust) {
    Random random(2);
    for (int i = 0; i < 20000; ++i) {
        const Shape a = random_shape(random, random.below(4), 1e6f);
        const Shape b = random_shape(random, random.below(4), 1e6f);
        TransformD x = random_transform(random, 1.5);
        if (i % 3 == 0) x.position = x.position * 1e-3;
        const Distance d = signed_distance(a, b, x);
        // A point near the axis of a wide cylinder has nearly the same depth in all radial directions.
        const double tolerance = tolerance_of(a, b) * 20;
        ASSERT_EQ(wrong_with(d, a, b, x, tolerance), "") << i << " " << name_of(a) << " " << name_of(b);
    }
}

TEST(Distance, NoDirectionHasASmallerDepth) {
    Random random(3);
    int checked = 0;
    while (checked < 1500) {
        const Shape a = random_shape(random, random.below(bounded_kinds));
        const Shape b = random_shape(random, random.below(bounded_kinds));
        const TransformD x = random_transform(random, 1);
        const Distance d = signed_distance(a, b, x);
        if (d.distance > 0) continue;
        ++checked;
        // Many directions, and a descent from the best of them.
        double best = 1e300;
        Vec3d direction;
        const auto attempt = [&](Vec3d n) {
            const double depth = -gap_along(a, b, x, n);
            if (depth < best) {
                best = depth;
                direction = n;
            }
        };
        for (int i = 0; i < 300; ++i) attempt(random_direction(random));
        for (double step = 0.2; step > 1e-4; step *= 0.7) {
            for (int i = 0; i < 12; ++i) attempt(normalized(direction + random_direction(random) * step));
        }
        ASSERT_GT(best, -d.distance - 1e-6) << name_of(a) << " " << name_of(b);
    }
}

TEST(Distance, IsSymmetricAndInvariantUnderRigidMotion) {
    Random random(4);
    for (int i = 0; i < 20000; ++i) {
        const Shape a = random_shape(random, random.below(solid_or_ground_kinds));
        const Shape b = random_shape(random, random.below(bounded_kinds));
        const TransformD x = random_transform(random, 2);
        const Distance d = signed_distance(a, b, x), back = signed_distance(b, a, inverse(x));
        const double tolerance = tolerance_of(a, b);
        ASSERT_NEAR(d.distance, back.distance, tolerance) << i << " " << name_of(a) << " " << name_of(b);
        if (d.distance > 1e-3) {
            ASSERT_LT(length(d.normal + x.rotation * back.normal), 1e-4) << i << name_of(a) << name_of(b);
        }
        const TransformD motion = random_transform(random, 10);
        const TransformD again = inverse(motion) * (motion * x);
        ASSERT_NEAR(signed_distance(a, b, again).distance, d.distance, tolerance);
    }
}

TEST(Distance, OfSpheresAndCapsulesMatchesTheFormulas) {
    Random random(5);
    for (int i = 0; i < 20000; ++i) {
        const Sphere a{random_size(random, 100)};
        const Vec3d p = to_double(random_in_cube(random)) * 2;
        const Sphere b{random_size(random, 100)};
        TransformD x = random_transform(random, 1);
        x.position = p;
        ASSERT_NEAR(signed_distance(a, b, x).distance, length(p) - double(a.radius) - double(b.radius), 1e-14);
        const Capsule c{random_size(random, 100), random_size(random, 100)};
        ASSERT_NEAR(signed_distance(c, a, x).distance, outside(c, p) - double(a.radius), 1e-14);
        const Box box{{random_size(random, 10), random_size(random, 10), random_size(random, 10)}};
        const Vec3d over = max(abs(p) - to_double(box.half), Vec3d{});
        const double box_distance = length_squared(over) > 0 ? length(over) : outside(box, p);
        ASSERT_NEAR(signed_distance(box, a, x).distance, box_distance - double(a.radius), 1e-14);
        const Cylinder cylinder{random_size(random, 10), random_size(random, 10)};
        const double side = std::sqrt(p.x * p.x + p.z * p.z) - double(cylinder.radius);
        const double cap = std::abs(p.y) - double(cylinder.half_height);
        const double cylinder_distance = side > 0 && cap > 0 ? std::sqrt(side * side + cap * cap) : std::max(side, cap);
        ASSERT_NEAR(signed_distance(cylinder, a, x).distance, cylinder_distance - double(a.radius), 1e-9) << i;
    }
}

TEST(Distance, OfTheSameShapeAsBoxAndAsHullAgrees) {
    Random random(6);
    for (int i = 0; i < 5000; ++i) {
        const Box box{{random_size(random, 10), random_size(random, 10), random_size(random, 10)}};
        const Shape hull = box_hull(box.half);
        const Shape other = random_shape(random, random.below(bounded_kinds));
        const TransformD x = random_transform(random, 1.5);
        ASSERT_NEAR(signed_distance(box, other, x).distance, signed_distance(hull, other, x).distance, 1e-7) << i;
    }
}

TEST(Distance, IsFiniteAndProvedForTouchingAndCoincidentShapes) {
    Random random(7);
    const std::vector<Shape> shapes{Sphere{0.5f}, Box{{0.5f, 0.5f, 0.5f}}, Capsule{0.25f, 0.5f}, Cylinder{0.5f, 0.5f},
                                    box_hull({0.5f, 0.5f, 0.5f})};
    for (const Shape& a : shapes) {
        for (const Shape& b : shapes) {
            for (const Vec3d at : {Vec3d{}, Vec3d{1, 0, 0}, Vec3d{0, 1, 0}, Vec3d{0, 0, -1}, Vec3d{1, 1, 1},
                                   Vec3d{1, 1, 0}, Vec3d{0.5, 0, 0}, Vec3d{0, 0.5, 0}, Vec3d{0, 1.5, 0}}) {
                for (int turn = 0; turn < 4; ++turn) {
                    TransformD x;
                    x.position = at;
                    if (turn == 1) x.rotation = {{0, 1, 0}, {-1, 0, 0}, {0, 0, 1}};
                    if (turn == 2) x.rotation = to_matrix(rotation_about(Vec3d{0, 1, 0}, 0.785398163397448));
                    if (turn == 3) x.rotation = to_matrix(random_rotation(random));
                    const Distance d = signed_distance(a, b, x);
                    const std::string wrong = wrong_with(d, a, b, x, tolerance_of(a, b));
                    EXPECT_EQ(wrong, "") << name_of(a) << " " << name_of(b) << " " << at.x << at.y << at.z << " turn "
                                         << turn << " distance " << d.distance;
                    for (const double nudge : {1e-15, 1e-12, 1e-9, 1e-7}) {
                        TransformD y = x;
                        y.position += random_direction(random) * nudge;
                        const Distance e = signed_distance(a, b, y);
                        EXPECT_EQ(wrong_with(e, a, b, y, tolerance_of(a, b)), "")
                            << name_of(a) << " " << name_of(b) << at.x << at.y << at.z << " turn " << turn << " "
                            << e.distance << " " << nudge << " n " << e.normal.x << " " << e.normal.y << " "
                            << e.normal.z;
                        EXPECT_NEAR(e.distance, d.distance, nudge + tolerance_of(a, b));
                    }
                }
            }
        }
    }
}

TEST(Distance, FarFromTheOriginKeepsItsRelativePrecision) {
    Random random(8);
    for (int i = 0; i < 5000; ++i) {
        const Shape a = random_shape(random, random.below(bounded_kinds));
        const Shape b = random_shape(random, random.below(bounded_kinds));
        const Vec3d direction = random_direction(random);
        TransformD x = random_transform(random, 1);
        x.position = direction * 1e7;
        const Distance d = signed_distance(a, b, x);
        ASSERT_NEAR(gap_along(a, b, x, d.normal), d.distance, 1e-7) << i << name_of(a) << name_of(b);
        ASSERT_LT(length(d.on_b - d.on_a - d.normal * d.distance), 1e-7);
    }
}

TEST(Distance, ToAHalfSpaceIsTheHeightOfTheLowestPoint) {
    Random random(9);
    for (int i = 0; i < 5000; ++i) {
        const Shape b = random_shape(random, random.below(bounded_kinds));
        const TransformD x = random_transform(random, 2);
        const Distance d = signed_distance(HalfSpace{}, b, x);
        const Vec3d lowest = transform(x, support(b, transpose_times(x.rotation, Vec3d{0, -1, 0})));
        ASSERT_NEAR(d.distance, lowest.y, 1e-12);
        ASSERT_EQ(d.normal, (Vec3d{0, 1, 0}));
        ASSERT_NEAR(d.on_a.y, 0, 1e-12);
        ASSERT_NEAR(outside(b, transform_back(x, d.on_b)), 0, tolerance_of(b, b));
        ASSERT_EQ(narrow::overlaps(HalfSpace{}, b, x), d.distance <= 0);
    }
}

TEST(Distance, OfTwoHalfSpacesIsMinusInfinityUnlessTheyFaceEachOther) {
    TransformD x;
    x.position = {3, 5, 0};
    EXPECT_EQ(signed_distance(HalfSpace{}, HalfSpace{}, x).distance, -std::numeric_limits<double>::infinity());
    x.rotation = {{1, 0, 0}, {0, -1, 0}, {0, 0, -1}};
    EXPECT_EQ(signed_distance(HalfSpace{}, HalfSpace{}, x).distance, 5);
    x.position.y = -2;
    EXPECT_EQ(signed_distance(HalfSpace{}, HalfSpace{}, x).distance, -2);
    EXPECT_TRUE(narrow::overlaps(HalfSpace{}, HalfSpace{}, x));
}

TEST(Overlaps, AgreesWithTheSignOfTheDistance) {
    Random random(10);
    for (int i = 0; i < 30000; ++i) {
        const Shape a = random_shape(random, random.below(solid_or_ground_kinds));
        const Shape b = random_shape(random, random.below(solid_or_ground_kinds));
        const TransformD x = random_transform(random, 2);
        const double d = signed_distance(a, b, x).distance;
        if (std::abs(d) > 1e-8) {
            ASSERT_EQ(narrow::overlaps(a, b, x), d < 0) << i << name_of(a) << name_of(b);
        }
    }
}

}  // namespace
}  // namespace fase
