#pragma once
/// A scene as plain data: what files hold, generators make and a world is filled from.
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/geometry/shapes.hpp"
#include "fase/world/body.hpp"
#include "fase/world/settings.hpp"
#include "fase/world/world.hpp"

namespace fase::scene {

/// Linear RGB and opacity, 0 to 1 each.
struct Colour {
    float red = 0.8f, green = 0.8f, blue = 0.8f, alpha = 1;
    friend constexpr bool operator==(Colour, Colour) = default;
};

/// Triangles for the picture; nothing collides with them.
struct Mesh {
    std::string name;
    std::vector<Vec3> positions;         ///< metres, in the mesh's own frame
    std::vector<std::uint32_t> indices;  ///< three a triangle, counter-clockwise seen from outside
    friend bool operator==(const Mesh&, const Mesh&) = default;
};

/// A mesh in its place: a point p of the mesh is drawn at linear * p + position.
struct Visual {
    std::uint32_t mesh = 0;          ///< index in Scene::meshes
    Vec3 position;                   ///< in the body's frame (the world's, when it belongs to no body)
    Mat3 linear = Mat3::identity();  ///< rotation, scale and shear; a negative determinant turns the triangles over
    Colour colour;
    friend bool operator==(const Visual&, const Visual&) = default;
};

/// One collider of a body.
struct Collider {
    std::uint32_t shape = 0;  ///< index in Scene::shapes
    ColliderDef def;
    std::string name;  ///< may be empty, need not be unique
};

/// One body with all that belongs to it.
struct Body {
    std::string name;  ///< may be empty, need not be unique
    BodyDef def;
    std::vector<Collider> colliders;
    std::vector<Visual> visuals;
};

/// A joint that a file names. Joints are not simulated yet; what is kept of them is which bodies they hold and whether
/// those may touch.
struct Joint {
    std::string name;
    std::string type;                ///< as the file calls it: "hinge", "limits on 5 axes" …
    std::optional<std::uint32_t> a;  ///< index in Scene::bodies; nullopt: the world
    std::optional<std::uint32_t> b;
    bool collide = false;  ///< whether a and b may touch each other
    friend bool operator==(const Joint&, const Joint&) = default;
};

/// From where a scene is best seen first.
struct Camera {
    Vec3 eye, target;             ///< metres, world; up is +y
    float vertical_angle = 0.8f;  ///< radians, from the lower to the upper edge of the picture
    friend constexpr bool operator==(const Camera&, const Camera&) = default;
};

/// Settings that a scene asks for; what it leaves open stays as the user has it.
struct SettingsHint {
    std::optional<float> time_step;  ///< seconds
    std::optional<int> sub_steps;
    std::optional<bool> sleep;
    friend constexpr bool operator==(const SettingsHint&, const SettingsHint&) = default;
};

/// A scene: what moves, how it looks, and what the file said that is not understood. Indices inside are into its own
/// lists.
struct Scene {
    std::string name;
    Vec3 gravity{0, -9.81f, 0};  ///< m/s²
    std::vector<Body> bodies;
    std::vector<Shape> shapes;    ///< shared by colliders
    std::vector<Mesh> meshes;     ///< shared by visuals
    std::vector<Visual> scenery;  ///< seen, but neither touched nor moved
    std::vector<Joint> joints;
    std::optional<Camera> camera;
    SettingsHint settings;
    std::vector<std::string> extensions_used;  ///< as the file lists them
    std::vector<std::string> extensions_required;
    /// What was not understood or not done, each thing once with how often it came: "triangle-mesh colliders are not
    /// simulated yet (3 times)".
    std::vector<std::string> warnings;
};

/// `base` with the scene's gravity and what its hints ask for.
[[nodiscard]] Settings settings_for(const Scene& scene, const Settings& base = {});

/// Adds all bodies of the scene, in their order, and returns their ids in that order. Pairs of bodies that a joint
/// forbids to touch are excluded. The world's settings stay: make it with settings_for(). On an error (which names the
/// body) the world is as it was.
Result<std::vector<BodyId>> instantiate(const Scene& scene, World& world);

/// How many bodies of the scene are dynamic.
[[nodiscard]] std::size_t dynamic_bodies(const Scene& scene);

}  // namespace fase::scene
