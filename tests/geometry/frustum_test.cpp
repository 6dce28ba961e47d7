/// Frusta from camera matrices, compared with points transformed by the same matrix.
#include "fase/geometry/frustum.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "tests/geometry/random_shapes.hpp"

namespace fase {
namespace {

using Matrix = std::array<float, 16>;  // column-major

Matrix product(const Matrix& a, const Matrix& b) {
    Matrix c{};
    for (std::size_t column = 0; column < 4; ++column) {
        for (std::size_t row = 0; row < 4; ++row) {
            for (std::size_t k = 0; k < 4; ++k) c[4 * column + row] += a[4 * k + row] * b[4 * column + k];
        }
    }
    return c;
}

/// Looks along -z; OpenGL depth range. far 0: at infinity.
Matrix perspective(float focal, float aspect, float near, float far) {
    Matrix m{};
    m[0] = focal / aspect;
    m[5] = focal;
    m[10] = far > 0 ? (far + near) / (near - far) : -1;
    m[11] = -1;
    m[14] = far > 0 ? 2 * far * near / (near - far) : -2 * near;
    return m;
}
/// With depth from 1 (near) to 0 (far), far at infinity.
Matrix reversed_perspective(float focal, float near) {
    Matrix m{};
    m[0] = m[5] = focal;
    m[11] = -1;
    m[14] = near;
    return m;
}
Matrix view_from(Vec3 eye, Quat turn) {
    const Mat3 back = transpose(to_matrix(turn));
    const Vec3 t = -(back * eye);
    return {back.x.x, back.x.y, back.x.z, 0, back.y.x, back.y.y, back.y.z, 0,
            back.z.x, back.z.y, back.z.z, 0, t.x,      t.y,      t.z,      1};
}

std::array<double, 4> clip(const Matrix& m, Vec3 p) {
    std::array<double, 4> c{};
    for (std::size_t row = 0; row < 4; ++row) {
        c[row] = double(m[row]) * p.x + double(m[4 + row]) * p.y + double(m[8 + row]) * p.z + m[12 + row];
    }
    return c;
}
/// The depth of a point inside clip space; below 0 outside.
double depth_inside(const Matrix& m, Vec3 p, ClipDepth depth) {
    const auto [x, y, z, w] = clip(m, p);
    const double front = depth == ClipDepth::ZeroToOne ? z : w + z;
    return std::min({w + x, w - x, w + y, w - y, front, w - z});
}

TEST(Frustum, contains_the_points_inside_clip_space) {
    Random random(1);
    int inside = 0;
    for (int round = 0; round < 200; ++round) {
        const Matrix view = view_from(test::random_vector(random, 5), test::random_rotation(random));
        const bool reversed = round % 3 == 2;
        const ClipDepth depth = reversed ? ClipDepth::ZeroToOne : ClipDepth::MinusOneToOne;
        const Matrix camera = product(
            reversed ? reversed_perspective(1.5f, 0.1f) : perspective(1.2f, 1.6f, 0.5f, round % 3 == 1 ? 0.f : 20.f),
            view);
        const Result<Frustum> frustum = frustum_of(camera, depth);
        ASSERT_TRUE(frustum) << frustum.error().text();
        const Aabb around = bounds(*frustum);
        for (int i = 0; i < 500; ++i) {
            const Vec3 p = test::random_vector(random, 15);
            const double expected = depth_inside(camera, p, depth);
            if (std::abs(expected) < 1e-4) continue;
            ASSERT_EQ(contains(*frustum, Aabb{p, p}), expected > 0);
            ASSERT_EQ(overlaps(*frustum, Aabb{p, p}), expected > 0);
            if (expected < 0) continue;
            ++inside;
            ASSERT_TRUE(contains(around, p));
            const Vec3 m{1, 2, 3};
            ASSERT_TRUE(overlaps(*frustum, {p - m, p + m})) << "a box around a visible point is visible";
        }
    }
    EXPECT_GT(inside, 1000);
}

TEST(Frustum, contains_a_box_when_all_its_corners_are_inside) {
    Random random(2);
    const Matrix camera = perspective(1, 1, 1, 100);
    const Frustum frustum = *frustum_of(camera);
    int contained = 0;
    for (int round = 0; round < 20000; ++round) {
        const Vec3 c = test::random_vector(random, 30), half = abs(test::random_vector(random, 4));
        const Aabb box{c - half, c + half};
        double min_depth = 1e9;
        for (int i = 0; i < 8; ++i) {
            const Vec3 corner{i & 1 ? box.lo.x : box.hi.x, i & 2 ? box.lo.y : box.hi.y, i & 4 ? box.lo.z : box.hi.z};
            min_depth = std::min(min_depth, depth_inside(camera, corner, ClipDepth::MinusOneToOne));
        }
        if (std::abs(min_depth) < 1e-4) continue;
        ASSERT_EQ(contains(frustum, box), min_depth > 0);
        ASSERT_TRUE(overlaps(frustum, box) || min_depth < 0);
        contained += min_depth > 0 ? 1 : 0;
    }
    EXPECT_GT(contained, 1000);
}

TEST(Frustum, of_the_identity_is_the_cube_from_minus_one_to_one) {
    const Matrix identity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    const Frustum cube = *frustum_of(identity);
    EXPECT_TRUE(contains(cube, {{-1, -1, -1}, {1, 1, 1}}));
    EXPECT_TRUE(overlaps(cube, {{1, 1, 1}, {2, 2, 2}})) << "touching counts";
    EXPECT_FALSE(overlaps(cube, {{1.001f, 0, 0}, {2, 2, 2}}));
    EXPECT_FALSE(overlaps(cube, Aabb{}));
    EXPECT_FALSE(contains(cube, Aabb{}));
    EXPECT_FALSE(contains(cube, Aabb::everything()));
    EXPECT_TRUE(overlaps(cube, Aabb::everything()));
    const float inf = Aabb::infinity;
    EXPECT_TRUE(overlaps(cube, {{-inf, -inf, -inf}, {inf, -1, inf}})) << "ground that touches from below";
    EXPECT_FALSE(overlaps(cube, {{-inf, -inf, -inf}, {inf, -1.01f, inf}}));
    const Aabb around = bounds(cube);
    EXPECT_TRUE(contains(around, {{-1, -1, -1}, {1, 1, 1}}));
    EXPECT_TRUE(contains({{-1.001f, -1.001f, -1.001f}, {1.001f, 1.001f, 1.001f}}, around));
    const Frustum half = *frustum_of(identity, ClipDepth::ZeroToOne);
    EXPECT_FALSE(overlaps(half, {{-1, -1, -1}, {1, 1, -0.5f}}));
}

TEST(Frustum, of_a_degenerate_or_not_finite_matrix_is_refused) {
    Matrix m = perspective(1, 1, 1, 100);
    m[7] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(frustum_of(m).status(), Status::BadArgument);
    EXPECT_EQ(frustum_of(Matrix{}).status(), Status::BadArgument);
}

TEST(Frustum, without_a_far_plane_has_infinite_bounds) {
    EXPECT_EQ(bounds(*frustum_of(perspective(1, 1, 1, 0))), Aabb::everything());
}

}  // namespace
}  // namespace fase
