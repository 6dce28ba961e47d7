/// Reads motions, colliders, triggers, materials, filters and joints.
#include "fase/scene/gltf/physics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>

namespace fase::scene::gltf {
namespace {

/// The common name of a joint with the axes that its limits leave free.
std::string joint_type(const JsonDocument& document, JsonValue joint, Warnings& warnings) {
    std::array<bool, 3> linear{}, angular{};
    const Table limits(document, joint, "limits");
    for (std::size_t i = 0; i < limits.size(); ++i) {
        const JsonValue limit = limits[i];
        const bool locks = number_in(limit, "min", -1) == 0 && number_in(limit, "max", 1) == 0;
        for (const bool is_angular : {false, true}) {
            const std::optional<JsonValue> axes =
                member(limit, is_angular ? "angularAxes" : "linearAxes", JsonKind::Array);
            if (!axes) continue;
            axes->for_each_element([&](JsonValue axis) {
                const std::uint32_t index = index_of(axis, 3, "axes");
                if (locks) (is_angular ? angular : linear)[index] = true;
            });
        }
    }
    if (!Table(document, joint, "drives").empty()) warnings.add("joint drives are not simulated yet", Harm::Missing);
    const auto free_linear = 3 - std::count(linear.begin(), linear.end(), true),
               free_angular = 3 - std::count(angular.begin(), angular.end(), true);
    if (free_linear == 0 && free_angular == 0) return "fixed";
    if (free_linear == 0 && free_angular == 1) return "hinge";
    if (free_linear == 0 && free_angular == 3) return "ball";
    if (free_linear == 1 && free_angular == 0) return "slider";
    return fmt::format("{} free axes", free_linear + free_angular);
}

CombineMode combine_mode(JsonValue material, std::string_view key, Warnings& warnings) {
    const std::string_view name = text_in(material, key).value_or("average");
    if (name == "minimum") return CombineMode::Minimum;
    if (name == "maximum") return CombineMode::Maximum;
    if (name == "multiply") return CombineMode::Multiply;
    if (name != "average")
        warnings.add_named(fmt::format("{} {{}} is not supported, \"average\" is used", key), quoted_short(name),
                           Harm::Changed);
    // Fase's own mode, which the extension does not define.
    const std::optional<JsonValue> extras = member(material, "extras", JsonKind::Object);
    const std::optional<JsonValue> own =
        extras && extras->find("fase") ? member(*extras, "fase", JsonKind::Object) : std::nullopt;
    if (own && text_in(*own, key) == "geometricMean") return CombineMode::GeometricMean;
    return CombineMode::Average;
}

}  // namespace

Physics::Physics(Document& document, Warnings& warnings)
    : document_(document),
      warnings_(warnings),
      khr_shapes_(document, warnings, "KHR_implicit_shapes", "shapes", ShapeDialect::KhrImplicit),
      khr_early_shapes_(document, warnings, "KHR_collision_shapes", "shapes", ShapeDialect::KhrCollision),
      omi_shapes_(document, warnings, "OMI_physics_shape", "shapes", ShapeDialect::Omi),
      omi_colliders_(document, warnings, "OMI_collider", "colliders", ShapeDialect::OmiCollider) {
    read_resources("KHR_physics_rigid_bodies", khr_);
    read_resources("KHR_rigid_bodies", khr_early_);
    read_resources("OMI_physics_body", omi_);
    Resources joints;
    read_resources("OMI_physics_joint", joints);
    omi_joints_ = joints.joints;
}

void Physics::read_resources(std::string_view extension_name, Resources& out) {
    const std::optional<JsonValue> body = extension(document_.root(), extension_name);
    if (!body) return;
    warnings_.unknown_members(*body, extension_name,
                              {"physicsMaterials", "collisionFilters", "physicsJoints", "physicsJointLimits"});
    out.materials = Table(document_.json(), *body, "physicsMaterials");
    out.filters = Table(document_.json(), *body, "collisionFilters");
    out.joints = Table(document_.json(), *body, "physicsJoints");
}

void Physics::common_motion(JsonValue json, Motion& motion) {
    motion.json = json;
    motion.mass = optional_number(json, "mass");
    if (motion.mass && *motion.mass < 0)
        refuse(*json.find("mass"), fmt::format("found {} kg; expected 0 or more", *motion.mass));
    motion.centre = vec3_in(json, "centerOfMass");
    motion.inertia = vec3_in(json, "inertiaDiagonal");
    if (motion.inertia && (motion.inertia->x < 0 || motion.inertia->y < 0 || motion.inertia->z < 0)) {
        refuse(*json.find("inertiaDiagonal"), "found a moment of inertia below 0; expected 0 or more");
    }
    motion.inertia_axes = rotation_in(json, "inertiaOrientation").value_or(Quatd{});
    motion.linear = vec3_in(json, "linearVelocity").value_or(Vec3d{});
    motion.angular = vec3_in(json, "angularVelocity").value_or(Vec3d{});
    motion.gravity = number_in(json, "gravityFactor", 1);
}

Motion Physics::khr_motion(JsonValue json) {
    warnings_.unknown_members(json, "motion's",
                              {"isKinematic", "mass", "centerOfMass", "inertiaDiagonal", "inertiaOrientation",
                               "linearVelocity", "angularVelocity", "gravityFactor"});
    Motion motion;
    common_motion(json, motion);
    if (flag_in(json, "isKinematic", false)) motion.kind = BodyKind::Kinematic;
    // JSON has no infinity: 0 means infinite.
    if (motion.mass && *motion.mass == 0) {
        motion.infinite_mass = true;
        motion.mass.reset();
    }
    if (motion.inertia && (motion.inertia->x == 0 || motion.inertia->y == 0 || motion.inertia->z == 0)) {
        motion.infinite_inertia = motion.inertia == Vec3d{};
        if (!motion.infinite_inertia)
            warnings_.add(
                "an infinite moment of inertia about some axes only is not simulated, that of the shapes is used");
        motion.inertia.reset();
    }
    return motion;
}

Motion Physics::omi_motion(JsonValue json, std::string_view type) {
    Motion motion;
    common_motion(json, motion);
    if (type == "static")
        motion.kind = BodyKind::Static;
    else if (type == "kinematic")
        motion.kind = BodyKind::Kinematic;
    else if (type != "dynamic" && type != "rigid")
        warnings_.add_named("body type {} is not supported, \"dynamic\" is used", quoted_short(type), Harm::Changed);
    if (!motion.mass || *motion.mass == 0) motion.mass = 1;
    if (!motion.centre) motion.centre = Vec3d{};
    if (motion.inertia && (motion.inertia->x == 0 || motion.inertia->y == 0 || motion.inertia->z == 0))
        motion.inertia.reset();
    return motion;
}

std::optional<Motion> Physics::motion(std::uint32_t node) {
    const JsonValue json = document_.nodes()[node];
    for (const std::string_view name : {"KHR_physics_rigid_bodies", "KHR_rigid_bodies"}) {
        const std::optional<JsonValue> body = extension(json, name);
        if (!body) continue;
        warnings_.unknown_members(*body, name, {"motion", "rigidBody", "collider", "trigger", "joint"});
        for (const std::string_view key : {"motion", "rigidBody"}) {
            if (const std::optional<JsonValue> motion = member(*body, key, JsonKind::Object))
                return khr_motion(*motion);
        }
    }
    const std::optional<JsonValue> body = extension(json, "OMI_physics_body");
    if (!body) return std::nullopt;
    // In the first version the motion's members are next to "type", and "trigger" is a body type.
    if (const std::optional<std::string_view> type = text_in(*body, "type")) {
        if (*type == "trigger") return std::nullopt;
        return omi_motion(*body, *type);
    }
    warnings_.unknown_members(*body, "OMI_physics_body", {"motion", "collider", "trigger"});
    const std::optional<JsonValue> motion = member(*body, "motion", JsonKind::Object);
    if (!motion) return std::nullopt;
    warnings_.unknown_members(*motion, "motion's",
                              {"type", "mass", "centerOfMass", "inertiaDiagonal", "inertiaOrientation",
                               "linearVelocity", "angularVelocity", "gravityFactor"});
    const std::optional<std::string_view> type = text_in(*motion, "type");
    if (!type) warnings_.add("a motion without a type is treated as \"dynamic\"");
    return omi_motion(*motion, type.value_or("dynamic"));
}

const ShapeSource* Physics::khr_geometry(JsonValue geometry, ShapeList& shapes) {
    warnings_.unknown_members(geometry, "geometry's", {"shape", "node", "mesh", "convexHull"});
    const std::optional<std::uint32_t> shape = index_in(geometry, "shape", shapes.size(), "shapes");
    const std::optional<std::uint32_t> node = index_in(geometry, "node", document_.nodes().size(), "nodes");
    if (shape && node) refuse(geometry, "found both a shape and a node; expected one of them");
    const bool convex = flag_in(geometry, "convexHull", false);
    const ShapeSource* const named = shape ? &shapes.at(document_, *shape) : nullptr;
    if (named != nullptr && (!named->mesh || named->convex || !convex)) return named;
    if (node) {
        ShapeSource& source = node_shapes_[{*node, convex}];
        source.json = geometry;
        source.node = node;
        source.convex = convex;
        return &source;
    }
    // An earlier draft names the mesh directly; its keys start after those of the nodes.
    const std::optional<std::uint32_t> mesh =
        named != nullptr ? named->mesh : index_in(geometry, "mesh", document_.meshes().size(), "meshes");
    if (mesh) {
        ShapeSource& source = node_shapes_[{static_cast<std::uint32_t>(document_.nodes().size()) + *mesh, convex}];
        source.json = geometry;
        source.mesh = mesh;
        source.convex = convex;
        return &source;
    }
    refuse(geometry, "found neither a shape nor a node; expected one of them");
}

void Physics::add_uses(JsonValue body, std::string_view key, bool sensor, ShapeList& shapes, const Resources& resources,
                       std::vector<ColliderUse>& out) {
    const std::optional<JsonValue> json = member(body, key, JsonKind::Object);
    if (!json) return;
    warnings_.unknown_members(*json, fmt::format("{}'s", key),
                              {"geometry", "shape", "physicsMaterial", "collisionFilter", "nodes", "convexHull"});
    if (const std::optional<JsonValue> nodes = member(*json, "nodes", JsonKind::Array)) {
        nodes->for_each_element(
            [&](JsonValue value) { static_cast<void>(index_of(value, document_.nodes().size(), "nodes")); });
        warnings_.add("triggers made of several nodes are reported per node");
    }
    ColliderUse use;
    use.json = *json;
    use.sensor = sensor;
    const std::optional<JsonValue> geometry = member(*json, "geometry", JsonKind::Object);
    if (geometry)
        use.source = khr_geometry(*geometry, shapes);
    else if (const auto shape = index_in(*json, "shape", shapes.size(), "shapes"))
        use.source = &shapes.at(document_, *shape);
    use.material = material(*json, resources);
    use.filter = filter(*json, resources);
    if (use.source != nullptr) out.push_back(use);
}

std::vector<ColliderUse> Physics::colliders(std::uint32_t node) {
    std::vector<ColliderUse> uses;
    const JsonValue json = document_.nodes()[node];
    const auto add = [&](std::string_view name, ShapeList& shapes, const Resources& resources) {
        const std::optional<JsonValue> body = extension(json, name);
        if (!body) return;
        add_uses(*body, "collider", false, shapes, resources, uses);
        add_uses(*body, "trigger", true, shapes, resources, uses);
    };
    ShapeList& khr_shapes = khr_shapes_.size() > 0 ? khr_shapes_ : khr_early_shapes_;
    add("KHR_physics_rigid_bodies", khr_shapes, khr_);
    add("KHR_rigid_bodies", khr_shapes, khr_early_);
    add("OMI_physics_body", omi_shapes_, omi_);
    for (const bool is_omi : {false, true}) {
        // Early extensions that attach a shape directly to a node.
        const std::optional<JsonValue> direct = extension(json, is_omi ? "OMI_collider" : "KHR_collision_shapes");
        if (!direct) continue;
        ShapeList& shapes = is_omi ? omi_colliders_ : khr_early_shapes_;
        const auto shape =
            index_in(*direct, is_omi ? "collider" : "shape", shapes.size(), is_omi ? "colliders" : "shapes");
        if (!shape) continue;
        ColliderUse use;
        use.json = *direct;
        use.source = &shapes.at(document_, *shape);
        use.sensor = is_omi && flag_in(use.source->json, "isTrigger", false);
        uses.push_back(use);
    }
    if (extension(json, "OMI_physics_gravity"))
        warnings_.add("gravity zones (OMI_physics_gravity on a node) are not simulated yet", Harm::Missing);
    return uses;
}

Material Physics::material(JsonValue use, const Resources& resources) {
    Material material;
    const auto index = index_in(use, "physicsMaterial", resources.materials.size(), "physics materials");
    if (!index) return material;
    const JsonValue json = resources.materials[*index];
    warnings_.unknown_members(
        json, "physics material's",
        {"staticFriction", "dynamicFriction", "restitution", "frictionCombine", "restitutionCombine"});
    const auto amount = [&](std::string_view key, double fallback) {
        const double value = number_in(json, key, fallback);
        if (value < 0) refuse(*json.find(key), fmt::format("found {}; expected 0 or more", value));
        return value;
    };
    const double dynamic_friction = amount("dynamicFriction", 0.6),
                 static_friction = amount("staticFriction", dynamic_friction);
    if (json.find("dynamicFriction") && static_friction != dynamic_friction)
        warnings_.add("static friction that differs from dynamic friction is not simulated, dynamic friction is used");
    material.friction = static_cast<float>(json.find("dynamicFriction") ? dynamic_friction : static_friction);
    double restitution = amount("restitution", 0);
    if (restitution > 1) {
        warnings_.add("restitution above 1 is reduced to 1");
        restitution = 1;
    }
    material.restitution = static_cast<float>(restitution);
    material.friction_combine = combine_mode(json, "frictionCombine", warnings_);
    material.restitution_combine = combine_mode(json, "restitutionCombine", warnings_);
    return material;
}

std::uint64_t Physics::system_bit(std::string_view name) {
    if (const auto known = systems_.find(name); known != systems_.end()) return known->second;
    // Fase writes bit n as "bit n"; other names get the first free bit. Bit 0 is for colliders without a system.
    std::uint64_t bit = 0;
    constexpr std::string_view prefix = "bit ";
    int number = -1;
    if (name.starts_with(prefix)) {
        const auto [end, problem] = std::from_chars(name.data() + prefix.size(), name.data() + name.size(), number);
        if (problem == std::errc() && end == name.data() + name.size() && number >= 0 && number < 64)
            bit = std::uint64_t{1} << number;
    }
    if (bit == 0) {
        bit = ~used_bits_ & (used_bits_ + 1);
        if (bit == 0) warnings_.add("collision systems above 63 are ignored");
    }
    used_bits_ |= bit;
    systems_.emplace(std::string(name), bit);
    return bit;
}

pairs::CollisionFilter Physics::filter(JsonValue use, const Resources& resources) {
    pairs::CollisionFilter filter;
    const auto index = index_in(use, "collisionFilter", resources.filters.size(), "collision filters");
    if (!index) return filter;
    const JsonValue json = resources.filters[*index];
    warnings_.unknown_members(json, "collision filter's",
                              {"collisionSystems", "collideWithSystems", "notCollideWithSystems"});
    const auto bits = [&](std::string_view key) {
        std::optional<std::uint64_t> all;
        const std::optional<JsonValue> names = member(json, key, JsonKind::Array);
        if (!names) return all;
        names->for_each_element([&](JsonValue name) {
            if (!name.is(JsonKind::String))
                refuse(name, fmt::format("found {}; expected a text", name_of(name.kind())));
            all = all.value_or(0) | system_bit(name.string());
        });
        return all;
    };
    filter.category = bits("collisionSystems").value_or(1);
    if (filter.category == 0) filter.category = 1;
    const std::optional<std::uint64_t> with = bits("collideWithSystems"), without = bits("notCollideWithSystems");
    if (with && without) refuse(json, "found both collideWithSystems and notCollideWithSystems; expected one of them");
    if (with) filter.mask = *with;
    if (without) filter.mask = ~*without;
    return filter;
}

std::optional<JointUse> Physics::joint(std::uint32_t node) {
    const JsonValue json = document_.nodes()[node];
    const auto read = [&](std::optional<JsonValue> use, const Table& joints) -> std::optional<JointUse> {
        if (!use) return std::nullopt;
        JointUse joint;
        const auto other = index_in(*use, "connectedNode", document_.nodes().size(), "nodes");
        const auto kind = index_in(*use, "joint", joints.size(), "physics joints");
        if (!other || !kind) refuse(*use, "found a joint without connectedNode or joint; expected both");
        joint.other = *other;
        joint.collide = flag_in(*use, "enableCollision", false);
        joint.type = joint_type(document_.json(), joints[*kind], warnings_);
        warnings_.add_named("joints ({}) are not simulated yet", joint.type, Harm::Missing);
        return joint;
    };
    const std::optional<JsonValue> khr = extension(json, "KHR_physics_rigid_bodies");
    if (khr) {
        if (auto joint = read(member(*khr, "joint", JsonKind::Object), khr_.joints)) return joint;
    }
    const std::optional<JsonValue> early = extension(json, "KHR_rigid_bodies");
    if (early && early->find("joint")) warnings_.add("joints of KHR_rigid_bodies are not supported", Harm::Missing);
    const std::optional<JsonValue> omi = extension(json, "OMI_physics_joint");
    if (omi && omi->find("constraints")) {
        warnings_.add("joints made of constraints (an early OMI_physics_joint) are not supported", Harm::Missing);
        return std::nullopt;
    }
    return read(omi, omi_joints_);
}

std::optional<Vec3> Physics::gravity() {
    const std::optional<JsonValue> json = extension(document_.root(), "OMI_physics_gravity");
    if (!json) return std::nullopt;
    warnings_.unknown_members(*json, "OMI_physics_gravity", {"gravity", "direction"});
    const double amount = number_in(*json, "gravity", 9.80665);
    const Vec3d direction = vec3_in(*json, "direction").value_or(Vec3d{0, -1, 0});
    const double length = fase::length(direction);
    if (!(length > 1e-6)) refuse(*json, "found a direction of length 0; expected a length above 0");
    return to_float(direction * (amount / length));
}

}  // namespace fase::scene::gltf
