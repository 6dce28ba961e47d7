/// Shape casts: closed forms, bisection on the distance, swapped shapes, thin targets, grazing casts.
#include "fase/narrow/cast_shape.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "fase/geometry/bounds.hpp"
#include "fase/narrow/detail/advance.hpp"
#include "fase/narrow/distance.hpp"
#include "tests/math/arbitrary.hpp"
#include "tests/narrow/random_shapes.hpp"

namespace fase {
namespace {

using narrow::advance_tolerance;
using narrow::cast_shape;
using narrow::ShapeOnShape;
using namespace test;

constexpr float inf = std::numeric_limits<float>::infinity();

Pose random_pose(Random& random, double reach) {
    return {to_double(random_in_cube(random)) * reach, to_float(random_rotation(random))};
}
Pose moved_along(Pose pose, Vec3 direction, double by) {
    pose.position += to_double(direction) * by;
    return pose;
}
double gap(const Shape& target, const Pose& target_pose, const Shape& mover, const Pose& mover_pose) {
    return narrow::signed_distance(target, mover, exactly_relative(target_pose, mover_pose)).distance;
}

/// A case that often hits: two shapes some metres apart and a direction roughly from one to the other.
struct Case {
    Shape mover, target;
    Pose from, target_pose;
    Vec3 direction;
    float length = 0;
};
Case random_case(Random& random, std::size_t mover_kind, std::size_t target_kind, float ratio = 4) {
    Case c{random_shape(random, mover_kind, ratio),
           random_shape(random, target_kind, ratio),
           random_pose(random, 4),
           random_pose(random, 1),
           {},
           0};
    const Vec3d aim = c.target_pose.position + to_double(random_in_cube(random)) * 1.5 - c.from.position;
    c.direction = to_float(normalized(aim));
    c.length = random.below(2) == 0 ? inf : random.between(0, 10);
    return c;
}
std::optional<ShapeOnShape> cast(const Case& c) {
    return cast_shape(c.mover, c.from, c.direction, c.length, c.target, c.target_pose);
}

TEST(CastShape, OfSpheresEqualsTheFormula) {
    Random random(1);
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const Case c = random_case(random, 0, 0);
        const double sum = double(std::get<Sphere>(c.mover).radius) + double(std::get<Sphere>(c.target).radius);
        const Vec3d from = c.from.position - c.target_pose.position, direction = to_double(c.direction);
        const double middle = -dot(from, direction) / length_squared(direction);
        const double half_chord_squared = sum * sum - length_squared(from + direction * middle);
        const auto hit = cast(c);
        if (std::abs(half_chord_squared) < 1e-6) continue;  // a grazing cast: depends on rounding
        const double expected =
            length(from) <= sum ? 0 : middle - std::sqrt(half_chord_squared / length_squared(direction));
        if (!(half_chord_squared > 0) || middle < 0 || expected > double(c.length)) {
            ASSERT_EQ(hit.has_value(), length(from) <= sum) << i;
            continue;
        }
        ++hits;
        ASSERT_TRUE(hit) << i;
        if (expected == 0) {
            ASSERT_EQ(hit->distance, 0) << i;
            continue;
        }
        ASSERT_LE(hit->distance, expected + 1e-9) << i;
        ASSERT_GE(hit->distance, expected - 1e-6 / std::abs(dot(to_double(hit->normal), direction))) << i;
        ASSERT_LT(length(to_double(hit->normal) - normalized(from + direction * expected)), 1e-5) << i;
        const Vec3d point = c.target_pose.position + to_double(hit->normal) * double(std::get<Sphere>(c.target).radius);
        ASSERT_LT(length(hit->point - point), 1e-5) << i;
    }
    EXPECT_GT(hits, 3000);
}

TEST(CastShape, OfASphereOnGroundEqualsTheFormula) {
    const auto straight = cast_shape(Sphere{0.5f}, {{3, 10, 4}, {}}, {0, -1, 0}, inf, HalfSpace{}, {});
    ASSERT_TRUE(straight);
    EXPECT_NEAR(straight->distance, 9.5, 1e-9);
    EXPECT_EQ(straight->normal, (Vec3{0, 1, 0}));
    EXPECT_LT(length(straight->point - Vec3d{3, 0, 4}), 1e-9);
    const auto slanted = cast_shape(Sphere{0.5f}, {{0, 10, 0}, {}}, {0.8f, -0.6f, 0}, inf, HalfSpace{}, {});
    ASSERT_TRUE(slanted);
    EXPECT_NEAR(slanted->distance, 9.5 / double(0.6f), 1e-6);
    EXPECT_FALSE(cast_shape(Sphere{0.5f}, {{0, 10, 0}, {}}, {0.8f, -0.6f, 0}, 15, HalfSpace{}, {}));
    EXPECT_FALSE(cast_shape(Sphere{0.5f}, {{0, 10, 0}, {}}, {1, 0, 0}, inf, HalfSpace{}, {}));
    EXPECT_FALSE(cast_shape(Sphere{0.5f}, {{0, 10, 0}, {}}, {0, 1, 0}, inf, HalfSpace{}, {}));
    // The half-space may also be the moving shape.
    const auto rising = cast_shape(HalfSpace{}, {}, {0, 1, 0}, inf, Sphere{0.5f}, {{3, 10, 4}, {}});
    ASSERT_TRUE(rising);
    EXPECT_NEAR(rising->distance, 9.5, 1e-9);
    EXPECT_EQ(rising->normal, (Vec3{0, -1, 0}));
}

TEST(CastShape, OfBoxesAlongTheirAxesEqualsTheGap) {
    const Shape box = Box{{1, 1, 1}};
    const auto face = cast_shape(box, {{-10, 0.5, 0.25}, {}}, {1, 0, 0}, inf, box, {});
    ASSERT_TRUE(face);
    EXPECT_NEAR(face->distance, 8, 1e-12);
    EXPECT_EQ(face->normal, (Vec3{-1, 0, 0}));
    EXPECT_NEAR(face->point.x, -1, 1e-12);
    EXPECT_TRUE(cast_shape(box, {{-10, 0, 0}, {}}, {1, 0, 0}, 8, box, {}));
    EXPECT_FALSE(cast_shape(box, {{-10, 0, 0}, {}}, {1, 0, 0}, 7.99f, box, {}));
    EXPECT_FALSE(cast_shape(box, {{-10, 2.0001, 0}, {}}, {1, 0, 0}, inf, box, {}));
    EXPECT_TRUE(cast_shape(box, {{-10, 1.9999, 0}, {}}, {1, 0, 0}, inf, box, {}));
    // Corner against corner.
    const float third = 0.57735027f;
    const auto corner = cast_shape(box, {{-5, -5, -5}, {}}, {third, third, third}, inf, box, {});
    ASSERT_TRUE(corner);
    EXPECT_NEAR(corner->distance, 3 / double(third), 1e-6);
}

/// Checks all properties of a result; finds the touch independently by bisection.
void expect_correct(const Case& c, const std::optional<ShapeOnShape>& hit, const std::string& what) {
    const double tolerance = advance_tolerance(c.target, c.mover);
    const double start = gap(c.target, c.target_pose, c.mover, c.from);
    const auto gap_at = [&](double distance) {
        return gap(c.target, c.target_pose, c.mover, moved_along(c.from, c.direction, distance));
    };
    if (start <= 0) {
        ASSERT_TRUE(hit) << what;
        ASSERT_EQ(hit->distance, 0) << what;
        return;
    }
    if (!hit) {  // they never overlap on the path: the gap is convex, so ternary search finds its minimum
        double lo = 0, hi = std::min(double(c.length), 20.0);
        for (int i = 0; i < 100; ++i) {
            const double a = lo + (hi - lo) * 0.4, b = lo + (hi - lo) * 0.6;
            if (gap_at(a) < gap_at(b)) {
                hi = b;
            } else {
                lo = a;
            }
        }
        ASSERT_GT(gap_at(lo), -2e-6) << what;
        return;
    }
    ASSERT_LE(hit->distance, double(c.length)) << what;
    const double there = gap_at(hit->distance);
    ASSERT_LE(there, 12 * tolerance) << what;
    ASSERT_GE(there, -1e-9) << what;
    ASSERT_NEAR(length(to_double(hit->normal)), 1, 1e-6) << what;
    const Vec3d in_target =
        rotate_back(normalized(to_double(c.target_pose.rotation)), hit->point - c.target_pose.position);
    ASSERT_LT(std::abs(outside(c.target, in_target)), 2e-6) << what;
    // The plane through the point with this normal separates the two.
    const Pose end = moved_along(c.from, c.direction, hit->distance);
    const Vec3d down = rotate_back(normalized(to_double(end.rotation)), -to_double(hit->normal));
    if (!std::holds_alternative<HalfSpace>(c.mover)) {
        const Vec3d lowest = end.position + rotate(normalized(to_double(end.rotation)), support(c.mover, down));
        ASSERT_GT(dot(lowest - hit->point, to_double(hit->normal)), -3e-6) << what;
    }
    if (!std::holds_alternative<HalfSpace>(c.target)) {
        const Vec3d up = rotate_back(normalized(to_double(c.target_pose.rotation)), to_double(hit->normal));
        const Vec3d highest =
            c.target_pose.position + rotate(normalized(to_double(c.target_pose.rotation)), support(c.target, up));
        ASSERT_LT(dot(highest - hit->point, to_double(hit->normal)), 3e-6) << what;
    }
    double lo = 0, hi = hit->distance + 1e-3;
    if (gap_at(hi) > 0) return;  // a grazing cast
    for (int i = 0; i < 60; ++i) (gap_at((lo + hi) / 2) > 0 ? lo : hi) = (lo + hi) / 2;
    ASSERT_LE(hit->distance, lo + 1e-9) << what;
    const double across = std::abs(dot(to_double(hit->normal), to_double(c.direction)));
    ASSERT_GE(hit->distance, lo - 20 * tolerance / across - 1e-6) << what;
}

TEST(CastShape, OfAllKindsEqualsBisectionOnTheDistance) {
    Random random(2);
    int hits = 0, misses = 0;
    for (int i = 0; i < 6000; ++i) {
        const Case c = random_case(random, random.below(solid_or_ground_kinds), random.below(solid_or_ground_kinds));
        if (std::holds_alternative<HalfSpace>(c.mover) && std::holds_alternative<HalfSpace>(c.target)) continue;
        const auto hit = cast(c);
        ++(hit ? hits : misses);
        expect_correct(
            c, hit, std::to_string(i) + " " + std::string(name_of(c.mover)) + " on " + std::string(name_of(c.target)));
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(hits, 1500);
    EXPECT_GT(misses, 1500);
}

TEST(CastShape, OfNeedlesPlatesAndDustEqualsBisection) {
    Random random(3);
    for (int i = 0; i < 2000; ++i) {
        const Case c = random_case(random, random.below(bounded_kinds), random.below(bounded_kinds), 1000);
        expect_correct(
            c, cast(c),
            std::to_string(i) + " " + std::string(name_of(c.mover)) + " on " + std::string(name_of(c.target)));
        if (HasFatalFailure()) return;
    }
}

RC_GTEST_PROP(CastShape, IsTheSameSeenFromTheTarget, (std::uint64_t seed)) {
    Random random(seed);
    for (int i = 0; i < 20; ++i) {
        const Case c = random_case(random, random.below(solid_or_ground_kinds), random.below(solid_or_ground_kinds));
        const Case swapped{c.target, c.mover, c.target_pose, c.from, -c.direction, c.length};
        const auto hit = cast(c), back = cast(swapped);
        if (hit.has_value() != back.has_value()) {  // a grazing cast, or exactly at the end
            const auto& one = hit ? *hit : *back;
            const double across = std::abs(dot(one.normal, c.direction));
            RC_ASSERT(across < 1e-2 || std::abs(one.distance - double(c.length)) < 1e-5);
            continue;
        }
        if (!hit) continue;
        const double across = std::abs(dot(hit->normal, c.direction));
        RC_ASSERT(std::abs(hit->distance - back->distance) * across < 1e-5);
    }
}

TEST(CastShape, DoesNotTunnelThroughThinShapes) {
    Random random(4);
    const Shape foil = Box{{2, 1e-4f, 2}};
    for (int i = 0; i < 2000; ++i) {
        const Shape mover = random_shape(random, random.below(bounded_kinds), 1000);
        const Vec3d aim{random.between(-1.5f, 1.5f), 0, random.between(-1.5f, 1.5f)};
        const Vec3d from = aim + Vec3d{random.between(-5, 5), 2 + 1000 * random.unit(), random.between(-5, 5)};
        const Pose start{from, to_float(random_rotation(random))};
        const auto hit = cast_shape(mover, start, to_float(normalized(aim - from)), inf, foil, {});
        ASSERT_TRUE(hit) << i << " " << name_of(mover);
        ASSERT_LT(hit->distance, length(aim - from) + 1) << i;  // a hull need not contain its origin
        ASSERT_GE(gap(foil, {}, mover, moved_along(start, to_float(normalized(aim - from)), hit->distance)), -1e-9)
            << i;
    }
}

TEST(CastShape, ThatTouchesAtTheStartHitsAtDistanceZeroInAnyDirection) {
    const Shape box = Box{{1, 1, 1}};
    for (const Vec3 direction : {Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{1, 0, 0}})
        for (const double height : {2.0, 1.5}) {
            const auto hit = cast_shape(box, {{0, height, 0}, {}}, direction, 0, box, {});
            ASSERT_TRUE(hit);
            EXPECT_EQ(hit->distance, 0);
            EXPECT_EQ(hit->normal, (Vec3{0, 1, 0}));
            EXPECT_NEAR(hit->point.y, 1, 1e-9);
        }
    EXPECT_FALSE(cast_shape(box, {{0, 2.001, 0}, {}}, {0, 1, 0}, inf, box, {}));
    EXPECT_FALSE(cast_shape(box, {{0, 2.001, 0}, {}}, {1, 0, 0}, inf, box, {}));
    EXPECT_FALSE(cast_shape(box, {{0, 2.001, 0}, {}}, {0, -1, 0}, 0, box, {}));
}

TEST(CastShape, TerminatesForGrazingCasts) {
    for (const double off : {0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5}) {
        for (const Shape& shape : {Shape{Sphere{1}}, Shape{Box{{1, 1, 1}}}, Shape{Capsule{1, 0}}, Shape{Cylinder{1, 1}},
                                   Shape{box_hull({1, 1, 1})}}) {
            const Case low{shape, shape, {{-10, 2 - off, 0}, {}}, {}, {1, 0, 0}, inf};
            expect_correct(low, cast(low), std::string(name_of(shape)) + " low " + std::to_string(off * 1e9));
            const Case high{shape, shape, {{-10, 2 + off, 0}, {}}, {}, {1, 0, 0}, inf};
            expect_correct(high, cast(high), std::string(name_of(shape)) + " high " + std::to_string(off * 1e9));
            if (off >= 1e-5) {
                EXPECT_FALSE(cast(high)) << name_of(shape);
            }
        }
    }
}

TEST(CastShape, IsRightForHugeTinyAndFarAwayShapes) {
    const auto dust = cast_shape(Sphere{1e-4f}, {{9e4, 5, -9e4}, {}}, {0, -1, 0}, inf, Box{{1e5f, 1, 1e5f}}, {});
    ASSERT_TRUE(dust);
    EXPECT_NEAR(dust->distance, 4 - 1e-4, 1e-5);
    EXPECT_LE(dust->distance, 4 - double(1e-4f) + 1e-9);
    const Vec3d far{8388608, -4194304, 2097152};
    const auto there =
        cast_shape(Box{{1, 1, 1}}, {far + Vec3d{-10, 0.5, 0}, {}}, {1, 0, 0}, 20, Box{{1, 1, 1}}, {far, {}});
    ASSERT_TRUE(there);
    EXPECT_NEAR(there->distance, 8, 1e-8);
    const auto distant = cast_shape(Box{{1, 1, 1}}, {{-1e7, 0.5, 0}, {}}, {1, 0, 0}, inf, Box{{1, 1, 1}}, {});
    ASSERT_TRUE(distant);
    EXPECT_NEAR(distant->distance, 1e7 - 2, 1e-8);
}

}  // namespace
}  // namespace fase
