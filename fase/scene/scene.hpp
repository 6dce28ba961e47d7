#pragma once
/// A scene as plain data: files store it, generators create it, and worlds are filled from it.
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

/// Triangles that are drawn; they take no part in collision.
struct Mesh {
    std::string name;
    std::vector<Vec3> positions;         ///< metres, in the mesh's own frame
    std::vector<std::uint32_t> indices;  ///< three per triangle, counter-clockwise seen from outside
    friend bool operator==(const Mesh&, const Mesh&) = default;
};

/// A placed mesh: a point p of the mesh is drawn at linear * p + position.
struct Visual {
    std::uint32_t mesh = 0;          ///< index in Scene::meshes
    Vec3 position;                   ///< in the body's frame; in world coordinates if it has no body
    Mat3 linear = Mat3::identity();  ///< rotation, scale and shear; a negative determinant flips the triangles
    Colour colour;
    friend bool operator==(const Visual&, const Visual&) = default;
};

/// A node of a file that has a mesh and no body: a range of Scene::scenery.
struct SceneryNode {
    std::string name;                     ///< may be empty, need not be unique
    std::optional<std::uint32_t> parent;  ///< the nearest such node above it: a lower index in Scene::scenery_nodes
    std::uint32_t first = 0, count = 0;
    friend bool operator==(const SceneryNode&, const SceneryNode&) = default;
};

/// One collider of a body.
struct Collider {
    std::uint32_t shape = 0;  ///< index in Scene::shapes
    ColliderDef def;
    std::string name;  ///< may be empty, need not be unique
};

/// One body with its colliders and visuals.
struct Body {
    std::string name;  ///< may be empty, need not be unique
    BodyDef def;
    std::vector<Collider> colliders;
    std::vector<Visual> visuals;
};

/// A joint from a file. Joints are not simulated yet; the scene stores which bodies they connect and whether these may
/// collide.
struct Joint {
    std::string name;
    std::string type;                ///< "fixed", "hinge", "ball", "slider" or "5 free axes" …
    std::optional<std::uint32_t> a;  ///< index in Scene::bodies; nullopt: the world
    std::optional<std::uint32_t> b;
    bool collide = false;  ///< whether a and b may collide
    friend bool operator==(const Joint&, const Joint&) = default;
};

/// The initial view of a scene.
struct Camera {
    Vec3 eye, target;             ///< metres, world; up is +y
    float vertical_angle = 0.8f;  ///< field of view, radians
    friend constexpr bool operator==(const Camera&, const Camera&) = default;
};

/// Settings that a scene requests; empty ones keep the user's value.
struct SettingsHint {
    std::optional<float> time_step;  ///< seconds
    std::optional<int> sub_steps;
    std::optional<bool> sleep;
    friend constexpr bool operator==(const SettingsHint&, const SettingsHint&) = default;
};

/// A scene: its bodies, their appearance, and warnings about unsupported parts of the file. Indices refer to the
/// scene's own lists.
struct Scene {
    std::string name;
    Vec3 gravity{0, -9.81f, 0};  ///< m/s²
    std::vector<Body> bodies;
    std::vector<Shape> shapes;               ///< shared by colliders
    std::vector<Mesh> meshes;                ///< shared by visuals
    std::vector<Visual> scenery;             ///< visuals without a body: drawn only
    std::vector<SceneryNode> scenery_nodes;  ///< of the file, parents first, together all of the scenery; may be empty
    std::vector<Joint> joints;
    std::optional<Camera> camera;
    SettingsHint settings;
    std::vector<std::string> extensions_used;  ///< as listed in the file
    std::vector<std::string> extensions_required;
    /// Unsupported parts of the file, counted: "triangle-mesh colliders are not simulated yet (3 times)". What is
    /// missing in the simulation comes first, then what is simulated otherwise, then unknown parts, then what is not
    /// drawn.
    std::vector<std::string> warnings;
};

/// Returns `base` with the scene's gravity and its requested settings.
[[nodiscard]] Settings settings_for(const Scene& scene, const Settings& base = {});

/// Adds all bodies of the scene in their order and returns their ids in that order. Excludes the pairs of bodies whose
/// joint disables collision. Does not change the world's settings: create the world with settings_for(). On an error,
/// which names the body, the world is unchanged.
Result<std::vector<BodyId>> instantiate(const Scene& scene, World& world);

/// Number of dynamic bodies in the scene.
[[nodiscard]] std::size_t dynamic_bodies(const Scene& scene);

}  // namespace fase::scene
