#pragma once
/// Builds the scenes of the generators: shapes with their own meshes, bodies with one or more shapes.
#include <string>
#include <string_view>
#include <vector>

#include "fase/core/random.hpp"
#include "fase/scene/generate.hpp"
#include "fase/scene/scene.hpp"

namespace fase::scene {

/// Name, colour and physical properties of generated bodies.
struct BodyStyle {
    std::string_view name;  ///< name of the bodies
    Colour colour;
    float density = 1000;  ///< kg/m³
    Material material;
};

/// The initial state of a body.
struct InitialState {
    Vec3d position = {};
    Quat rotation = {};
    Vec3 linear_velocity = {};
    BodyKind kind = BodyKind::Dynamic;
    bool awake = true;
};

/// Fills a Scene. Shapes are added once and referenced by index. Each shape gets a mesh of its surface, so that every
/// glTF viewer can show the saved scene.
class Builder {
public:
    explicit Builder(std::string_view name) { scene_.name = name; }

    /// Adds a shape and returns its index. Asserts that it is valid.
    std::uint32_t shape(Shape shape);
    /// Adds the convex hull of the points and returns its index. The points must not lie in one plane.
    std::uint32_t hull(const std::vector<Vec3>& points);
    /// Adds a body with one shape.
    Body& add(std::uint32_t shape, const BodyStyle& style, const InitialState& initial);
    /// Adds one more shape to a body.
    void attach(Body& body, std::uint32_t shape, const BodyStyle& style, const LocalPose& pose);
    /// Adds an infinite ground below y = 0, drawn as a square of half-width `half_width`.
    void ground(float half_width, const BodyStyle& style);
    /// Adds a static box; `half` are its half sizes.
    void static_box(Vec3d centre, Vec3 half, const BodyStyle& style);

    Scene& scene() { return scene_; }
    [[nodiscard]] Scene take() { return std::move(scene_); }

private:
    Scene scene_;
};

/// Returns `count` points of a random rock: directions on a sphere, at jittered distances up to `radius`.
[[nodiscard]] std::vector<Vec3> rock_points(Random& random, float radius, int count);
/// Returns a uniformly distributed rotation. Source: Marsaglia 1972, Choosing a point from the surface of a sphere.
[[nodiscard]] Quat random_rotation(Random& random);
/// Returns a uniformly distributed unit vector, by rejection.
[[nodiscard]] Vec3 random_direction(Random& random);

inline constexpr BodyStyle grass{"ground", {0.33f, 0.42f, 0.22f}, 1000, {.friction = 0.7f}};

Scene make_castle(const GenerateOptions& options);
Scene make_large_pyramid(const GenerateOptions& options);
Scene make_many_pyramids(const GenerateOptions& options);
Scene make_hull_pile(const GenerateOptions& options);
Scene make_washer(const GenerateOptions& options);
Scene make_stack(const GenerateOptions& options);
Scene make_pile(const GenerateOptions& options);
Scene make_sleepers(const GenerateOptions& options);
Scene make_hills(const GenerateOptions& options);
Scene make_trees(const GenerateOptions& options);
Scene make_junkyard(const GenerateOptions& options);
Scene make_domino(const GenerateOptions& options);

}  // namespace fase::scene
