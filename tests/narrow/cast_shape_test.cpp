/// Moved shapes against shapes: closed forms, bisection on the distance, swaps, thin targets, grazes.
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
double gap(const Shape& target, const Pose& at, const Shape& mover, const Pose& there) {
    return narrow::signed_distance(target, mover, exactly_relative(at, there)).distance;
}

/// A case that often meets: two shapes some metres apart and a direction roughly from one to the other.
struct Case {
    Shape mover, target;
    Pose from, at;
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
    const Vec3d aim = c.at.position + to_double(random_in_cube(random)) * 1.5 - c.from.position;
    c.direction = to_float(normalized(aim));
    c.length = random.below(2) == 0 ? inf : random.between(0, 10);
    return c;
}
std::optional<ShapeOnShape> cast(const Case& c) {
    return cast_shape(c.mover, c.from, c.direction, c.length, c.target, c.at);
}

TEST(CastShape, OfSpheresEqualsTheFormula) {
    Random random(1);
    int hits = 0;
    for (int i = 0; i < 20000; ++i) {
        const Case c = random_case(random, 0, 0);
        const double sum = double(std::get<Sphere>(c.mover).radius) + double(std::get<Sphere>(c.target).radius);
        const Vec3d from = c.from.position - c.at.position, way = to_double(c.direction);
        const double middle = -dot(from, way) / length_squared(way);
        const double room = sum * sum - length_squared(from + way * middle);
        const auto hit = cast(c);
        if (std::abs(room) < 1e-6) continue;  // a graze: a matter of rounding
        const double at = length(from) <= sum ? 0 : middle - std::sqrt(room / length_squared(way));
        if (!(room > 0) || middle < 0 || at > double(c.length)) {
            ASSERT_EQ(hit.has_value(), length(from) <= sum) << i;
            continue;
        }
        ++hits;
        ASSERT_TRUE(hit) << i;
        if (at == 0) {
            ASSERT_EQ(hit->at, 0) << i;
            continue;
        }
        ASSERT_LE(hit->at, at + 1e-9) << i;
        ASSERT_GE(hit->at, at - 1e-6 / std::abs(dot(to_double(hit->normal), way))) << i;
        ASSERT_LT(length(to_double(hit->normal) - normalized(from + way * at)), 1e-5) << i;
        const Vec3d point = c.at.position + to_double(hit->normal) * double(std::get<Sphere>(c.target).radius);
        ASSERT_LT(length(hit->point - point), 1e-5) << i;
    }
    EXPECT_GT(hits, 3000);
}

TEST(CastShape, OfASphereOnGroundEqualsTheFormula) {
    const auto straight = cast_shape(Sphere{0.5f}, {{3, 10, 4}, {}}, {0, -1, 0}, inf, HalfSpace{}, {});
    ASSERT_TRUE(straight);
    EXPECT_NEAR(straight->at, 9.5, 1e-9);
    EXPECT_EQ(straight->normal, (Vec3{0, 1, 0}));
    EXPECT_LT(length(straight->point - Vec3d{3, 0, 4}), 1e-9);
    const auto slanted = cast_shape(Sphere{0.5f}, {{0, 10, 0}, {}}, {0.8f, -0.6f, 0}, inf, HalfSpace{}, {});
    ASSERT_TRUE(slanted);
    EXPECT_NEAR(slanted->at, 9.5 / double(0.6f), 1e-6);
    EXPECT_FALSE(cast_shape(Sphere{0.5f}, {{0, 10, 0}, {}}, {0.8f, -0.6f, 0}, 15, HalfSpace{}, {}));
    EXPECT_FALSE(cast_shape(Sphere{0.5f}, {{0, 10, 0}, {}}, {1, 0, 0}, inf, HalfSpace{}, {}));
    EXPECT_FALSE(cast_shape(Sphere{0.5f}, {{0, 10, 0}, {}}, {0, 1, 0}, inf, HalfSpace{}, {}));
    // The ground may be moved as well.
    const auto rising = cast_shape(HalfSpace{}, {}, {0, 1, 0}, inf, Sphere{0.5f}, {{3, 10, 4}, {}});
    ASSERT_TRUE(rising);
    EXPECT_NEAR(rising->at, 9.5, 1e-9);
    EXPECT_EQ(rising->normal, (Vec3{0, -1, 0}));
}

