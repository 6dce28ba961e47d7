// Contacts at seams: what a neighbour hides, and what stands out of it.
#include "fase/narrow/seams/seams.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "fase/geometry/bounds.hpp"
#include "fase/geometry/hull_builder.hpp"
#include "fase/narrow/dispatch.hpp"

namespace fase::narrow {
namespace {

constexpr float margin = 1;

/// A shape that moves among boxes, as a step of the world sees it.
struct Scene {
    Shape shape;
    Vec3 at;
    Vec3d path;
    std::vector<Shape> pieces;
    std::vector<Vec3> places;
    std::vector<SeamContact> contacts;

    void add(const Shape& piece, Vec3 place) {
        pieces.push_back(piece);
        places.push_back(place);
    }
    /// Collides the shape with all pieces, and corrects the contacts.
    void run() {
        contacts.assign(pieces.size(), {});
        for (std::size_t i = 0; i < pieces.size(); ++i) {
            SeamContact& contact = contacts[i];
            contact.piece = {&pieces[i], {Mat3d::identity(), to_double(places[i] - at)}, 0};
            contact.manifold = collide(pieces[i], shape, {at - places[i], {}}, margin);
            for (int k = 0; k < contact.manifold.count; ++k)
                contact.manifold.points[static_cast<std::size_t>(k)].position += places[i] - at;
        }
        SeamMover mover;
        mover.shape = &shape;
        mover.path = path;
        mover.margin = double(margin);
        mover.is_fast = true;
        mover.inner_radius = inner_radius(shape);
        correct_seams(mover, contacts);
    }
    [[nodiscard]] bool acts(std::size_t piece) const { return contacts[piece].manifold.count > 0; }
    [[nodiscard]] Vec3 normal(std::size_t piece) const { return contacts[piece].manifold.normal; }
};

const Box tile{{0.5f, 0.25f, 0.5f}};
const Box slider{{0.2f, 0.1f, 0.2f}};
constexpr Vec3 up{0, 1, 0};

TEST(Seams, the_side_of_the_next_tile_is_hidden) {
    for (const Shape& shape : {Shape{slider}, Shape{Sphere{0.1f}}, Shape{Capsule{0.05f, 0.05f}}}) {
        Scene scene{shape, {0.5f, 0.1f, 0.5f}, {1, 0, 0}};
        scene.add(tile, {0.5f, -0.25f, 0.5f});
        scene.add(tile, {1.5f, -0.25f, 0.5f});
        scene.run();
        ASSERT_TRUE(scene.acts(0));
        EXPECT_GT(dot(scene.normal(0), up), 0.999999f);
        EXPECT_TRUE(!scene.acts(1) || dot(scene.normal(1), up) > 0.999999f);
    }
}

TEST(Seams, a_step_stands_out_of_its_neighbour) {
    for (const float height : {0.004f, 0.05f, 0.5f}) {
        Scene scene{slider, {0.5f, 0.1f, 0.5f}, {1, 0, 0}};
        scene.add(tile, {0.5f, -0.25f, 0.5f});
        scene.add(tile, {1.5f, -0.25f + height, 0.5f});
        scene.run();
        ASSERT_TRUE(scene.acts(1)) << height;
        EXPECT_LT(scene.normal(1).x, -0.99f) << height;
    }
}

TEST(Seams, a_step_of_a_millimetre_is_none) {
    Scene scene{slider, {0.5f, 0.1f, 0.5f}, {1, 0, 0}};
    scene.add(tile, {0.5f, -0.25f, 0.5f});
    scene.add(tile, {1.5f, -0.249f, 0.5f});
    scene.run();
    EXPECT_TRUE(!scene.acts(1) || scene.normal(1).y > 0.99f);
}

TEST(Seams, the_side_of_a_lone_tile_acts) {
    Scene scene{slider, {0.5f, -0.1f, 0.5f}, {1, 0, 0}};
    scene.add(tile, {1.5f, -0.25f, 0.5f});
    scene.run();
    ASSERT_TRUE(scene.acts(0));
    EXPECT_LT(scene.normal(0).x, -0.99f);
}

TEST(Seams, a_wall_of_blocks_acts_also_beside_the_floor) {
    Scene scene{Sphere{0.1f}, {0.5f, 0.1f, 0.5f}, {1, 0, 0}};
    scene.add(tile, {0.5f, -0.25f, 0.5f});
    scene.add(tile, {1.5f, -0.25f, 0.5f});
    scene.add(tile, {1.5f, 0.25f, 0.5f});
    scene.run();
    ASSERT_TRUE(scene.acts(2));
    EXPECT_LT(scene.normal(2).x, -0.99f);
}

TEST(Seams, a_ramp_acts_with_its_slope) {
    const float sine = 0.5f, cosine = 0.8660254f;
    const auto hull_of = [&](float length) {
        std::vector<Vec3> points;
        for (const float z : {0.0f, 1.0f})
            for (const float depth : {0.0f, 0.3f})
                for (const float along : {0.0f, length})
                    points.push_back({along * cosine + depth * sine, along * sine - depth * cosine, z});
        return *build_convex_hull(points);
    };
    for (const Shape& shape : {Shape{Sphere{0.1f}}, Shape{Capsule{0.1f, 0.2f}}}) {
        const bool ball = std::holds_alternative<Sphere>(shape);
        Scene scene{shape, {-0.5f, ball ? 0.1f : 0.3f, 0.5f}, {1, 0, 0}};
        scene.add(tile, {-0.5f, -0.25f, 0.5f});
        scene.add(hull_of(2), {});
        scene.run();
        ASSERT_TRUE(scene.acts(1));
        EXPECT_NEAR(scene.normal(1).x, -sine, 1e-4f);
        EXPECT_NEAR(scene.normal(1).y, cosine, 1e-4f);
    }
}

TEST(Seams, pieces_that_move_against_each_other_do_not_hide_each_other) {
    Scene scene{Sphere{0.1f}, {0.5f, 0.1f, 0.5f}, {0.1, 0, 0}};
    scene.add(tile, {0.5f, -0.25f, 0.5f});
    scene.add(tile, {1.5f, -0.25f, 0.5f});
    scene.run();
    EXPECT_FALSE(scene.acts(1));
    scene.contacts[1].piece.frame = 7;
    scene.contacts[1].manifold = collide(tile, scene.shape, {scene.at - scene.places[1], {}}, margin);
    const SeamMover mover{&scene.shape, {}, scene.path, double(margin), false, 0.1f, 0};
    correct_seams(mover, scene.contacts);
    EXPECT_TRUE(scene.acts(1));
}

TEST(Seams, a_contact_that_the_path_misses_ends_unless_something_may_push_the_shape) {
    for (const double detour : {0.0, 0.05}) {
        const Shape ball = Sphere{0.25f}, box = Box{{0.5f, 0.5f, 0.5f}};
        const Vec3 at{-1, 0.76f, 0};
        std::vector<SeamContact> contacts(1);
        contacts[0].piece = {&box, {Mat3d::identity(), to_double(-at)}, 0};
        contacts[0].manifold = collide(box, ball, {at, {}}, margin);
        ASSERT_GT(contacts[0].manifold.count, 0);
        SeamMover mover{&ball, {}, {2, 0, 0}, double(margin), true, 0.25f, 0};
        mover.detour = detour;
        correct_seams(mover, contacts);
        EXPECT_EQ(contacts[0].manifold.count == 0, detour == 0);
    }
}

}  // namespace
}  // namespace fase::narrow
