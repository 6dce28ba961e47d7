/// Contacts of the general path: properties of every manifold, and the contacts of resting shapes.
#include "fase/narrow/detail/general.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <set>
#include <string>
#include <vector>

#include "fase/narrow/dispatch.hpp"
#include "fase/narrow/distance.hpp"
#include "tests/narrow/random_shapes.hpp"

namespace fase {
namespace {

using narrow::collide_general;
using narrow::Manifold;
using namespace test;

LocalPose random_pose(Random& random, float reach) {
    return {random_in_cube(random) * reach, to_float(random_rotation(random))};
}

LocalPose at(Vec3 position, Quat rotation = {}) { return {position, rotation}; }

bool bounded(const Shape& shape) { return !std::holds_alternative<HalfSpace>(shape); }

/// Compares a manifold with the exact distance; returns the fault, or an empty string.
std::string wrong_with(const Manifold& m, const Shape& a, const Shape& b, const LocalPose& x, float margin) {
    const TransformD exact_pose = to_double(x);
    const narrow::Distance d = narrow::signed_distance(a, b, exact_pose);
    // For sizes of about 1: faces are preferred by 1e-4 of the size, rims are sampled, and a reference face may be
    // slanted to the normal of two deep edges.
    const double slack = 1e-3 + 0.02 * std::abs(d.distance);
    if (m.count < 0 || m.count > 4) return "count";
    if (m.count == 0) return d.distance < margin - slack ? "no point at distance " + std::to_string(d.distance) : "";
    if (!(std::abs(length(m.normal) - 1) < 1e-5f)) return "normal not unit";
    if (d.distance > margin + slack) return "points although farther apart";
    double deepest = 1e9;
    std::set<std::uint32_t> names;
    for (int i = 0; i < m.count; ++i) {
        const narrow::ManifoldPoint& p = m.points[static_cast<std::size_t>(i)];
        if (!(p.separation <= margin)) return "separation above the margin";
        if (!names.insert(p.feature).second) return "two points with the same feature";
        deepest = std::min(deepest, double(p.separation));
        // Half-way between the surfaces: never farther outside a shape than half their distance.
        const double half = std::abs(double(p.separation)) / 2 + slack + 2e-3;
        if (outside(a, to_double(p.position)) > half) return "point outside a";
        if (outside(b, transform_back(exact_pose, to_double(p.position))) > half) return "point outside b";
    }
    if (deepest > d.distance + slack + 0.1 * margin) return "deepest point missed";
    if (deepest < d.distance - slack) return "deeper than the shapes are";
    if (bounded(a) && bounded(b)) {
        const double gap = gap_along(a, b, exact_pose, to_double(m.normal));
        if (gap < d.distance - slack) return "not the minimum penetration";
    }
    return "";
}

TEST(General, ManifoldsOfRandomPairsAgreeWithTheDistance) {
    Random random(1);
    int touching = 0;
    for (int i = 0; i < 100000; ++i) {
        const Shape a = random_shape(random, random.below(solid_or_ground_kinds));
        const Shape b = random_shape(random, random.below(solid_or_ground_kinds));
        const LocalPose x = random_pose(random, 1.5f);
        const float margin = random.below(2) == 0 ? 0.02f : 0.2f;
        const Manifold m = collide_general(a, b, x, margin);
        if (!bounded(a) && !bounded(b)) {
            ASSERT_EQ(m.count, 0);
            continue;
        }
        touching += m.count > 0;
        ASSERT_EQ(wrong_with(m, a, b, x, margin), "") << i << " " << name_of(a) << " " << name_of(b);
    }
    EXPECT_GT(touching, 20000);
}

TEST(General, BothOrdersGiveTheSameContact) {
    Random random(2);
    for (int i = 0; i < 20000; ++i) {
        const Shape a = random_shape(random, random.below(solid_or_ground_kinds));
        const Shape b = random_shape(random, random.below(solid_or_ground_kinds));
        const LocalPose x = random_pose(random, 1.5f);
        const Manifold m = collide_general(a, b, x, 0.05f);
        const Manifold back = narrow::flipped(collide_general(b, a, inverse(x), 0.05f), x);
        if (m.count == 0 || back.count == 0) continue;
        // Two directions may have the same depth; then the normals differ, and so may all other values.
        if (dot(m.normal, back.normal) < 0.999f) continue;
        float deepest = 1e9f, min_back = 1e9f;
        for (int k = 0; k < m.count; ++k) {
            deepest = std::min(deepest, m.points[static_cast<std::size_t>(k)].separation);
        }
        for (int k = 0; k < back.count; ++k) {
            min_back = std::min(min_back, back.points[static_cast<std::size_t>(k)].separation);
        }
        ASSERT_NEAR(deepest, min_back, 6e-3f) << i << " " << name_of(a) << " " << name_of(b);
    }
}

struct Resting {
    const char* what;
    Shape a, b;
    LocalPose b_in_a;
    int count;
};

std::vector<Resting> resting_pairs() {
    const Box cube{{0.5f, 0.5f, 0.5f}}, slab{{2, 0.5f, 2}};
    const Shape hull = box_hull({0.5f, 0.5f, 0.5f}), hull_slab = box_hull({2, 0.5f, 2});
    const Cylinder drum{0.5f, 0.5f};
    const Capsule pill{0.25f, 0.5f};
    const Quat on_edge = rotation_about<float>({0, 0, 1}, 0.78539816f),
               lying = rotation_about<float>({0, 0, 1}, 1.57079633f);
    const float diagonal = std::sqrt(0.5f), deep = 0.01f;
    std::vector<Resting> all;
    for (const Shape& ground : {Shape(slab), hull_slab, Shape(HalfSpace{})}) {
        const float top = std::holds_alternative<HalfSpace>(ground) ? 0 : 0.5f;
        for (const float gap : {-deep, -1e-4f, 0.f, 1e-4f, deep}) {
            const float y = top + gap;
            all.push_back(
                {"box on its face", ground, cube, at({0, y + 0.5f, 0}, rotation_about<float>({0, 1, 0}, 0.3f)), 4});
            all.push_back({"hull on its face", ground, hull, at({0.2f, y + 0.5f, 0}), 4});
            all.push_back({"box on its edge", ground, cube, at({0, y + diagonal, 0}, on_edge), 2});
            all.push_back({"hull on its edge", ground, hull, at({0, y + diagonal, 0}, on_edge), 2});
            all.push_back({"drum on its cap", ground, drum, at({0, y + 0.5f, 0}), 4});
            all.push_back({"drum on its side", ground, drum, at({0, y + 0.5f, 0}, lying), 2});
            all.push_back({"pill on its side", ground, pill, at({0, y + 0.25f, 0}, lying), 2});
            all.push_back({"pill upright", ground, pill, at({0, y + 0.75f, 0}), 1});
            all.push_back({"sphere", ground, Sphere{0.5f}, at({0, y + 0.5f, 0}), 1});
        }
    }
    all.push_back({"flush boxes", cube, cube, at({0, 0.99f, 0}), 4});
    all.push_back({"flush hulls", hull, hull, at({0, 0.99f, 0}), 4});
    all.push_back({"flush boxes, just apart", cube, cube, at({0, 1.005f, 0}), 4});
    all.push_back({"half over the edge", cube, cube, at({0.5f, 0.995f, 0.25f}), 4});
    all.push_back(
        {"rotated by 45 degrees", cube, cube, at({0, 0.995f, 0}, rotation_about<float>({0, 1, 0}, 0.785f)), 4});
    all.push_back({"crossed edges", Cylinder{0.5f, 2}, Cylinder{0.5f, 2},
                   at({0, 0, 0.995f}, rotation_about<float>({0, 0, 1}, 1.57f)), 1});
    all.push_back({"side by side drums", drum, drum, at({0.995f, 0.25f, 0}), 2});
    all.push_back({"drum on drum", drum, drum, at({0, 0.995f, 0}), 4});
    all.push_back({"pills side by side", pill, pill, at({0.5f, 0.5f, 0}), 2});
    all.push_back({"crossed pills", pill, pill, at({0.5f, 0, 0}, rotation_about<float>({1, 0, 0}, 1.57f)), 1});
    all.push_back({"pill along a drum", drum, pill, at({0.745f, 0, 0}), 2});
    all.push_back({"edge to edge", Box{{0.5f, 2, 0.5f}}, Box{{0.5f, 2, 0.5f}}, at({1.41f, 1, 0}, {}), 0});
    return all;
}

TEST(General, HasTheExpectedNumberOfPoints) {
    for (const Resting& pair : resting_pairs()) {
        const float margin = 0.02f;
        const Manifold m = collide_general(pair.a, pair.b, pair.b_in_a, margin);
        EXPECT_EQ(m.count, pair.count) << pair.what << " on " << name_of(pair.a) << " y " << pair.b_in_a.position.y;
        EXPECT_EQ(wrong_with(m, pair.a, pair.b, pair.b_in_a, margin), "") << pair.what;
    }
}

TEST(General, TheFourCornersOfARestingBoxAreExact) {
    const Manifold m = collide_general(Box{{2, 0.5f, 2}}, Box{{0.5f, 0.5f, 0.25f}}, at({0.5f, 0.99f, 0}), 0.02f);
    ASSERT_EQ(m.count, 4);
    EXPECT_NEAR(m.normal.y, 1, 1e-6f);
    std::set<std::pair<float, float>> corners;
    for (const narrow::ManifoldPoint& p : m.points) {
        EXPECT_NEAR(p.separation, -0.01f, 1e-6f);
        EXPECT_NEAR(p.position.y, 0.495f, 1e-6f);
        EXPECT_NEAR(std::abs(p.position.x - 0.5f), 0.5f, 1e-6f);
        EXPECT_NEAR(std::abs(p.position.z), 0.25f, 1e-6f);
        corners.insert({p.position.x > 0.5f ? 1.f : 0.f, p.position.z > 0 ? 1.f : 0.f});
    }
    EXPECT_EQ(corners.size(), 4u);
}

TEST(General, FeaturesAreStableUnderSmallMotions) {
    Random random(3);
    for (const Resting& pair : resting_pairs()) {
        const bool rolls = std::string_view(pair.what).find("drum") != std::string_view::npos;
        const Manifold before = collide_general(pair.a, pair.b, pair.b_in_a, 0.02f);
        std::set<std::uint32_t> names;
        for (int i = 0; i < before.count; ++i) names.insert(before.points[static_cast<std::size_t>(i)].feature);
        // Skips the ties (flush, on the diagonal).
        if (std::string_view(pair.what).find("flush") != std::string_view::npos || rolls) continue;
        for (int i = 0; i < 20; ++i) {
            LocalPose shifted = pair.b_in_a;
            shifted.position += random_in_cube(random) * 1e-5f;
            shifted.rotation = normalized(shifted.rotation * rotation_about(to_float(random_direction(random)), 1e-5f));
            const Manifold after = collide_general(pair.a, pair.b, shifted, 0.02f);
            ASSERT_EQ(after.count, before.count) << pair.what;
            for (int k = 0; k < after.count; ++k) {
                EXPECT_TRUE(names.count(after.points[static_cast<std::size_t>(k)].feature))
                    << pair.what << " " << name_of(pair.a) << " y " << pair.b_in_a.position.y;
            }
        }
    }
}

TEST(General, ATiltedDrumStandsOnTheLowestPointOfItsRim) {
    for (const float tilt : {0.02f, 0.1f, 0.4f}) {
        for (const float spin : {0.f, 0.1f, 0.26f}) {
            const Quat q = rotation_about<float>({0, 0, 1}, tilt) * rotation_about<float>({0, 1, 0}, spin);
            const float height = 0.5f * std::cos(tilt) + 0.5f * std::sin(tilt);
            const Manifold m =
                collide_general(Box{{2, 0.5f, 2}}, Cylinder{0.5f, 0.5f}, at({0, 0.5f + height, 0}, q), 0.02f);
            ASSERT_GT(m.count, 0) << tilt;
            float deepest = 1;
            for (int i = 0; i < m.count; ++i) {
                deepest = std::min(deepest, m.points[static_cast<std::size_t>(i)].separation);
            }
            EXPECT_NEAR(deepest, 0, 4e-4f) << tilt << " " << spin;
        }
    }
}

TEST(General, IsValidForNaNInfinityAndExtremeNumbers) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), infinite = std::numeric_limits<float>::infinity();
    const std::vector<Shape> shapes{Sphere{0.5f}, Box{}, Capsule{}, Cylinder{}, box_hull({1, 1, 1}), HalfSpace{}};
    for (const Shape& a : shapes) {
        for (const Shape& b : shapes) {
            for (const Vec3 p : {Vec3{nan, 0, 0}, Vec3{infinite, 0, 0}, Vec3{1e30f, 0, 0}, Vec3{0, 1e-30f, 0}}) {
                const Manifold m = collide_general(a, b, at(p), 0.1f);
                EXPECT_GE(m.count, 0);
                EXPECT_LE(m.count, 4);
            }
        }
    }
}

}  // namespace
}  // namespace fase
