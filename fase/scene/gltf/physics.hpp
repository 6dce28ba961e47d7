#pragma once
/// Reads the physics of glTF nodes in a common form for all dialects: KHR_physics_rigid_bodies, its predecessor
/// KHR_rigid_bodies, and both versions of OMI_physics_body. Internal to the glTF reader.
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fase/scene/gltf/shapes.hpp"

namespace fase::scene::gltf {

/// The motion of a node. Vectors are in the node's frame.
struct Motion {
    JsonValue json;
    BodyKind kind = BodyKind::Dynamic;
    std::optional<double> mass;
    std::optional<Vec3d> centre;
    std::optional<Vec3d> inertia;  ///< principal moments
    Quatd inertia_axes;
    Vec3d linear, angular;
    double gravity = 1;
    bool infinite_mass = false, infinite_inertia = false;
};

/// One collider or trigger of a node.
struct ColliderUse {
    JsonValue json;
    const ShapeSource* source = nullptr;
    Material material;
    pairs::CollisionFilter filter;
    bool sensor = false;
};

/// A joint at a node.
struct JointUse {
    std::string type;
    std::uint32_t other = 0;  ///< the connected node
    bool collide = false;
};

/// The physics resources of a document and their use by nodes. Each value is checked when it is read.
class Physics {
public:
    Physics(Document& document, Warnings& warnings);
    [[nodiscard]] std::optional<Motion> motion(std::uint32_t node);
    [[nodiscard]] std::vector<ColliderUse> colliders(std::uint32_t node);
    [[nodiscard]] std::optional<JointUse> joint(std::uint32_t node);
    /// m/s²; nullopt if the file does not define it.
    [[nodiscard]] std::optional<Vec3> gravity();

private:
    struct Resources {
        Table materials, filters, joints;
    };
    void read_resources(std::string_view extension_name, Resources& out);
    [[nodiscard]] Motion khr_motion(JsonValue json);
    [[nodiscard]] Motion omi_motion(JsonValue json, std::string_view type);
    void common_motion(JsonValue json, Motion& motion);
    [[nodiscard]] const ShapeSource* khr_geometry(JsonValue geometry, ShapeList& shapes);
    [[nodiscard]] Material material(JsonValue use, const Resources& resources);
    [[nodiscard]] pairs::CollisionFilter filter(JsonValue use, const Resources& resources);
    [[nodiscard]] std::uint64_t system_bit(std::string_view name);
    void add_uses(JsonValue body, std::string_view key, bool sensor, ShapeList& shapes, const Resources& resources,
                  std::vector<ColliderUse>& out);

    Document& document_;
    Warnings& warnings_;
    ShapeList khr_shapes_, khr_early_shapes_, omi_shapes_, omi_colliders_;
    std::map<std::pair<std::uint32_t, bool>, ShapeSource> node_shapes_;  ///< by node and convexity
    Resources khr_, khr_early_, omi_;
    Table omi_joints_;
    std::map<std::string, std::uint64_t, std::less<>> systems_;
    std::uint64_t used_bits_ = 1;
};

}  // namespace fase::scene::gltf
