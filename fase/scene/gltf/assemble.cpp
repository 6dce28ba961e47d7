/// Visits the nodes of the scene, parents first, and creates bodies, colliders and visuals.
#include "fase/scene/gltf/assemble.hpp"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <map>
#include <tuple>

#include "fase/core/no_index.hpp"
#include "fase/geometry/hull_builder.hpp"
#include "fase/geometry/scaled.hpp"
#include "fase/scene/gltf/masses.hpp"
#include "fase/scene/gltf/physics.hpp"

namespace fase::scene::gltf {
namespace {

/// Whether an extension affects only the appearance: a file that requires it can be read without it.
bool affects_only_appearance(std::string_view extension) {
    for (const std::string_view prefix : {"KHR_materials_", "KHR_texture_", "KHR_lights_", "EXT_texture_",
                                          "EXT_lights_", "MSFT_texture_", "KHR_animation_"}) {
        if (extension.starts_with(prefix)) return true;
    }
    return false;
}

bool is_supported(std::string_view extension) {
    for (const std::string_view name : {"KHR_implicit_shapes", "KHR_physics_rigid_bodies", "KHR_collision_shapes",
                                        "KHR_rigid_bodies", "OMI_physics_shape", "OMI_physics_body", "OMI_collider",
                                        "OMI_physics_gravity", "OMI_physics_joint", "KHR_mesh_quantization"}) {
        if (extension == name) return true;
    }
    return false;
}

/// Replaces elements that are 0, 1 or -1 except for rounding by the exact number, so that shapes of unscaled nodes stay
/// unchanged.
Mat3d snapped(Mat3d m) {
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row) {
            const double nearest = std::round(m[column][row]);
            if (std::abs(nearest) <= 1 && std::abs(m[column][row] - nearest) < 1e-12) m[column][row] = nearest;
        }
    }
    return m;
}

bool is_rotation(const Mat3d& m) {
    const Mat3d product = transpose(m) * m;
    double max_error = 0;
    for (int column = 0; column < 3; ++column) {
        for (int row = 0; row < 3; ++row)
            max_error = std::max(max_error, std::abs(product[column][row] - (row == column ? 1 : 0)));
    }
    return max_error < 1e-6 && determinant(m) > 0;
}

std::optional<JsonValue> fase_extras(JsonValue json) {
    const std::optional<JsonValue> extras = json.find("extras");
    return extras && extras->is(JsonKind::Object) && extras->find("fase") ? member(*extras, "fase", JsonKind::Object)
                                                                          : std::nullopt;
}

std::uint64_t user_number(JsonValue extras, std::string_view key) {
    const std::optional<std::string_view> text = text_in(extras, key);
    if (!text) return 0;
    std::uint64_t number = 0;
    const auto [end, problem] = std::from_chars(text->data(), text->data() + text->size(), number);
    if (problem != std::errc() || end != text->data() + text->size())
        refuse(*extras.find(key), fmt::format("found {}; expected a whole number as text", quoted_short(*text)));
    return number;
}

class Assembler {
public:
    explicit Assembler(Document& document)
        : document_(document),
          physics_(document, warnings_),
          owners_(document.nodes().size(), no_index),
          scenery_nodes_(document.nodes().size(), no_index) {}

    Scene run() {
        read_head();
        for (const std::uint32_t root : document_.scene_roots()) {
            document_.walk(root, document_.local(root),
                           [this](std::uint32_t node, const Placement& place) { visit(node, place); });
        }
        for (std::size_t i = 0; i < frames_.size(); ++i) {
            if (frames_[i].motion)
                complete_mass(scene_, scene_.bodies[i], *frames_[i].motion, frames_[i].node_linear, warnings_);
        }
        resolve_joints();
        scene_.warnings = warnings_.texts();
        return std::move(scene_);
    }

private:
    /// Data of a body that is only needed while reading.
    struct Frame {
        Vec3d position;
        Quatd rotation;
        Mat3d node_linear = Mat3d::identity();  ///< maps vectors from the node's frame to the body's
        std::optional<Motion> motion;
    };
    struct PendingJoint {
        std::uint32_t node;
        JointUse use;
    };
    using MapKey = std::array<float, 9>;

