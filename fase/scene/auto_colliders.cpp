/// Builds hulls and boxes around the meshes of a scene.
#include "fase/scene/auto_colliders.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

#include "fase/core/no_index.hpp"
#include "fase/geometry/hull_builder.hpp"
#include "fase/geometry/scaled.hpp"

namespace fase::scene {
namespace {

constexpr float flat_thickness = 0.1f;  // of a collider for a flat mesh, metres
constexpr float flat_limit = 1e-3f;     // thinner meshes are flat
constexpr int max_vertices = 64;
constexpr float largest = 1e5f;     // limit of shapes
constexpr double world_size = 1e7;  // limit of positions

/// Visuals that get one collider, and the axes of its box: a point p in the box's frame lies at linear * p.
struct Part {
    std::vector<Visual> visuals;
    Mat3 linear = Mat3::identity();
};

/// A collider's shape in the frame of its part's visuals.
struct Made {
    Shape shape;
    LocalPose pose;
    bool flat = false;
};

/// The corners of the triangles of a part, and the sum of their normals times areas.
struct Surface {
    std::vector<Vec3> points;
    Vec3 normal;
};

Surface surface_of(const Scene& scene, std::span<const Visual> visuals) {
    Surface surface;
    Vec3 largest_normal;
    for (const Visual& visual : visuals) {
        const Mesh& mesh = scene.meshes[visual.mesh];
        const auto place = [&](std::uint32_t i) { return visual.linear * mesh.positions[i] + visual.position; };
        const float side = determinant(visual.linear) < 0 ? -1.0f : 1.0f;
        std::vector<bool> used(mesh.positions.size(), false);
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            const Vec3 a = place(mesh.indices[i]), b = place(mesh.indices[i + 1]), c = place(mesh.indices[i + 2]);
            const Vec3 normal = cross(b - a, c - a) * side;
            surface.normal += normal;
            if (length_squared(normal) > length_squared(largest_normal)) largest_normal = normal;
            for (std::size_t corner = i; corner < i + 3; ++corner) used[mesh.indices[corner]] = true;
        }
        for (std::uint32_t i = 0; i < used.size(); ++i)
            if (used[i]) surface.points.push_back(place(i));
    }
    // The two sides of a sheet cancel out.
    if (!(length_squared(surface.normal) > 1e-6f * length_squared(largest_normal))) surface.normal = largest_normal;
    const float size = length(surface.normal);
    surface.normal = size > 0 && std::isfinite(size) ? surface.normal * (1 / size) : Vec3{};
    return surface;
}

std::optional<Made> hull_around(const Surface& surface) {
    const HullOptions options{.max_vertices = max_vertices};
    if (Result<ConvexHull> hull = build_convex_hull(surface.points, options)) return Made{*std::move(hull), {}, false};
    if (surface.normal == Vec3{}) return std::nullopt;
    std::vector<Vec3> both = surface.points;
    for (const Vec3 point : surface.points) both.push_back(point - surface.normal * flat_thickness);
    Result<ConvexHull> plate = build_convex_hull(both, options);
    if (!plate) return std::nullopt;
    return Made{*std::move(plate), {}, true};
}

/// The bounds along the axes of `linear`. One axis may be flat: it becomes thicker, away from the faces.
std::optional<Made> box_around(const Surface& surface, const Mat3& linear) {
    const float volume = determinant(linear);
    if (!(std::abs(volume) > 1e-12f) || surface.points.empty()) return std::nullopt;
    const Mat3 inverse_linear = inverse(linear);
    Aabb bounds;
    for (const Vec3 point : surface.points) {
        const Vec3 local = inverse_linear * point;
        bounds = merge(bounds, {local, local});
    }
    Vec3 half = extent(bounds) * 0.5f, middle = (bounds.lo + bounds.hi) * 0.5f;
    int flat_axes = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const float scale = length(linear[axis]);
        if (half[axis] * 2 * scale > flat_limit) continue;
        ++flat_axes;
        half[axis] = flat_thickness / 2 / scale;
        middle[axis] -= dot(surface.normal, linear[axis]) < 0 ? -half[axis] : half[axis];
    }
    if (flat_axes > 1) return std::nullopt;
    Result<RotatedShape> box = transformed(Box{half}, linear);
    if (!box) return std::nullopt;
    return Made{std::move(box->shape), {linear * middle, box->rotation}, flat_axes == 1};
}

/// Builds the colliders; equal meshes under equal maps share a shape.
class ColliderMaker {
public:
    ColliderMaker(Scene& scene, AutoShape shape, AutoColliders& done) : scene_(scene), shape_(shape), done_(done) {}

    /// Adds a collider around the part to a body; false: it has no volume.
    bool add(const Part& part, Body& body) {
        const Vec3 origin = part.visuals[0].position;
        const auto [entry, is_new] = made_.try_emplace(key_of(part, origin));
        Entry& made = entry->second;
        if (is_new) make(part, origin, made);
        if (made.shape == no_index) return skip();
        Collider collider;
        collider.shape = made.shape;
        collider.def.pose = {made.pose.position + origin, made.pose.rotation};
        body.colliders.push_back(collider);
        ++done_.colliders;
        done_.flat += made.flat ? 1 : 0;
        return true;
    }

    /// Counts a part that gets no collider.
    bool skip() {
        ++done_.skipped;
        return false;
    }

private:
    struct Entry {
        std::uint32_t shape = no_index;
        LocalPose pose;
        bool flat = false;
    };
    /// Per visual: its mesh, and its map relative to the first one; then the axes.
    using Key = std::pair<std::vector<std::uint32_t>, std::vector<float>>;