TEST(CastShape, OfBoxesAlongTheirAxesEqualsTheGap) {
    const Shape box = Box{{1, 1, 1}};
    const auto face = cast_shape(box, {{-10, 0.5, 0.25}, {}}, {1, 0, 0}, inf, box, {});
    ASSERT_TRUE(face);
    EXPECT_NEAR(face->at, 8, 1e-12);
    EXPECT_EQ(face->normal, (Vec3{-1, 0, 0}));
    EXPECT_NEAR(face->point.x, -1, 1e-12);
    EXPECT_TRUE(cast_shape(box, {{-10, 0, 0}, {}}, {1, 0, 0}, 8, box, {}));
    EXPECT_FALSE(cast_shape(box, {{-10, 0, 0}, {}}, {1, 0, 0}, 7.99f, box, {}));
    EXPECT_FALSE(cast_shape(box, {{-10, 2.0001, 0}, {}}, {1, 0, 0}, inf, box, {}));
    EXPECT_TRUE(cast_shape(box, {{-10, 1.9999, 0}, {}}, {1, 0, 0}, inf, box, {}));
    // Corner on corner's path, edge on edge.
    const float third = 0.57735027f;
    const auto corner = cast_shape(box, {{-5, -5, -5}, {}}, {third, third, third}, inf, box, {});
    ASSERT_TRUE(corner);
    EXPECT_NEAR(corner->at, 3 / double(third), 1e-6);
}