    void read_head() {
        const JsonValue root = document_.root();
        const auto names = [&](std::string_view key) {
            std::vector<std::string> all;
            const std::optional<JsonValue> list = member(root, key, JsonKind::Array);
            if (!list) return all;
            list->for_each_element([&](JsonValue name) {
                if (!name.is(JsonKind::String))
                    refuse(name, fmt::format("found {}; expected a text", name_of(name.kind())));
                all.emplace_back(name.string());
            });
            return all;
        };
        scene_.name = document_.scene_name();
        scene_.extensions_used = names("extensionsUsed");
        scene_.extensions_required = names("extensionsRequired");
        for (const std::string& name : scene_.extensions_required) {
            if (is_supported(name) || affects_only_appearance(name)) continue;
            throw Refusal{{Status::Unsupported, "/extensionsRequired",
                           fmt::format("found the required extension {}; expected a supported one", quoted_short(name)),
                           "save the file without it"}};
        }
        for (const std::string& name : scene_.extensions_used) {
            if (is_supported(name)) continue;
            warnings_.add_named("extension {} is not supported", quoted_short(name),
                                affects_only_appearance(name) ? Harm::Unseen : Harm::Unknown);
        }
        for (const auto& [key, text] :
             {std::pair{"animations", "animations are not played"}, {"textures", "textures are not drawn"}}) {
            const std::optional<JsonValue> list = member(root, key, JsonKind::Array);
            for (std::size_t i = 0; list && i < list->size(); ++i) warnings_.add(text, Harm::Unseen);
        }
        if (const std::optional<Vec3> gravity = physics_.gravity()) scene_.gravity = *gravity;
        if (const std::optional<JsonValue> own = fase_extras(root)) {
            if (const auto step = optional_number(*own, "timeStep"))
                scene_.settings.time_step = static_cast<float>(*step);
            if (const auto steps = whole_in(*own, "subSteps", 1000))
                scene_.settings.sub_steps = static_cast<int>(*steps);
            if (own->find("sleep")) scene_.settings.sleep = flag_in(*own, "sleep", true);
            if (const auto gravity = vec3_in(*own, "gravity")) scene_.gravity = to_float(*gravity);
        }
    }

    void visit(std::uint32_t node, const Placement& place) {
        const JsonValue json = document_.nodes()[node];
        const std::optional<JsonValue> own = fase_extras(json);
        const std::optional<std::uint32_t> parent = document_.parent(node);
        std::uint32_t owner = parent ? owners_[*parent] : no_index;
        std::optional<Motion> motion = physics_.motion(node);
        const bool group = own && flag_in(*own, "static", false);
        if (motion || group) owner = add_body(node, place, motion, own);
        const std::vector<ColliderUse> uses = physics_.colliders(node);
        for (const ColliderUse& use : uses) {
            // Without a body above it, a collider becomes a separate static body, which its descendants do not belong
            // to.
            std::uint32_t body = owner;
            if (body == no_index)
                body = static_node_ == node ? static_cast<std::uint32_t>(scene_.bodies.size() - 1)
                                            : add_body(node, place, std::nullopt, std::nullopt);
            if (owner == no_index) static_node_ = node;
            add_collider(node, place, body, use, own);
        }
        if (static_node_ == node && scene_.bodies.back().colliders.empty()) {  // all its colliders were skipped
            scene_.bodies.pop_back();
            frames_.pop_back();
            static_node_ = no_index;
        }
        owners_[node] = owner;
        if (const auto mesh = index_in(json, "mesh", document_.meshes().size(), "meshes")) {
            const std::uint32_t body = owner != no_index      ? owner
                                       : static_node_ == node ? static_cast<std::uint32_t>(scene_.bodies.size() - 1)
                                                              : no_index;
            const auto first = static_cast<std::uint32_t>(scene_.scenery.size());
            add_visuals(*mesh, place, body);
            if (scene_.scenery.size() > first) add_scenery_node(node, first);
        }
        if (json.find("skin")) warnings_.add("skins are not applied", Harm::Unseen);
        if (auto joint = physics_.joint(node)) joints_.push_back({node, *joint});
        if (const auto camera = json.find("camera")) read_camera(*camera, place, own);
    }