    static Key key_of(const Part& part, Vec3 origin) {
        Key key;
        const auto add = [&](Vec3 v) { key.second.insert(key.second.end(), {v.x, v.y, v.z}); };
        const auto add_matrix = [&](const Mat3& m) {
            for (const Vec3 column : {m.x, m.y, m.z}) add(column);
        };
        for (const Visual& visual : part.visuals) {
            key.first.push_back(visual.mesh);
            add_matrix(visual.linear);
            add(visual.position - origin);
        }
        add_matrix(part.linear);
        return key;
    }

    void make(const Part& part, Vec3 origin, Entry& entry) {
        std::vector<Visual> visuals = part.visuals;
        for (Visual& visual : visuals) visual.position -= origin;
        const Surface surface = surface_of(scene_, visuals);
        const bool in_range = std::all_of(surface.points.begin(), surface.points.end(), [](Vec3 p) {
            return std::abs(p.x) < largest && std::abs(p.y) < largest && std::abs(p.z) < largest;
        });
        if (!in_range) return;
        std::optional<Made> made = shape_ == AutoShape::Hull ? hull_around(surface) : box_around(surface, part.linear);
        if (!made || !check(made->shape)) return;
        entry = {static_cast<std::uint32_t>(scene_.shapes.size()), made->pose, made->flat};
        scene_.shapes.push_back(std::move(made->shape));
    }

    Scene& scene_;
    AutoShape shape_;
    AutoColliders& done_;
    std::map<Key, Entry> made_;
};

/// Replaces a mass that was given without colliders by one of the same weight and the form of the collider.
void shape_mass(const Scene& scene, Body& body) {
    if (!body.def.mass) return;
    const Collider& collider = body.colliders[0];
    MassProperties mass = transformed(mass_properties(scene.shapes[collider.shape], 1000), collider.def.pose);
    if (!(mass.mass > 0)) return;
    const float share = body.def.mass->mass / mass.mass;
    mass.mass = body.def.mass->mass;
    mass.inertia = mass.inertia * share;
    if (check(mass)) body.def.mass = mass;
}

void complete_bodies(Scene& scene, ColliderMaker& maker) {
    for (Body& body : scene.bodies) {
        if (!body.colliders.empty() || body.visuals.empty()) continue;
        if (maker.add({body.visuals, Mat3::identity()}, body)) shape_mass(scene, body);
    }
}

/// The nodes of the scenery; without a list of them, each visual is a node.
std::vector<SceneryNode> nodes_of(const Scene& scene) {
    if (!scene.scenery_nodes.empty()) return scene.scenery_nodes;
    std::vector<SceneryNode> nodes;
    for (std::uint32_t i = 0; i < scene.scenery.size(); ++i)
        nodes.push_back({scene.meshes[scene.scenery[i].mesh].name, std::nullopt, i, 1});
    return nodes;
}

/// Adds a collider for the node's visuals, and the visuals, whose positions become relative to the body.
bool add_node(const Scene& scene, const SceneryNode& node, ColliderMaker& maker, Body& body) {
    Part part;
    for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
        Visual visual = scene.scenery[i];
        visual.position = to_float(to_double(visual.position) - body.def.position);
        part.visuals.push_back(visual);
    }
    body.visuals.insert(body.visuals.end(), part.visuals.begin(), part.visuals.end());
    if (part.visuals.empty()) return false;
    const Vec3d at = body.def.position;
    if (!(std::max({std::abs(at.x), std::abs(at.y), std::abs(at.z)}) <= world_size)) return maker.skip();
    part.linear = part.visuals[0].linear;
    return maker.add(part, body);
}

}  // namespace

AutoColliders add_colliders(Scene& scene, const AutoColliderOptions& options) {
    AutoColliders done;
    ColliderMaker maker(scene, options.shape, done);
    complete_bodies(scene, maker);
    const std::vector<SceneryNode> nodes = nodes_of(scene);
    std::vector<std::uint32_t> roots(nodes.size());
    std::map<std::uint32_t, Body> bodies;               // by root
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {  // parents come before their children
        roots[i] = nodes[i].parent ? roots[*nodes[i].parent] : i;
        Body& body = bodies[roots[i]];
        if (roots[i] == i) {
            body.name = nodes[i].name;
            const bool fixed = options.is_static && options.is_static(body.name);
            body.def.kind = fixed ? BodyKind::Static : BodyKind::Dynamic;
            if (nodes[i].count > 0) body.def.position = to_double(scene.scenery[nodes[i].first].position);
        }
        add_node(scene, nodes[i], maker, body);
    }
    std::vector<Visual> rest;
    std::vector<SceneryNode> rest_nodes;
    std::vector<std::uint32_t> new_numbers(nodes.size(), no_index);
    for (std::uint32_t i = 0; i < nodes.size(); ++i) {
        if (!bodies[roots[i]].colliders.empty()) continue;
        SceneryNode node = nodes[i];
        if (node.parent) node.parent = new_numbers[*node.parent];
        new_numbers[i] = static_cast<std::uint32_t>(rest_nodes.size());
        node.first = static_cast<std::uint32_t>(rest.size());
        for (std::uint32_t v = 0; v < node.count; ++v) rest.push_back(scene.scenery[nodes[i].first + v]);
        rest_nodes.push_back(node);
    }
    for (auto& [root, body] : bodies) {
        if (body.colliders.empty()) continue;
        ++(body.def.kind == BodyKind::Static ? done.static_bodies : done.dynamic_bodies);
        scene.bodies.push_back(std::move(body));
    }
    scene.scenery = std::move(rest);
    scene.scenery_nodes = std::move(rest_nodes);
    return done;
}

}  // namespace fase::scene