/// All that must hold of an answer; bisection finds the touch on its own.
void expect_right(const Case& c, const std::optional<ShapeOnShape>& hit, const std::string& what) {
    const double tolerance = advance_tolerance(c.target, c.mover);
    const double start = gap(c.target, c.at, c.mover, c.from);
    const auto gap_at = [&](double at) { return gap(c.target, c.at, c.mover, moved_along(c.from, c.direction, at)); };
    if (start <= 0) {
        ASSERT_TRUE(hit) << what;
        ASSERT_EQ(hit->at, 0) << what;
        return;
    }
    if (!hit) {  // nowhere on the way do they overlap: the gap is convex, so its least is found by thirds
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
    ASSERT_LE(hit->at, double(c.length)) << what;
    const double there = gap_at(hit->at);
    ASSERT_LE(there, 12 * tolerance) << what;
    ASSERT_GE(there, -1e-9) << what;
    ASSERT_NEAR(length(to_double(hit->normal)), 1, 1e-6) << what;
    const Vec3d in_target = rotate_back(normalized(to_double(c.at.rotation)), hit->point - c.at.position);
    ASSERT_LT(std::abs(outside(c.target, in_target)), 2e-6) << what;
    // A plane through the point with that normal parts the two.
    const Pose end = moved_along(c.from, c.direction, hit->at);
    const Vec3d down = rotate_back(normalized(to_double(end.rotation)), -to_double(hit->normal));
    if (!std::holds_alternative<HalfSpace>(c.mover)) {
        const Vec3d lowest = end.position + rotate(normalized(to_double(end.rotation)), support(c.mover, down));
        ASSERT_GT(dot(lowest - hit->point, to_double(hit->normal)), -3e-6) << what;
    }
    if (!std::holds_alternative<HalfSpace>(c.target)) {
        const Vec3d up = rotate_back(normalized(to_double(c.at.rotation)), to_double(hit->normal));
        const Vec3d highest = c.at.position + rotate(normalized(to_double(c.at.rotation)), support(c.target, up));
        ASSERT_LT(dot(highest - hit->point, to_double(hit->normal)), 3e-6) << what;
    }
    double lo = 0, hi = hit->at + 1e-3;
    if (gap_at(hi) > 0) return;  // a graze
    for (int i = 0; i < 60; ++i) (gap_at((lo + hi) / 2) > 0 ? lo : hi) = (lo + hi) / 2;
    ASSERT_LE(hit->at, lo + 1e-9) << what;
    const double across = std::abs(dot(to_double(hit->normal), to_double(c.direction)));
    ASSERT_GE(hit->at, lo - 20 * tolerance / across - 1e-6) << what;
}

TEST(CastShape, OfAllKindsEqualsBisectionOnTheDistance) {
    Random random(2);
    int hits = 0, misses = 0;
    for (int i = 0; i < 6000; ++i) {
        const Case c = random_case(random, random.below(AllShapes::count), random.below(AllShapes::count));
        if (std::holds_alternative<HalfSpace>(c.mover) && std::holds_alternative<HalfSpace>(c.target)) continue;
        const auto hit = cast(c);
        ++(hit ? hits : misses);
        expect_right(c, hit,
                     std::to_string(i) + " " + std::string(name_of(c.mover)) + " on " + std::string(name_of(c.target)));
        if (HasFatalFailure()) return;
    }
    EXPECT_GT(hits, 1500);
    EXPECT_GT(misses, 1500);
}

TEST(CastShape, OfNeedlesPlatesAndDustEqualsBisection) {
    Random random(3);
    for (int i = 0; i < 2000; ++i) {
        const Case c = random_case(random, random.below(bounded_kinds), random.below(bounded_kinds), 1000);
        expect_right(c, cast(c),
                     std::to_string(i) + " " + std::string(name_of(c.mover)) + " on " + std::string(name_of(c.target)));
        if (HasFatalFailure()) return;
    }
}

RC_GTEST_PROP(CastShape, IsTheSameSeenFromTheTarget, (std::uint64_t seed)) {
    Random random(seed);
    for (int i = 0; i < 20; ++i) {
        const Case c = random_case(random, random.below(AllShapes::count), random.below(AllShapes::count));
        const Case swapped{c.target, c.mover, c.at, c.from, -c.direction, c.length};
        const auto hit = cast(c), back = cast(swapped);
        if (hit.has_value() != back.has_value()) {  // a graze, or right at the end
            const auto& one = hit ? *hit : *back;
            const double across = std::abs(dot(one.normal, c.direction));
            RC_ASSERT(across < 1e-2 || std::abs(one.at - double(c.length)) < 1e-5);
            continue;
        }
        if (!hit) continue;
        const double across = std::abs(dot(hit->normal, c.direction));
        RC_ASSERT(std::abs(hit->at - back->at) * across < 1e-5);
    }
}

TEST(CastShape, PassesThroughNothingHoweverThin) {
    Random random(4);
    const Shape foil = Box{{2, 1e-4f, 2}};
    for (int i = 0; i < 2000; ++i) {
        const Shape mover = random_shape(random, random.below(bounded_kinds), 1000);
        const Vec3d aim{random.between(-1.5f, 1.5f), 0, random.between(-1.5f, 1.5f)};
        const Vec3d from = aim + Vec3d{random.between(-5, 5), 2 + 1000 * random.unit(), random.between(-5, 5)};
        const Pose start{from, to_float(random_rotation(random))};
        const auto hit = cast_shape(mover, start, to_float(normalized(aim - from)), inf, foil, {});
        ASSERT_TRUE(hit) << i << " " << name_of(mover);
        ASSERT_LT(hit->at, length(aim - from) + 1) << i;  // a hull need not hold its origin
        ASSERT_GE(gap(foil, {}, mover, moved_along(start, to_float(normalized(aim - from)), hit->at)), -1e-9) << i;
    }
}

TEST(CastShape, ThatTouchesFromTheStartMeetsAtOnceWhicheverWayItGoes) {
    const Shape box = Box{{1, 1, 1}};
    for (const Vec3 direction : {Vec3{0, 1, 0}, Vec3{0, -1, 0}, Vec3{1, 0, 0}})
        for (const double height : {2.0, 1.5}) {
            const auto hit = cast_shape(box, {{0, height, 0}, {}}, direction, 0, box, {});
            ASSERT_TRUE(hit);
            EXPECT_EQ(hit->at, 0);
            EXPECT_EQ(hit->normal, (Vec3{0, 1, 0}));
            EXPECT_NEAR(hit->point.y, 1, 1e-9);
        }
    EXPECT_FALSE(cast_shape(box, {{0, 2.001, 0}, {}}, {0, 1, 0}, inf, box, {}));
    EXPECT_FALSE(cast_shape(box, {{0, 2.001, 0}, {}}, {1, 0, 0}, inf, box, {}));
    EXPECT_FALSE(cast_shape(box, {{0, 2.001, 0}, {}}, {0, -1, 0}, 0, box, {}));
}

TEST(CastShape, EndsWhereItSlidesPast) {
    for (const double off : {0.0, 1e-15, 1e-12, 1e-9, 1e-7, 1e-6, 1e-5}) {
        for (const Shape& shape : {Shape{Sphere{1}}, Shape{Box{{1, 1, 1}}}, Shape{Capsule{1, 0}}, Shape{Cylinder{1, 1}},
                                   Shape{box_hull({1, 1, 1})}}) {
            const Case low{shape, shape, {{-10, 2 - off, 0}, {}}, {}, {1, 0, 0}, inf};
            expect_right(low, cast(low), std::string(name_of(shape)) + " low " + std::to_string(off * 1e9));
            const Case high{shape, shape, {{-10, 2 + off, 0}, {}}, {}, {1, 0, 0}, inf};
            expect_right(high, cast(high), std::string(name_of(shape)) + " high " + std::to_string(off * 1e9));
            if (off >= 1e-5) {
                EXPECT_FALSE(cast(high)) << name_of(shape);
            }
        }
    }
}

TEST(CastShape, IsRightForHugeTinyAndFarAwayShapes) {
    const auto dust = cast_shape(Sphere{1e-4f}, {{9e4, 5, -9e4}, {}}, {0, -1, 0}, inf, Box{{1e5f, 1, 1e5f}}, {});
    ASSERT_TRUE(dust);
    EXPECT_NEAR(dust->at, 4 - 1e-4, 1e-5);
    EXPECT_LE(dust->at, 4 - double(1e-4f) + 1e-9);
    const Vec3d far{8388608, -4194304, 2097152};
    const auto there =
        cast_shape(Box{{1, 1, 1}}, {far + Vec3d{-10, 0.5, 0}, {}}, {1, 0, 0}, 20, Box{{1, 1, 1}}, {far, {}});
    ASSERT_TRUE(there);
    EXPECT_NEAR(there->at, 8, 1e-8);
    const auto distant = cast_shape(Box{{1, 1, 1}}, {{-1e7, 0.5, 0}, {}}, {1, 0, 0}, inf, Box{{1, 1, 1}}, {});
    ASSERT_TRUE(distant);
    EXPECT_NEAR(distant->at, 1e7 - 2, 1e-8);
}

}  // namespace
}  // namespace fase