    std::uint32_t add_body(std::uint32_t node, const Placement& place, const std::optional<Motion>& motion,
                           std::optional<JsonValue> own) {
        const JsonValue json = document_.nodes()[node];
        if (std::max({std::abs(place.position.x), std::abs(place.position.y), std::abs(place.position.z)}) > 1e7) {
            refuse(json, fmt::format("found the position ({:g}, {:g}, {:g}); expected it within 1e7 m of the origin",
                                     place.position.x, place.position.y, place.position.z));
        }
        Body body;
        Frame frame{place.position, place.rotation, Mat3d::identity(), motion};
        body.name = document_.name(node);
        body.def.kind = motion ? motion->kind : BodyKind::Static;
        body.def.position = place.position;
        body.def.rotation = to_float(place.rotation);
        frame.node_linear = snapped(transpose(to_matrix(normalized(place.rotation))) * place.linear);
        if (motion && motion->kind != BodyKind::Static) {
            const auto speed = [&](Vec3d v, std::string_view key) {
                if (length(v) > 1e9)
                    refuse(*motion->json.find(key),
                           fmt::format("found a speed of {:g}; expected at most 1e9", length(v)));
                return to_float(rotate(normalized(place.rotation), v));
            };
            body.def.linear_velocity = speed(motion->linear, "linearVelocity");
            body.def.angular_velocity = speed(motion->angular, "angularVelocity");
            body.def.gravity_scale = static_cast<float>(motion->gravity);
        }
        if (own) read_body_extras(*own, body.def);
        rest_if_asleep(body.def);
        scene_.bodies.push_back(std::move(body));
        frames_.push_back(std::move(frame));
        return static_cast<std::uint32_t>(scene_.bodies.size() - 1);
    }

    /// A world refuses a sleeping body that has a velocity; a file may have both.
    void rest_if_asleep(BodyDef& def) {
        if (def.awake || (def.linear_velocity == Vec3{} && def.angular_velocity == Vec3{})) return;
        if (def.kind == BodyKind::Kinematic) {
            def.awake = true;
            return;
        }
        def.linear_velocity = def.angular_velocity = {};
        warnings_.add("velocities of sleeping bodies are skipped", Harm::Changed);
    }

    static void read_body_extras(JsonValue own, BodyDef& def) {
        def.linear_damping = static_cast<float>(number_in(own, "linearDamping", 0));
        def.angular_damping = static_cast<float>(number_in(own, "angularDamping", 0));
        def.can_sleep = flag_in(own, "canSleep", true);
        def.awake = flag_in(own, "awake", true);
        def.user = user_number(own, "user");
        const std::uint64_t locks = whole_in(own, "locks", 63).value_or(0);
        def.locks = {(locks & 1) != 0, (locks & 2) != 0,  (locks & 4) != 0,
                     (locks & 8) != 0, (locks & 16) != 0, (locks & 32) != 0};
    }

    void add_collider(std::uint32_t node, const Placement& place, std::uint32_t body_index, const ColliderUse& use,
                      std::optional<JsonValue> own) {
        const JsonValue json = document_.nodes()[node];
        const Frame& frame = frames_[body_index];
        const Mat3d body_from_world = transpose(to_matrix(normalized(frame.rotation)));
        const Mat3d linear = snapped(body_from_world * place.linear);
        const Vec3d position =
            body_from_world * (place.position - frame.position) + linear * to_double(use.source->offset);
        Collider collider;
        collider.def.pose.position = checked_float(json, position);
        if (!place_shape(json, use, linear, collider)) return;
        const Shape& shape = scene_.shapes[collider.shape];
        if (!is_solid(shape) && !use.sensor && scene_.bodies[body_index].def.kind == BodyKind::Dynamic) {
            warnings_.add(is_mesh(shape) ? "triangle meshes on dynamic bodies are skipped: they have no mass"
                                         : "infinite planes on moving bodies are skipped",
                          Harm::Missing);
            return;
        }
        collider.name = document_.name(node) == scene_.bodies[body_index].name ? std::string() : document_.name(node);
        collider.def.material = use.material;
        collider.def.filter = use.filter;
        collider.def.sensor = use.sensor;
        if (own) {
            collider.def.density = static_cast<float>(number_in(*own, "density", collider.def.density));
            if (const auto group = optional_number(*own, "group"); group && std::abs(*group) < 2147483648.0)
                collider.def.filter.group = static_cast<std::int32_t>(*group);
            collider.def.user = user_number(*own, "colliderUser");
        }
        scene_.bodies[body_index].colliders.push_back(std::move(collider));
    }

