/// World bounds: never too small and tight; outer and inner radii.
#include "fase/geometry/bounds.hpp"

#include <gtest/gtest.h>

#include "fase/geometry/mass.hpp"
#include "fase/geometry/mesh.hpp"
#include "tests/geometry/random_shapes.hpp"

namespace fase {
namespace {

using Exact = long double;
using Vec3e = Vec3Of<Exact>;

Vec3e exact(Vec3 v) { return {v.x, v.y, v.z}; }
Vec3e exact(Vec3d v) { return {v.x, v.y, v.z}; }

/// The rotation of the pose: its quaternion normalised in long double.
QuatOf<Exact> exact_rotation(const Pose& pose) {
    const Quat q = pose.rotation;
    return normalized(QuatOf<Exact>{q.x, q.y, q.z, q.w});
}

/// The world box in long double, from the support function of the shape; independent of bounds().
struct ExactBox {
    Vec3e lo, hi;
};
template <ConvexShape S> ExactBox exact_box(const S& shape, const Pose& pose) {
    const QuatOf<Exact> rotation = exact_rotation(pose);
    ExactBox box;
    for (int axis = 0; axis < 3; ++axis) {
        for (const Exact sign : {Exact(-1), Exact(1)}) {
            Vec3e direction;
            direction[axis] = sign;
            const Vec3e local = rotate_back(rotation, direction);
            Exact reach = 0;
            if constexpr (std::is_same_v<S, ConvexHull>) {
                reach = -1e30L;
                for (const Vec3 v : shape.vertices) reach = std::max(reach, dot(local, exact(v)));
            } else {
                reach = dot(local, shape.core_support(local)) + Exact(shape.core_radius());
            }
            (sign < 0 ? box.lo : box.hi)[axis] = exact(pose.position)[axis] + sign * reach;
        }
    }
    return box;
}

bool contains_point(const Aabb& box, Vec3e p) {
    return Exact(box.lo.x) <= p.x && p.x <= Exact(box.hi.x) && Exact(box.lo.y) <= p.y && p.y <= Exact(box.hi.y) &&
           Exact(box.lo.z) <= p.z && p.z <= Exact(box.hi.z);
}

Pose random_pose(Random& random, float range) {
    Vec3d position{random.between(-range, range), random.between(-range, range), random.between(-range, range)};
    position += to_double(test::random_vector(random)) * 1e-3;
    return {position, random.below(8) == 0 ? Quat{} : test::random_rotation(random)};
}

/// A quaternion as after integration: some float roundings off unit length.
Quat slightly_off(Quat q, Random& random) {
    const float s = 1 + random.between(-6, 6) * 0x1p-23f;
    return {q.x * s, q.y * s, q.z * s, q.w * s};
}

constexpr float ranges[] = {0, 1, 100, 1e4f, 1e6f, 1e7f};

TEST(Bounds, contain_the_exact_box_of_every_bounded_shape_and_are_tight) {
    Random random(1);
    for_each_shape([&]<class S>() {
        if constexpr (ConvexShape<S>) {
            double worst = 0;
            for (const float range : ranges) {
                for (int round = 0; round < 2000; ++round) {
                    const S shape = test::random_shape<S>(random);
                    Pose pose = random_pose(random, range);
                    pose.rotation = slightly_off(pose.rotation, random);
                    const Aabb box = bounds(shape, pose);
                    const ExactBox truth = exact_box(shape, pose);
                    ASSERT_TRUE(contains_point(box, truth.lo)) << S::name << " at range " << range;
                    ASSERT_TRUE(contains_point(box, truth.hi)) << S::name << " at range " << range;
                    const Exact reach = length(truth.hi - truth.lo) / 2 + outer_radius(shape);
                    for (int axis = 0; axis < 3; ++axis) {
                        for (const auto& [found, expected] :
                             {std::pair{box.lo[axis], truth.lo[axis]}, {box.hi[axis], truth.hi[axis]}}) {
                            const Exact two_units = std::abs(Exact(found)) * 0x1p-22L;
                            const Exact excess = std::abs(found - expected) - two_units;
                            worst = std::max(worst, double(excess / reach));
                        }
                    }
                }
            }
            EXPECT_LT(worst, 1e-5) << S::name;
            RecordProperty("worst_excess_" + std::string(S::name), std::to_string(worst));
        }
    });
}

/// Where position and extent cancel, the final rounding to float does not hide earlier errors.
TEST(Bounds, contain_the_exact_box_also_when_a_side_of_it_is_at_zero) {
    Random random(6);
    for_each_shape([&]<class S>() {
        if constexpr (ConvexShape<S>) {
            for (int round = 0; round < 5000; ++round) {
                const S shape = test::random_shape<S>(random);
                Pose pose{{}, test::random_rotation(random)};
                const ExactBox centred = exact_box(shape, pose);
                const Vec3e& side = round % 2 == 0 ? centred.lo : centred.hi;
                pose.position = {-double(side.x), -double(side.y), -double(side.z)};
                const ExactBox truth = exact_box(shape, pose);
                const Aabb box = bounds(shape, pose);
                ASSERT_TRUE(contains_point(box, truth.lo)) << S::name;
                ASSERT_TRUE(contains_point(box, truth.hi)) << S::name;
            }
        }
    });
}

TEST(Bounds, contain_points_of_the_surface) {
    Random random(2);
    for (int round = 0; round < 300; ++round) {
        for (const Shape& shape : test::one_of_each(random)) {
            const Pose pose = random_pose(random, ranges[random.below(std::size(ranges))]);
            const QuatOf<Exact> rotation = exact_rotation(pose);
            const Aabb box = bounds(shape, pose);
            for (const Vec3 p : sample_points(shape, 12)) {
                if (!is_solid(shape)) continue;
                // Mesh vertices are rounded to float and may be outside by that error.
                const Vec3e inside = exact(p) * (1 - 0x1p-22L);
                ASSERT_TRUE(contains_point(box, exact(pose.position) + rotate(rotation, inside))) << name_of(shape);
            }
        }
    }
}

TEST(Bounds, of_a_rotated_box_are_its_half_sizes_times_the_absolute_matrix) {
    const Pose pose{{10, 20, 30}, rotation_about(Vec3{0, 0, 1}, 0.78539816f)};
    const Aabb box = bounds(Box{{1, 1, 1}}, pose);
    const float diagonal = std::sqrt(2.0f);
    EXPECT_NEAR(box.lo.x, 10 - diagonal, 2e-6f);
    EXPECT_NEAR(box.hi.x, 10 + diagonal, 2e-6f);
    EXPECT_NEAR(box.hi.y, 20 + diagonal, 4e-6f);
    EXPECT_NEAR(box.hi.z, 31, 4e-6f);
}

TEST(Bounds, of_an_unrotated_box_are_at_most_two_units_in_the_last_place_too_large) {
    Random random(3);
    for (int round = 0; round < 1000; ++round) {
        const Box shape = test::random_shape<Box>(random);
        const Aabb box = bounds(shape, {{}, {}});
        for (int axis = 0; axis < 3; ++axis) {
            const float half = shape.half[axis];
            // Next to a far larger side, the roundings of the matrix may be visible.
            const float slack = outer_radius(shape) * 0x1p-45f;
            const float two_up = std::nextafter(std::nextafter(half, 1e9f), 1e9f);
            ASSERT_GE(box.hi[axis], half);
            ASSERT_LE(box.hi[axis], two_up + slack);
            ASSERT_EQ(box.lo[axis], -box.hi[axis]);
        }
    }
}

TEST(Bounds, of_a_half_space_are_limited_only_by_an_axis_aligned_plane) {
    constexpr float inf = Aabb::infinity;
    const float quarter = 0.5f;  // squared components of a quaternion of 90°: exactly equal
    const float root = std::sqrt(quarter);
    const auto of = [](Quat q) { return bounds(HalfSpace{}, {{1, 2, 3}, q}); };
    EXPECT_EQ(of({}), (Aabb{{-inf, -inf, -inf}, {inf, 2, inf}}));
    EXPECT_EQ(of({1, 0, 0, 0}), (Aabb{{-inf, 2, -inf}, {inf, inf, inf}}));
    EXPECT_EQ(of({0, 1, 0, 0}), (Aabb{{-inf, -inf, -inf}, {inf, 2, inf}}));
    EXPECT_EQ(of({0, 0, -root, root}), (Aabb{{-inf, -inf, -inf}, {1, inf, inf}}));
    EXPECT_EQ(of({0, 0, root, root}), (Aabb{{1, -inf, -inf}, {inf, inf, inf}}));
    EXPECT_EQ(of({root, 0, 0, root}), (Aabb{{-inf, -inf, -inf}, {inf, inf, 3}}));
    EXPECT_EQ(of({-root, 0, 0, root}), (Aabb{{-inf, -inf, 3}, {inf, inf, inf}}));
    EXPECT_EQ(of(normalized(Quat{0.1f, 0.2f, 0.3f, 0.9f})), Aabb::everything());
    EXPECT_EQ(of(rotation_about(Vec3{1, 0, 0}, 1e-4f)), Aabb::everything());
}

TEST(Bounds, of_a_half_space_round_its_height_upward) {
    const double height = 0.1 + 1e7;
    const Aabb box = bounds(HalfSpace{}, {{0, height, 0}, {}});
    EXPECT_GE(double(box.hi.y), height);
    EXPECT_LE(double(box.hi.y), height + 1);
}

TEST(OuterRadius, is_the_distance_of_the_farthest_point) {
    EXPECT_EQ(outer_radius(Sphere{2}), 2);
    EXPECT_NEAR(outer_radius(Box{{1, 2, 2}}), 3, 1e-6);
    EXPECT_NEAR(outer_radius(Capsule{0.25f, 1}), 1.25, 1e-6);
    EXPECT_NEAR(outer_radius(Cylinder{3, 4}), 5, 1e-6);
    EXPECT_EQ(outer_radius(HalfSpace{}), Aabb::infinity);
    Random random(4);
    for (int round = 0; round < 200; ++round) {
        for (const Shape& shape : test::one_of_each(random)) {
            if (!is_solid(shape)) continue;
            const float radius = outer_radius(shape);
            float farthest = 0;
            for (const Vec3 p : sample_points(shape, 16)) farthest = std::max(farthest, length(p));
            ASSERT_LE(farthest, radius * (1 + 1e-6f)) << name_of(shape);
            ASSERT_GE(farthest, radius * (1 - 1e-6f)) << name_of(shape);
        }
    }
}

TEST(InnerRadius, sphere_around_the_centre_is_inside) {
    EXPECT_EQ(inner_radius(Sphere{2}), 2);
    EXPECT_EQ(inner_radius(Box{{3, 1, 2}}), 1);
    EXPECT_EQ(inner_radius(Capsule{0.25f, 1}), 0.25f);
    EXPECT_EQ(inner_radius(Cylinder{3, 4}), 3);
    EXPECT_EQ(inner_radius(Cylinder{4, 3}), 3);
    EXPECT_EQ(inner_radius(HalfSpace{}), 0);
    Random random(5);
    for (int round = 0; round < 200; ++round) {
        for (const Shape& shape : test::one_of_each(random)) {
            if (!is_solid(shape)) continue;
            const float radius = inner_radius(shape);
            ASSERT_GT(radius, 0) << name_of(shape);
            const Vec3 centre = mass_properties(shape, 1).centre;
            for (int i = 0; i < 50; ++i) {
                const Vec3 p = centre + normalized(test::random_vector(random)) * radius;
                ASSERT_TRUE(test::is_inside(shape, p, 4e-6f * (length(centre) + outer_radius(shape))))
                    << name_of(shape);
            }
        }
    }
}

}  // namespace
}  // namespace fase
