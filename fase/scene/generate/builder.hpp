#pragma once
/// What the generators build with: shapes with a picture of themselves, bodies with one or several of them.
#include <string>
#include <string_view>
#include <vector>

#include "fase/core/random.hpp"
#include "fase/scene/generate.hpp"
#include "fase/scene/scene.hpp"

namespace fase::scene {

/// What something is made of and how it looks.
struct Stuff {
    std::string_view name;  ///< becomes the body's name
    Colour colour;
    float density = 1000;  ///< kg/m³
    Material material;
};

/// Where a body begins and how it moves then.
struct Start {
    Vec3d position = {};
    Quat rotation = {};
    Vec3 linear_velocity = {};
    BodyKind kind = BodyKind::Dynamic;
    bool awake = true;
};

/// Fills a Scene. Shapes are added once and used by index; each gets a mesh of its own surface, so that the saved scene
/// shows in any glTF viewer.
class Builder {
public:
    explicit Builder(std::string_view name) { scene_.name = name; }

    /// A shape to build with. An invalid one is a broken contract.
    std::uint32_t shape(Shape shape);
    /// The convex hull of the points, which must span a solid: random rocks, wedges, arch stones.
    std::uint32_t hull(const std::vector<Vec3>& points);
    /// A body of one shape.
    Body& add(std::uint32_t shape, const Stuff& stuff, const Start& start);
    /// One more shape on a body.
    void attach(Body& body, std::uint32_t shape, const Stuff& stuff, const LocalPose& pose);
    /// Endless ground under y = 0, drawn as a square of `half_width` to each side.
    void ground(float half_width, const Stuff& stuff);
    /// A static box that is given by its centre and half sizes.
    void static_box(Vec3d centre, Vec3 half, const Stuff& stuff);

    Scene& scene() { return scene_; }
    [[nodiscard]] Scene take() { return std::move(scene_); }

private:
    Scene scene_;
};

/// The stones of a rock about as large as a ball of `radius`: points on a jittered ball.
[[nodiscard]] std::vector<Vec3> rock_points(Random& random, float radius, int count);
/// Uniform over all rotations. Source: Marsaglia 1972, Choosing a point from the surface of a sphere.
[[nodiscard]] Quat any_rotation(Random& random);
/// Uniform on the unit sphere, by rejection.
[[nodiscard]] Vec3 any_direction(Random& random);

inline constexpr Stuff grass{"ground", {0.33f, 0.42f, 0.22f}, 1000, {.friction = 0.7f}};

Scene make_castle(const GenerateOptions& options);
Scene make_large_pyramid(const GenerateOptions& options);
Scene make_many_pyramids(const GenerateOptions& options);
Scene make_hull_pile(const GenerateOptions& options);
Scene make_washer(const GenerateOptions& options);
Scene make_stack(const GenerateOptions& options);
Scene make_pile(const GenerateOptions& options);
Scene make_sleepers(const GenerateOptions& options);
Scene make_domino(const GenerateOptions& options);

}  // namespace fase::scene
