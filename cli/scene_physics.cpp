/// What of a scene has physics: automatic colliders, and warnings about scenes in which nothing moves as expected.
#include "cli/scene_physics.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <regex>
#include <string_view>
#include <utility>

#include "cli/common/output.hpp"

namespace fase::cli {
namespace {

constexpr std::size_t max_matched = 1000;  // bytes of a name; matching takes stack in proportion

std::size_t count_colliders(const scene::Scene& scene) {
    std::size_t count = 0;
    for (const scene::Body& body : scene.bodies) count += body.colliders.size();
    return count;
}

/// Mesh nodes, and bodies with meshes.
std::size_t count_meshes(const scene::Scene& scene) {
    const auto with_mesh = std::count_if(scene.bodies.begin(), scene.bodies.end(),
                                         [](const scene::Body& body) { return !body.visuals.empty(); });
    const std::size_t nodes = scene.scenery_nodes.empty() ? scene.scenery.size() : scene.scenery_nodes.size();
    return nodes + static_cast<std::size_t>(with_mesh);
}

/// Names of nodes that may become bodies, for an error; at most five.
std::string names_of(const scene::Scene& scene) {
    constexpr std::size_t max_names = 5;
    std::string names;
    std::size_t count = 0;
    for (const scene::SceneryNode& node : scene.scenery_nodes) {
        if (node.parent || ++count > max_names) continue;
        names += (names.empty() ? "\"" : ", \"") + printable(node.name, 40) + "\"";
    }
    return count > max_names ? fmt::format("{} and {} more", names, count - max_names) : names;
}

Result<std::optional<std::regex>> regex_of(const std::string& text) {
    try {
        return text.empty() ? std::optional<std::regex>() : std::optional(std::regex(text));
    } catch (const std::regex_error&) {
        return Error{Status::BadArgument,
                     "--static",
                     fmt::format("found \"{}\"; expected a regular expression", printable(text, 60)),
                     {}};
    }
}

Result<scene::AutoShape> shape_of(const std::string& name) {
    if (name == "hull") return scene::AutoShape::Hull;
    if (name == "box") return scene::AutoShape::Box;
    const std::string found = fmt::format("found \"{}\"; expected hull or box", printable(name, 40));
    return Error{Status::BadArgument, "--auto-colliders", found,
                 name == "mesh" ? "Fase has no triangle-mesh colliders yet" : ""};
}

/// "" for once, " (3 times)".
std::string times(std::size_t count) { return count == 1 ? "" : fmt::format(" ({} times)", count); }

}  // namespace

Result<scene::AutoColliders> add_auto_colliders(scene::Scene& scene, const AutoColliderChoice& choice) {
    const Result<scene::AutoShape> shape = shape_of(choice.shape);
    if (!shape) return shape.error();
    const Result<std::optional<std::regex>> pattern = regex_of(choice.static_nodes);
    if (!pattern) return pattern.error();
    const std::string names = names_of(scene);
    scene::AutoColliderOptions options{*shape, {}};
    bool matched = false;
    if (*pattern) {
        options.is_static = [&](std::string_view name) {
            name = name.substr(0, max_matched);
            const bool matches = std::regex_search(name.begin(), name.end(), **pattern);
            matched = matched || matches;
            return matches;
        };
    }
    scene::AutoColliders made;
    try {
        made = scene::add_colliders(scene, options);
    } catch (const std::regex_error&) {
        return Error{
            Status::BadArgument, "--static", "found an expression that takes too long; expected a simpler one", {}};
    }
    if (made.colliders == 0)
        return Error{
            Status::BadArgument, "--auto-colliders", "found no mesh without a collider; expected at least one", {}};
    if (*pattern && !matched)
        return Error{Status::BadArgument,
                     "--static",
                     fmt::format("found no node that \"{}\" matches; expected one of {}",
                                 printable(choice.static_nodes, 60), names.empty() ? "those with a mesh" : names),
                     {}};
    return made;
}

std::string text_of(const scene::AutoColliders& made, const std::string& shape) {
    const auto count = [](std::size_t n, const std::string& one, const std::string& many) {
        return fmt::format("{} {}", n, n == 1 ? one : many);
    };
    const std::string shapes =
        shape == "box" ? count(made.colliders, "box", "boxes") : count(made.colliders, "convex hull", "convex hulls");
    return fmt::format("{} made: {}, {} static", shapes, count(made.dynamic_bodies, "dynamic body", "dynamic bodies"),
                       made.static_bodies);
}

std::optional<Error> find_nothing_physical(const scene::Scene& scene, const std::string& name) {
    const bool moves = std::any_of(scene.bodies.begin(), scene.bodies.end(),
                                   [](const scene::Body& body) { return body.def.kind != BodyKind::Static; });
    if (moves || count_colliders(scene) > 0) return std::nullopt;
    const std::size_t meshes = count_meshes(scene);
    std::string skipped;
    for (const std::string& warning : scene.warnings)
        if (skipped.empty() && warning.find("collider") != std::string::npos) skipped = " (" + warning + ")";
    return Error{Status::Unsupported, name,
                 fmt::format("nothing here has physics: {} {}, no colliders{}", meshes, meshes == 1 ? "mesh" : "meshes",
                             skipped),
                 meshes == 0 ? "add bodies with colliders (KHR_physics_rigid_bodies)"
                             : "add colliders (KHR_physics_rigid_bodies) or use --auto-colliders hull|box"};
}

std::vector<std::string> physics_warnings(const scene::Scene& scene, const scene::AutoColliders* made) {
    std::vector<std::string> warnings;
    bool is_held = false, falls = false;
    for (const scene::Body& body : scene.bodies) {
        const bool is_solid = std::any_of(body.colliders.begin(), body.colliders.end(),
                                          [](const scene::Collider& collider) { return !collider.def.sensor; });
        is_held = is_held || (is_solid && body.def.kind != BodyKind::Dynamic);
        falls = falls || (body.def.kind == BodyKind::Dynamic && body.def.gravity_scale != 0 && body.def.awake &&
                          !body.def.locks.linear_y);
    }
    const char* remedy = made != nullptr ? "name the ground with --static REGEX" : "add a static body";
    if (count_colliders(scene) == 0) {
        warnings.emplace_back("nothing has a collider: bodies pass through everything; use --auto-colliders hull|box");
    } else if (falls && !is_held && scene.gravity != Vec3{}) {
        warnings.push_back(fmt::format("nothing is static: everything falls for ever; {}", remedy));
    }
    const bool moves = std::any_of(scene.bodies.begin(), scene.bodies.end(), [](const scene::Body& body) {
        const bool is_moving = body.def.linear_velocity != Vec3{} || body.def.angular_velocity != Vec3{};
        return body.def.kind == BodyKind::Dynamic || (body.def.kind == BodyKind::Kinematic && is_moving);
    });
    if (!moves)
        warnings.push_back(fmt::format("nothing can move: no dynamic or moving kinematic body; {}",
                                       made != nullptr ? "let --static match fewer nodes" : "make a body dynamic"));
    const std::size_t skipped = made != nullptr ? made->skipped : 0, flat = made != nullptr ? made->flat : 0;
    if (skipped > 0) warnings.push_back("meshes without a volume or too far away got no collider" + times(skipped));
    warnings.insert(warnings.end(), scene.warnings.begin(), scene.warnings.end());
    if (flat > 0) warnings.push_back("flat meshes got colliders 0.1 m thick, behind their faces" + times(flat));
    return warnings;
}

}  // namespace fase::cli
