/// Rays against shapes: proofs from the hit point and normal, comparison with the general path, exact simple cases, and
/// precision far from the origin.
#include "fase/narrow/cast_ray.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <string>

#include "fase/narrow/distance.hpp"
#include "tests/math/arbitrary.hpp"
#include "tests/narrow/random_shapes.hpp"

namespace fase {
namespace {

using narrow::cast_ray;
using narrow::cast_ray_general;
using narrow::RayOnShape;
using namespace test;

constexpr float inf = std::numeric_limits<float>::infinity();

Pose random_pose(Random& random, double reach) {
    return {to_double(random_in_cube(random)) * reach, to_float(random_rotation(random))};
}

/// A ray from outside or inside that often hits a shape of size `size` at `pose`.
Ray random_ray(Random& random, const Pose& pose, double size) {
    Ray ray;
    ray.origin = pose.position + to_double(random_in_cube(random)) * (3 * size);
    const Vec3d towards = pose.position + to_double(random_in_cube(random)) * size - ray.origin;
    ray.direction = to_float(length(towards) > 0 ? normalized(towards) : Vec3d{1, 0, 0});
    const auto kind = random.below(3);
    ray.length = kind == 0 ? inf : static_cast<float>(size) * random.between(0, kind == 1 ? 1 : 5);
    return ray;
}

Vec3d in_frame(const Pose& pose, Vec3d point) {
    return rotate_back(normalized(to_double(pose.rotation)), point - pose.position);
}

/// The point of the ray nearest to the shape: its distance along the ray and from the shape. The distance from a convex
/// shape is a convex function along the ray.
struct Nearest {
    double distance = 0, outside = 0;
};
Nearest nearest_on(const Ray& ray, const Shape& shape, const Pose& pose, double max_distance) {
    const auto out = [&](double distance) { return outside(shape, in_frame(pose, point_at(ray, distance))); };
    double lo = 0, hi = std::min(double(ray.length), max_distance);
    for (int i = 0; i < 200; ++i) {
        const double a = lo + (hi - lo) * 0.45, b = lo + (hi - lo) * 0.55;
        (out(a) <= out(b) ? hi : lo) = out(a) <= out(b) ? b : a;
    }
    Nearest best{lo, out(lo)};
    for (const double distance : {0.0, std::min(double(ray.length), max_distance)})
        if (out(distance) < best.outside) best = {distance, out(distance)};
    return best;
}

/// Checks a result against the definition of the shape; returns the fault, or an empty string.
std::string wrong_with(const std::optional<RayOnShape>& hit, const Ray& ray, const Shape& shape, const Pose& pose,
                       double size, double tolerance) {
    const double past = length(ray.origin - pose.position) + 4 * size;
    const Nearest nearest = nearest_on(ray, shape, pose, std::max(past, hit ? hit->distance : 0));
    if (!hit) return nearest.outside < -tolerance ? "missed a shape that it passes through" : "";
    if (nearest.outside > tolerance) return "hit a shape that it does not meet";
    if (!(hit->distance >= 0 && hit->distance <= double(ray.length))) return "beyond the ray";
    if (!(std::abs(length(hit->normal) - 1) < 1e-6f)) return "normal not unit";
    if (!(dot(hit->normal, ray.direction) < 1e-6f)) return "normal faces away";
    const Vec3d point = in_frame(pose, point_at(ray, hit->distance));
    const double out = outside(shape, point);
    if (hit->distance == 0) {
        if (out > tolerance) return "distance 0 but outside";
        return out < -tolerance && !(hit->normal == -ray.direction) ? "inside with a surface normal" : "";
    }
    if (!(std::abs(out) <= tolerance)) return "off the surface by " + std::to_string(out * 1e9) + " nm";
    // A move along the normal leads out of the shape.
    const Vec3d normal = rotate_back(normalized(to_double(pose.rotation)), to_double(hit->normal));
    if (!(outside(shape, point + normal * (1e-3 * size)) > 0.99e-3 * size - tolerance)) return "normal not outward";
    return "";
}

double size_of(const Shape& shape) { return std::holds_alternative<HalfSpace>(shape) ? 1 : 2; }
double tolerance_of(const Shape& shape) { return std::holds_alternative<ConvexHull>(shape) ? 1e-6 : 1e-12; }

RC_GTEST_PROP(CastRay, IsProvedByItsPointAndNormalForAllKinds, (std::uint64_t seed)) {
    Random random(seed);
    for (int i = 0; i < 100; ++i) {
        const Shape shape = random_shape(random, random.below(solid_or_ground_kinds));
        const Pose pose = random_pose(random, 5);
        const Ray ray = random_ray(random, pose, 1);
        const double size = size_of(shape);
        RC_ASSERT(wrong_with(cast_ray(shape, pose, ray), ray, shape, pose, size, 1e-6) == "");
        RC_ASSERT(wrong_with(cast_ray_general(shape, pose, ray), ray, shape, pose, size, 3e-6) == "");
    }
}

TEST(CastRay, SpecialFunctionsEqualTheGeneralPath) {
    Random random(3);
    int hits = 0, misses = 0, inside = 0;
    for (int i = 0; i < 60000; ++i) {
        const Shape shape = random_shape(random, random.below(solid_or_ground_kinds), i % 3 == 0 ? 100.0f : 4.0f);
        const Pose pose = random_pose(random, 10);
        const Ray ray = random_ray(random, pose, 1);
        const auto hit = cast_ray(shape, pose, ray), reference = cast_ray_general(shape, pose, ray);
        const bool is_hull = std::holds_alternative<ConvexHull>(shape);
        if (hit.has_value() != reference.has_value()) {  // allowed within rounding only
            const Nearest nearest = nearest_on(ray, shape, pose, 40);
            ASSERT_LT(std::abs(nearest.outside), is_hull ? 1e-6 : 1e-7) << i << " " << name_of(shape);
            continue;
        }
        if (!hit) {
            ++misses;
            continue;
        }
        ++(hit->distance == 0 ? inside : hits);
        const double across = std::abs(dot(to_double(reference->normal), to_double(ray.direction)));
        ASSERT_LT(std::abs(hit->distance - reference->distance) * across, is_hull ? 3e-6 : 3e-7)
            << i << " " << name_of(shape);
        ASSERT_LT(std::abs(hit->distance - reference->distance), is_hull ? 3e-6 / across : 1e-8 / (across * across))
            << name_of(shape);
    }
    EXPECT_GT(hits, 5000);
    EXPECT_GT(misses, 10000);
    EXPECT_GT(inside, 1000);
}

TEST(CastRay, FindsNeedlesPlatesAndDust) {
    Random random(4);
    for (int i = 0; i < 20000; ++i) {
        const Shape shape = random_shape(random, random.below(bounded_kinds), 10000);
        const Pose pose = random_pose(random, 1);
        Ray ray = random_ray(random, pose, 1);
        if (i % 2 == 0) ray.direction = to_float(normalized(pose.position - ray.origin));
        const std::string wrong =
            wrong_with(cast_ray(shape, pose, ray), ray, shape, pose, 1, tolerance_of(shape) == 1e-6 ? 3e-5 : 1e-12);
        ASSERT_EQ(wrong, "") << i << " " << name_of(shape);
    }
}

TEST(CastRay, HitsShapesThatItOnlyTouches) {
    const Pose here;
    const Ray along_edge{{-5, 1, 1}, {1, 0, 0}};
    const auto edge = cast_ray(Box{{1, 1, 1}}, here, along_edge);
    ASSERT_TRUE(edge);
    EXPECT_EQ(edge->distance, 4);
    const auto side = cast_ray(Sphere{1}, here, {{-5, 1, 0}, {1, 0, 0}});
    ASSERT_TRUE(side);
    EXPECT_EQ(side->distance, 5);
    EXPECT_EQ(side->normal, (Vec3{0, 1, 0}));
    EXPECT_TRUE(cast_ray(Capsule{1, 2}, here, {{1, -9, 0}, {0, 1, 0}}));
    EXPECT_TRUE(cast_ray(Cylinder{1, 2}, here, {{1, -9, 0}, {0, 1, 0}}));
    EXPECT_TRUE(cast_ray(Cylinder{1, 2}, here, {{-5, 2, 0}, {1, 0, 0}}));
    EXPECT_TRUE(cast_ray(box_hull({1, 1, 1}), here, along_edge));
    EXPECT_TRUE(cast_ray(HalfSpace{}, here, {{0, 0, 0}, {1, 0, 0}}));
    EXPECT_FALSE(cast_ray(HalfSpace{}, here, {{0, 1e-9, 0}, {1, 0, 0}}));
    EXPECT_FALSE(cast_ray(Box{{1, 1, 1}}, here, {{-5, 1.000001, 1}, {1, 0, 0}}));
    EXPECT_FALSE(cast_ray(Sphere{1}, here, {{-5, 1.0000001, 0}, {1, 0, 0}}));
    // Exactly to the surface, and slightly less.
    EXPECT_TRUE(cast_ray(Sphere{1}, here, {{-5, 0, 0}, {1, 0, 0}, 4}));
    EXPECT_FALSE(cast_ray(Sphere{1}, here, {{-5, 0, 0}, {1, 0, 0}, 3.99999f}));
    EXPECT_TRUE(cast_ray(Box{{1, 1, 1}}, here, {{-5, 0, 0}, {1, 0, 0}, 4}));
    EXPECT_FALSE(cast_ray(Box{{1, 1, 1}}, here, {{-5, 0, 0}, {1, 0, 0}, 3.99999f}));
}

TEST(CastRay, FromInsideOrFromTheSurfaceHitsAtDistanceZero) {
    Random random(5);
    for (std::size_t kind = 0; kind < solid_or_ground_kinds; ++kind)
        for (int i = 0; i < 200; ++i) {
            const Shape shape = random_shape(random, kind);
            const Pose pose = random_pose(random, 3);
            const Vec3d deep = kind == bounded_kinds ? Vec3d{random.between(-9, 9), -random.unit() - 0.01, 0} : Vec3d{};
            if (outside(shape, deep) > -1e-6) continue;  // a hull need not contain its origin
            Ray ray{pose.position + rotate(normalized(to_double(pose.rotation)), deep),
                    to_float(random_direction(random)), i % 2 == 0 ? 0.0f : inf};
            for (const auto& hit : {cast_ray(shape, pose, ray), cast_ray_general(shape, pose, ray)}) {
                ASSERT_TRUE(hit) << name_of(shape);
                EXPECT_EQ(hit->distance, 0);
                EXPECT_EQ(hit->normal, -ray.direction);
            }
        }
    const Ray on_top{{0, 1, 0}, {0, 1, 0}};
    for (const Shape& shape :
         {Shape{Sphere{1}}, Shape{Box{{1, 1, 1}}}, Shape{Capsule{0.5f, 0.5f}}, Shape{Cylinder{1, 1}}}) {
        const auto hit = cast_ray(shape, {}, on_top);
        ASSERT_TRUE(hit) << name_of(shape);
        EXPECT_EQ(hit->distance, 0) << name_of(shape);
    }
}

TEST(CastRay, OfLengthZeroTestsOnePoint) {
    EXPECT_TRUE(cast_ray(Cylinder{1, 1}, {}, {{0.9, 0.9, 0}, {0, 0, -1}, 0}));
    EXPECT_FALSE(cast_ray(Cylinder{1, 1}, {}, {{0.9, 0.9, 0.9}, {0, 0, -1}, 0}));
    EXPECT_FALSE(cast_ray(Capsule{1, 1}, {}, {{0.9, 1.9, 0}, {0, 0, -1}, 0}));
    EXPECT_FALSE(cast_ray_general(Capsule{1, 1}, {}, {{0.9, 1.9, 0}, {0, 0, -1}, 0}));
}

TEST(CastRay, IsExactFarFromTheOriginAndFromFarAway) {
    Random random(6);
    for (int i = 0; i < 2000; ++i) {
        const Shape shape = random_shape(random, random.below(bounded_kinds));
        const Pose here = random_pose(random, 1);
        Ray ray = random_ray(random, here, 1);
        ray.length = inf;
        const Vec3d offset{8388608, -4194304, 2097152};  // sums with it have an error of a nanometre
        const Pose there{here.position + offset, here.rotation};
        const Ray shifted{ray.origin + offset, ray.direction, ray.length};
        const auto near = cast_ray(shape, here, ray), far = cast_ray(shape, there, shifted);
        if (near.has_value() != far.has_value()) {
            ASSERT_LT(std::abs(nearest_on(ray, shape, here, 20).outside), 1e-8);
        } else if (near) {
            const double across = std::abs(dot(near->normal, ray.direction));
            ASSERT_NEAR(near->distance * across, far->distance * across, 1e-8) << name_of(shape);
        }
        // Aimed through the middle from 1000 km away.
        Ray distant{here.position - to_double(ray.direction) * 1e6, ray.direction};
        if (outside(shape, {}) < -1e-3) {
            const auto hit = cast_ray(shape, here, distant);
            ASSERT_TRUE(hit) << name_of(shape);
            const double out = outside(shape, in_frame(here, point_at(distant, hit->distance)));
            ASSERT_LT(std::abs(out), std::holds_alternative<ConvexHull>(shape) ? 1e-6 : 1e-9) << name_of(shape);
        }
    }
}

TEST(CastRay, IsExactForTinyAndHugeShapesFromFarAway) {
    const auto hit = cast_ray(Sphere{1e-4f}, {{0, 1e-4, 0}, {}}, {{0, 1e5, 0}, {0, -1, 0}});
    ASSERT_TRUE(hit);
    EXPECT_NEAR(hit->distance, 1e5 - 2e-4, 1e-9);
    const auto ground = cast_ray(HalfSpace{}, {}, {{0, 1e5, 0}, {0, -1, 0}});
    ASSERT_TRUE(ground);
    EXPECT_EQ(ground->distance, 1e5);
    const auto huge = cast_ray(Box{{1e5f, 1, 1e5f}}, {}, {{9e4, 2, -9e4}, {0, -1, 0}});
    ASSERT_TRUE(huge);
    EXPECT_EQ(huge->distance, 1);
}

TEST(CastRay, TheGeneralPathTerminatesForRaysAlongASide) {
    for (const double off : {0.0, 1e-16, -1e-16, 1e-12, -1e-12, 1e-9, -1e-9, 1e-6}) {
        const Ray ray{{-5, 1 + off, 0}, {1, 0, 0}};
        for (const Shape& shape : {Shape{Sphere{1}}, Shape{Box{{1, 1, 1}}}, Shape{Capsule{1, 0}}, Shape{Cylinder{1, 1}},
                                   Shape{box_hull({1, 1, 1})}}) {
            const auto hit = cast_ray_general(shape, {}, ray);
            if (off >= 1e-6) {
                EXPECT_FALSE(hit) << name_of(shape);
            }
            if (off <= -1e-9) {
                ASSERT_TRUE(hit) << name_of(shape) << off;
                EXPECT_LT(outside(shape, point_at(ray, hit->distance)), 3e-7) << name_of(shape) << off;
            }
        }
    }
}

}  // namespace
}  // namespace fase