    static Vec3 checked_float(JsonValue json, Vec3d v) {
        if (!(std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)}) < 1e9))
            refuse(json, "found a node more than 1e9 m from the origin; expected it nearer");
        return to_float(v);
    }

    /// Sets the collider's shape, transformed by `linear`, and the rotation of its frame. False: skipped, with a
    /// warning.
    bool place_shape(JsonValue node, const ColliderUse& use, const Mat3d& linear, Collider& collider) {
        const ShapeSource& source = *use.source;
        if (!source.shape && !source.mesh && !source.node) {
            warnings_.add("colliders without a supported shape are skipped", Harm::Missing);
            return false;
        }
        if (!(std::abs(determinant(linear)) > 1e-18)) {
            warnings_.add("colliders of nodes with a zero scale are skipped", Harm::Missing);
            return false;
        }
        const bool rigid = is_rotation(linear);
        if (rigid) collider.def.pose.rotation = linear == Mat3d::identity() ? Quat{} : to_float(to_quat(linear));
        const Mat3 map = rigid ? Mat3::identity() : to_float(linear);
        const MapKey key{map.x.x, map.x.y, map.x.z, map.y.x, map.y.y, map.y.z, map.z.x, map.z.y, map.z.z};
        const auto [entry, inserted] = shapes_.try_emplace({&source, key}, no_index, Quat{});
        if (inserted) {
            if (source.shape)
                make_scaled(node, *source.shape, rigid, map, entry->second);
            else if (source.convex)
                make_hull(source, map, entry->second);
            else
                make_mesh(source, map, entry->second);
        }
        collider.shape = entry->second.first;
        if (!rigid) collider.def.pose.rotation = entry->second.second;
        return collider.shape != no_index;
    }

    std::uint32_t add_shape(Shape shape) {
        scene_.shapes.push_back(std::move(shape));
        return static_cast<std::uint32_t>(scene_.shapes.size() - 1);
    }

    void make_scaled(JsonValue node, const Shape& shape, bool rigid, const Mat3& map,
                     std::pair<std::uint32_t, Quat>& out) {
        if (rigid) {
            out.first = add_shape(shape);
            return;
        }
        Result<RotatedShape> scaled = transformed(shape, map);
        if (!scaled) refuse(node, scaled.error().problem, scaled.error().remedy);
        document_.spend(node, scaled->shape);
        out = {add_shape(std::move(scaled->shape)), scaled->rotation};
    }

    /// Calls f(mesh, placement) for each mesh of a collider.
    template <class F> void for_each_mesh(const ShapeSource& source, const F& f) {
        if (source.mesh) f(*source.mesh, Placement{});
        if (!source.node) return;
        document_.walk(*source.node, {}, [&](std::uint32_t node, const Placement& place) {
            if (const auto mesh = index_in(document_.nodes()[node], "mesh", document_.meshes().size(), "meshes"))
                f(*mesh, place);
        });
    }

    void make_hull(const ShapeSource& source, const Mat3& map, std::pair<std::uint32_t, Quat>& out) {
        std::vector<Vec3> points;
        for_each_mesh(source, [&](std::uint32_t mesh, const Placement& place) {
            for (const Primitive& primitive : document_.primitives(mesh)) {
                if (primitive.mode < 4) continue;
                for (const Vec3 p : document_.positions(primitive))
                    points.push_back(map * checked_float(source.json, place.linear * to_double(p) + place.position));
            }
        });
        Result<ConvexHull> hull = build_convex_hull(points);
        if (!hull) {
            warnings_.add_named("a convex collider is skipped: {}", hull.error().problem, Harm::Missing);
            return;
        }
        out.first = add_shape(*std::move(hull));
        document_.spend(source.json, scene_.shapes[out.first]);
    }

    /// Builds the triangle mesh of a collider: two-sided, because files do not say which side is the ground.
    void make_mesh(const ShapeSource& source, const Mat3& map, std::pair<std::uint32_t, Quat>& out) {
        std::vector<Vec3> positions;
        std::vector<std::uint32_t> indices;
        for_each_mesh(source, [&](std::uint32_t mesh, const Placement& place) {
            const bool mirrored = determinant(place.linear) * double(determinant(map)) < 0;
            for (const Primitive& primitive : document_.primitives(mesh)) {
                if (primitive.mode < 4) continue;
                const auto first = static_cast<std::uint32_t>(positions.size());
                const std::vector<Vec3> own = document_.positions(primitive);
                for (const Vec3 p : own)
                    positions.push_back(map * checked_float(source.json, place.linear * to_double(p) + place.position));
                const std::vector<std::uint32_t> triangles = document_.triangles(primitive, own.size());
                for (std::size_t i = 0; i + 2 < triangles.size(); i += 3)
                    for (const std::size_t k : {0, mirrored ? 2 : 1, mirrored ? 1 : 2})
                        indices.push_back(first + triangles[i + k]);
            }
        });
        auto data = CollisionMesh::build(positions, indices, {.two_sided = true});
        if (!data) {
            warnings_.add_named("a triangle-mesh collider is skipped: {}", data.error().problem, Harm::Missing);
            return;
        }
        const MeshReport& report = (*data)->report();
        if (report.degenerate + report.duplicate > 0)
            warnings_.add("triangles without an area, and duplicates, of collision meshes are left out");
        out.first = add_shape(fase::Mesh{*std::move(data)});
        document_.spend(source.json, scene_.shapes[out.first]);
    }

    void add_visuals(std::uint32_t mesh, const Placement& place, std::uint32_t body) {
        Visual visual;
        Mat3d linear = snapped(place.linear);
        Vec3d position = place.position;
        if (body != no_index) {
            const Mat3d body_from_world = transpose(to_matrix(normalized(frames_[body].rotation)));
            linear = snapped(body_from_world * place.linear);
            position = body_from_world * (place.position - frames_[body].position);
        }
        visual.position = checked_float(document_.meshes()[mesh], position);
        visual.linear = to_float(linear);
        for (const Primitive& primitive : document_.primitives(mesh)) {
            if (primitive.mode < 4) {
                warnings_.add("points and lines are not drawn", Harm::Unseen);
                continue;
            }
            visual.mesh = mesh_of(primitive);
            visual.colour = document_.colour(primitive.material);
            (body == no_index ? scene_.scenery : scene_.bodies[body].visuals).push_back(visual);
        }
    }

    std::uint32_t mesh_of(const Primitive& primitive) {
        const auto [entry, inserted] =
            meshes_.try_emplace({primitive.positions, primitive.indices.value_or(no_index), primitive.mode}, no_index);
        if (!inserted) return entry->second;
        Mesh mesh;
        mesh.name = std::string(text_in(document_.meshes()[primitive.mesh], "name").value_or(""));
        mesh.positions = document_.positions(primitive);
        mesh.indices = document_.triangles(primitive, mesh.positions.size());
        scene_.meshes.push_back(std::move(mesh));
        entry->second = static_cast<std::uint32_t>(scene_.meshes.size() - 1);
        return entry->second;
    }

    /// Notes that the scenery from `first` on belongs to the node.
    void add_scenery_node(std::uint32_t node, std::uint32_t first) {
        std::optional<std::uint32_t> above = document_.parent(node);
        while (above && scenery_nodes_[*above] == no_index) above = document_.parent(*above);
        scenery_nodes_[node] = static_cast<std::uint32_t>(scene_.scenery_nodes.size());
        scene_.scenery_nodes.push_back({document_.name(node),
                                        above ? std::optional(scenery_nodes_[*above]) : std::nullopt, first,
                                        static_cast<std::uint32_t>(scene_.scenery.size()) - first});
    }

    void read_camera(JsonValue index, const Placement& place, std::optional<JsonValue> own) {
        const std::optional<JsonValue> cameras = member(document_.root(), "cameras", JsonKind::Array);
        const std::uint32_t camera_index = index_of(index, cameras ? cameras->size() : 0, "cameras");
        if (scene_.camera) return;
        std::uint32_t number = 0;
        cameras->for_each_element([&](JsonValue camera) {
            if (number++ != camera_index) return;
            const std::optional<JsonValue> perspective = member(camera, "perspective", JsonKind::Object);
            if (!perspective) return;
            const double angle = number_in(*perspective, "yfov", 0.8);
            if (!(angle > 0 && angle < 3.14)) return;
            const Vec3d target =
                own ? vec3_in(*own, "target").value_or(Vec3d{}) : place.position - normalized(place.linear.z) * 10.0;
            scene_.camera =
                Camera{checked_float(camera, place.position), checked_float(camera, target), static_cast<float>(angle)};
        });
    }

    void resolve_joints() {
        for (const PendingJoint& pending : joints_) {
            const auto body = [&](std::uint32_t node) -> std::optional<std::uint32_t> {
                for (std::optional<std::uint32_t> i = node; i; i = document_.parent(*i)) {
                    if (owners_[*i] != no_index) return owners_[*i];
                }
                return std::nullopt;
            };
            scene_.joints.push_back({document_.name(pending.node), pending.use.type, body(pending.node),
                                     body(pending.use.other), pending.use.collide});
        }
    }

    Document& document_;
    Warnings warnings_;
    Physics physics_;
    Scene scene_;
    std::vector<Frame> frames_;                 ///< parallel to scene_.bodies
    std::vector<std::uint32_t> owners_;         ///< by node: the body that moves it
    std::vector<std::uint32_t> scenery_nodes_;  ///< by node: its index in Scene::scenery_nodes
    std::uint32_t static_node_ = no_index;      ///< the node for whose colliders the last static body was created
    std::vector<PendingJoint> joints_;
    std::map<std::pair<const ShapeSource*, MapKey>, std::pair<std::uint32_t, Quat>> shapes_;
    std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint64_t>, std::uint32_t> meshes_;
};

}  // namespace

Scene assemble(Document& document) { return Assembler(document).run(); }

}  // namespace fase::scene::gltf
