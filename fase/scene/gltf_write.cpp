/// Lays a scene out as nodes, meshes and physics resources.
#include "fase/scene/gltf_write.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <map>
#include <new>
#include <tuple>

#include "fase/geometry/mass.hpp"
#include "fase/geometry/mesh.hpp"
#include "fase/scene/files.hpp"
#include "fase/scene/gltf/json_text.hpp"

namespace fase::scene {
namespace {

using gltf::JsonText;

constexpr std::uint32_t none = 0xffffffff;

/// The number of each distinct thing, in the order they first came.
template <class Key> class Numbering {
public:
    std::uint32_t of(const Key& key) {
        const auto [at, fresh] = numbers_.try_emplace(key, static_cast<std::uint32_t>(list_.size()));
        if (fresh) list_.push_back(key);
        return at->second;
    }
    [[nodiscard]] const std::vector<Key>& list() const { return list_; }

private:
    std::map<Key, std::uint32_t> numbers_;
    std::vector<Key> list_;
};

using ColourKey = std::tuple<float, float, float, float>;
using MaterialKey = std::tuple<float, float, CombineMode, CombineMode>;
using FilterKey = std::tuple<std::uint64_t, std::uint64_t>;
using PictureKey = std::pair<std::uint32_t, std::uint32_t>;  ///< mesh and colour

bool is_default(const Material& m) { return m == Material{}; }

/// A body's inertia as KHR wants it.
void write_mass(JsonText& out, const MassProperties& mass) {
    const PrincipalInertia axes = principal(mass.inertia);
    out.key("mass")
        .number(mass.mass)
        .key("centerOfMass")
        .vector(mass.centre)
        .key("inertiaDiagonal")
        .vector(axes.moments);
    if (!(axes.axes == Quat{})) out.key("inertiaOrientation").rotation(axes.axes);
}

class Writer {
public:
    explicit Writer(const Scene& scene) : scene_(scene) {}

    Result<std::string> run(GltfForm form) {
        if (auto checked = check_indices(); !checked) return checked.error();
        number_hull_nodes();
        write_nodes();
        write_meshes();
        JsonText out;
        write_document(out, form);
        if (!out.all_finite() || !nodes_.all_finite())
            return Error{Status::BadArgument, "scene", "found a number that is not finite, need finite numbers", {}};
        return form == GltfForm::Text ? out.str() : in_container(out.str());
    }

private:
    Result<void> check_indices() const {
        const auto bad = [](std::string where, std::size_t found, std::size_t size) {
            return Error{Status::OutOfRange,
                         std::move(where),
                         fmt::format("found index {}, need one below {}", found, size),
                         {}};
        };
        const auto check = [&](const Visual& visual) { return visual.mesh < scene_.meshes.size(); };
        for (std::size_t i = 0; i < scene_.bodies.size(); ++i) {
            for (const Collider& collider : scene_.bodies[i].colliders) {
                if (collider.shape >= scene_.shapes.size())
                    return bad(fmt::format("bodies[{}].colliders", i), collider.shape, scene_.shapes.size());
            }
            for (const Visual& visual : scene_.bodies[i].visuals) {
                if (!check(visual)) return bad(fmt::format("bodies[{}].visuals", i), visual.mesh, scene_.meshes.size());
            }
        }
        for (const Visual& visual : scene_.scenery) {
            if (!check(visual)) return bad("scenery", visual.mesh, scene_.meshes.size());
        }
        for (const Mesh& mesh : scene_.meshes) {
            for (const std::uint32_t index : mesh.indices) {
                if (index >= mesh.positions.size()) return bad("meshes", index, mesh.positions.size());
            }
        }
        return {};
    }

    // --- nodes
    // -----------------------------------------------------------------------------------------------------------------

    /// Begins a node and returns its number; roots are gathered, children not.
    std::uint32_t begin_node(std::string_view name, bool root) {
        if (root) roots_.push_back(node_count_);
        nodes_.open('{');
        if (!name.empty()) nodes_.key("name").text(name);
        return node_count_++;
    }

    void write_nodes() {
        nodes_.open('[');
        for (const Body& body : scene_.bodies) write_body(body);
        for (const Visual& visual : scene_.scenery) {
            begin_node("", true);
            write_visual(visual);
            nodes_.close('}');
        }
        if (scene_.camera) write_camera(*scene_.camera);
        for (std::uint32_t i = 0; i < scene_.shapes.size(); ++i) {
            // A hull is the mesh of a node that stands outside the scene.
            if (const auto at = hull_nodes_.find(i); at != hull_nodes_.end()) {
                begin_node("", false);
                nodes_.key("mesh").number(picture_count() +
                                          static_cast<std::uint32_t>(std::distance(hull_nodes_.begin(), at)));
                nodes_.close('}');
            }
        }
        nodes_.close(']');
    }

    /// Shapes whose nodes come after all others: their numbers are known before the nodes are written.
    void number_hull_nodes() {
        std::uint32_t count = scene_.camera ? 1 : 0;
        count += static_cast<std::uint32_t>(scene_.scenery.size());
        for (const Body& body : scene_.bodies) {
            count += 1 + static_cast<std::uint32_t>(body.visuals.size() - (has_own_visual(body) ? 1 : 0)) +
                     static_cast<std::uint32_t>(body.colliders.size() - (has_own_collider(body) ? 1 : 0));
        }
        for (std::uint32_t i = 0; i < scene_.shapes.size(); ++i) {
            if (std::holds_alternative<ConvexHull>(scene_.shapes[i])) hull_nodes_.emplace(i, count++);
        }
        for (const Body& body : scene_.bodies) {
            for (const Visual& visual : body.visuals) picture_of(visual);
        }
        for (const Visual& visual : scene_.scenery) picture_of(visual);
    }

    std::uint32_t picture_of(const Visual& visual) {
        const Colour c = visual.colour;
        return pictures_.of({visual.mesh, colours_.of({c.red, c.green, c.blue, c.alpha})});
    }
    [[nodiscard]] std::uint32_t picture_count() const { return static_cast<std::uint32_t>(pictures_.list().size()); }

    /// The first collider can stand on the body's node itself when it lies in the body's frame.
    static bool has_own_collider(const Body& body) {
        return !body.colliders.empty() && body.colliders[0].def.pose == LocalPose{} && body.colliders[0].name.empty();
    }
    static bool has_own_visual(const Body& body) {
        return !body.visuals.empty() && body.visuals[0].position == Vec3{} &&
               body.visuals[0].linear == Mat3::identity();
    }

    void write_body(const Body& body) {
        const BodyDef& def = body.def;
        const bool own_collider = has_own_collider(body), own_visual = has_own_visual(body);
        const std::uint32_t node = begin_node(body.name, true);
        if (!(def.position == Vec3d{})) nodes_.key("translation").vector(def.position);
        if (!(def.rotation == Quat{})) nodes_.key("rotation").rotation(def.rotation);
        if (own_visual) nodes_.key("mesh").number(picture_of(body.visuals[0]));
        const auto parts = static_cast<std::uint32_t>(body.colliders.size() + body.visuals.size()) -
                           (own_collider ? 1 : 0) - (own_visual ? 1 : 0);
        if (parts > 0) {
            nodes_.key("children").open('[');
            for (std::uint32_t i = 1; i <= parts; ++i) nodes_.number(node + i);
            nodes_.close(']');
        }
        const bool moves = def.kind != BodyKind::Static;
        if (moves || own_collider) {
            nodes_.key("extensions").open('{').key("KHR_physics_rigid_bodies").open('{');
            if (moves) write_motion(body);
            if (own_collider) write_collider(body.colliders[0]);
            nodes_.close('}').close('}');
        }
        write_body_extras(body, own_collider, !moves && (parts > 0 || !own_collider));
        nodes_.close('}');
        for (std::size_t i = own_collider ? 1 : 0; i < body.colliders.size(); ++i)
            write_collider_node(body, body.colliders[i]);
        for (std::size_t i = own_visual ? 1 : 0; i < body.visuals.size(); ++i) {
            begin_node("", false);
            write_visual(body.visuals[i]);
            nodes_.close('}');
        }
    }

    void write_motion(const Body& body) {
        const BodyDef& def = body.def;
        nodes_.key("motion").open('{');
        if (def.kind == BodyKind::Kinematic) nodes_.key("isKinematic").flag(true);
        bool by_density = false;
        if (def.kind == BodyKind::Dynamic) {
            if (def.mass)
                write_mass(nodes_, *def.mass);
            else {
                std::vector<MassProperties> parts;
                for (const Collider& c : body.colliders) {
                    if (!c.def.sensor)
                        parts.push_back(moved(mass_properties(scene_.shapes[c.shape], c.def.density), c.def.pose));
                }
                const MassProperties all = combined(parts);
                by_density = all.mass > 0;
                if (by_density) nodes_.key("mass").number(all.mass);
            }
        }
        // In the node's own frame, and in double: turned back it rounds to the same floats.
        const Quatd rotation = normalized(to_double(def.rotation));
        const auto velocity = [&](std::string_view key, Vec3 v) {
            if (v == Vec3{}) return;
            nodes_.key(key).vector(def.rotation == Quat{} ? to_double(v) : rotate_back(rotation, to_double(v)));
        };
        velocity("linearVelocity", def.linear_velocity);
        velocity("angularVelocity", def.angular_velocity);
        if (def.gravity_scale != 1) nodes_.key("gravityFactor").number(def.gravity_scale);
        if (by_density)
            nodes_.key("extras").open('{').key("fase").open('{').key("byDensity").flag(true).close('}').close('}');
        nodes_.close('}');
    }

    void write_collider(const Collider& collider) {
        nodes_.key(collider.def.sensor ? "trigger" : "collider").open('{').key("geometry").open('{');
        if (const auto hull = hull_nodes_.find(collider.shape); hull != hull_nodes_.end()) {
            nodes_.key("node").number(hull->second).key("convexHull").flag(true);
        } else {
            nodes_.key("shape").number(implicit_.of(collider.shape));
        }
        nodes_.close('}');
        const Material& m = collider.def.material;
        if (!is_default(m))
            nodes_.key("physicsMaterial")
                .number(materials_.of({m.friction, m.restitution, m.friction_combine, m.restitution_combine}));
        const pairs::CollisionFilter& f = collider.def.filter;
        if (f.category != 1 || f.mask != ~0ull) nodes_.key("collisionFilter").number(filters_.of({f.category, f.mask}));
        nodes_.close('}');
    }

    void write_collider_node(const Body&, const Collider& collider) {
        begin_node(collider.name, false);
        if (!(collider.def.pose.position == Vec3{})) nodes_.key("translation").vector(collider.def.pose.position);
        if (!(collider.def.pose.rotation == Quat{})) nodes_.key("rotation").rotation(collider.def.pose.rotation);
        nodes_.key("extensions").open('{').key("KHR_physics_rigid_bodies").open('{');
        write_collider(collider);
        nodes_.close('}').close('}');
        JsonText extras;
        extras.open('{');
        write_collider_extras(extras, collider);
        write_extras(extras);
        nodes_.close('}');
    }

    static void write_collider_extras(JsonText& out, const Collider& collider) {
        const ColliderDef standard;
        if (collider.def.density != standard.density) out.key("density").number(collider.def.density);
        if (collider.def.filter.group != 0) out.key("group").number(collider.def.filter.group);
        if (collider.def.user != 0) out.key("colliderUser").text(std::to_string(collider.def.user));
    }

    void write_body_extras(const Body& body, bool own_collider, bool group) {
        const BodyDef& def = body.def;
        JsonText extras;
        extras.open('{');
        if (group) extras.key("static").flag(true);
        if (def.linear_damping != 0) extras.key("linearDamping").number(def.linear_damping);
        if (def.angular_damping != 0) extras.key("angularDamping").number(def.angular_damping);
        if (!def.can_sleep) extras.key("canSleep").flag(false);
        if (!def.awake) extras.key("awake").flag(false);
        const AxisLocks& k = def.locks;
        const int locks =
            k.linear_x | k.linear_y << 1 | k.linear_z << 2 | k.angular_x << 3 | k.angular_y << 4 | k.angular_z << 5;
        if (locks != 0) extras.key("locks").number(locks);
        if (def.user != 0) extras.key("user").text(std::to_string(def.user));
        if (own_collider) write_collider_extras(extras, body.colliders[0]);
        write_extras(extras);
    }

    void write_extras(JsonText& extras) {
        if (extras.str() == "{") return;
        extras.close('}');
        nodes_.key("extras").open('{').key("fase").raw_json(extras.str()).close('}');
    }

    void write_visual(const Visual& visual) {
        nodes_.key("mesh").number(picture_of(visual));
        const Mat3& m = visual.linear;
        const Vec3 p = visual.position;
        if (m == Mat3::identity()) {
            if (!(p == Vec3{})) nodes_.key("translation").vector(p);
            return;
        }
        const float values[]{m.x.x, m.x.y, m.x.z, 0, m.y.x, m.y.y, m.y.z, 0, m.z.x, m.z.y, m.z.z, 0, p.x, p.y, p.z, 1};
        nodes_.key("matrix").numbers(std::span<const float>(values));
    }

    void write_camera(const Camera& camera) {
        begin_node("camera", true);
        const Vec3d z = normalized(to_double(camera.eye) - to_double(camera.target));
        const Vec3d up = std::abs(z.y) > 0.999 ? Vec3d{0, 0, -1} : Vec3d{0, 1, 0};
        const Vec3d x = normalized(cross(up, z));
        const bool seen = length_squared(z) > 0.5;
        nodes_.key("translation").vector(camera.eye);
        if (seen) nodes_.key("rotation").rotation(to_float(to_quat(Mat3d{x, cross(z, x), z})));
        nodes_.key("camera")
            .number(0)
            .key("extras")
            .open('{')
            .key("fase")
            .open('{')
            .key("target")
            .vector(camera.target)
            .close('}')
            .close('}')
            .close('}');
    }

    // --- data
    // ------------------------------------------------------------------------------------------------------------------

    /// Adds numbers to the buffer and a view of them; returns the view's number.
    template <class T> std::uint32_t add_view(std::span<const T> values, int target) {
        views_.open('{').key("buffer").number(0);
        views_.key("byteOffset")
            .number(data_.size())
            .key("byteLength")
            .number(values.size_bytes())
            .key("target")
            .number(target)
            .close('}');
        const std::size_t begin = data_.size();
        data_.resize(begin + values.size_bytes());
        if (!values.empty()) std::memcpy(data_.data() + begin, values.data(), values.size_bytes());
        return view_count_++;
    }

    /// Accessors of a mesh's positions and indices; the second is none for a mesh without triangles.
    std::pair<std::uint32_t, std::uint32_t> add_geometry(std::span<const Vec3> positions,
                                                         std::span<const std::uint32_t> indices) {
        static_assert(std::endian::native == std::endian::little && sizeof(Vec3) == 12, "glTF data is little-endian");
        Vec3 lo = positions[0], hi = positions[0];
        for (const Vec3 p : positions) {
            lo = min(p, lo);
            hi = max(p, hi);
        }
        accessors_.open('{')
            .key("bufferView")
            .number(add_view(positions, 34962))
            .key("componentType")
            .number(5126)
            .key("count")
            .number(positions.size());
        accessors_.key("type").text("VEC3").key("min").vector(lo).key("max").vector(hi).close('}');
        const std::uint32_t first = accessor_count_++;
        if (indices.empty()) return {first, none};
        accessors_.open('{')
            .key("bufferView")
            .number(add_view(indices, 34963))
            .key("componentType")
            .number(5125)
            .key("count")
            .number(indices.size());
        accessors_.key("type").text("SCALAR").close('}');
        return {first, accessor_count_++};
    }

    void write_meshes() {
        views_.open('[');
        accessors_.open('[');
        meshes_.open('[');
        const auto write = [&](std::string_view name, std::pair<std::uint32_t, std::uint32_t> geometry,
                               std::optional<std::uint32_t> material) {
            meshes_.open('{');
            if (!name.empty()) meshes_.key("name").text(name);
            meshes_.key("primitives")
                .open('[')
                .open('{')
                .key("attributes")
                .open('{')
                .key("POSITION")
                .number(geometry.first)
                .close('}');
            if (geometry.second != none) meshes_.key("indices").number(geometry.second);
            if (material) meshes_.key("material").number(*material);
            meshes_.close('}').close(']').close('}');
        };
        std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> geometries;
        for (const auto& [mesh, colour] : pictures_.list()) {
            const Mesh& m = scene_.meshes[mesh];
            const auto [at, fresh] = geometries.try_emplace(mesh, none, none);
            if (fresh) at->second = add_geometry(m.positions, m.indices);
            write(m.name, at->second, colour);
        }
        for (const auto& [shape, node] : hull_nodes_) {
            const TriangleMesh mesh = triangles(scene_.shapes[shape]);
            write("", add_geometry(mesh.positions, mesh.indices), std::nullopt);
        }
        views_.close(']');
        accessors_.close(']');
        meshes_.close(']');
        while (data_.size() % 4 != 0) data_.push_back(std::byte{0});
    }

    // --- the document
    // ----------------------------------------------------------------------------------------------------------

    void write_shape(JsonText& out, const Shape& shape) const {
        out.open('{');
        const auto type = [&](std::string_view name) -> JsonText& {
            return out.key("type").text(name).key(name).open('{');
        };
        if (const auto* sphere = std::get_if<Sphere>(&shape))
            type("sphere").key("radius").number(sphere->radius);
        else if (const auto* box = std::get_if<Box>(&shape))
            type("box").key("size").vector(to_double(box->half) * 2.0);
        else if (const auto* capsule = std::get_if<Capsule>(&shape)) {
            type("capsule")
                .key("height")
                .number(2.0 * double(capsule->half_length))
                .key("radiusTop")
                .number(capsule->radius)
                .key("radiusBottom")
                .number(capsule->radius);
        } else if (const auto* cylinder = std::get_if<Cylinder>(&shape)) {
            type("cylinder")
                .key("height")
                .number(2.0 * double(cylinder->half_height))
                .key("radiusTop")
                .number(cylinder->radius)
                .key("radiusBottom")
                .number(cylinder->radius);
        } else {
            type("plane");
        }
        out.close('}').close('}');
    }

    static void write_material(JsonText& out, const MaterialKey& key) {
        const auto& [friction, restitution, friction_combine, restitution_combine] = key;
        const auto mode = [](CombineMode m) {
            switch (m) {
                case CombineMode::Minimum: return "minimum";
                case CombineMode::Maximum: return "maximum";
                case CombineMode::Multiply: return "multiply";
                default: return "average";  // KHR has no geometric mean
            }
        };
        out.open('{')
            .key("staticFriction")
            .number(friction)
            .key("dynamicFriction")
            .number(friction)
            .key("restitution")
            .number(restitution);
        out.key("frictionCombine")
            .text(mode(friction_combine))
            .key("restitutionCombine")
            .text(mode(restitution_combine));
        const bool own = friction_combine == CombineMode::GeometricMean,
                   own_bounce = restitution_combine == CombineMode::GeometricMean;
        if (own || own_bounce) {
            out.key("extras").open('{').key("fase").open('{');
            if (own) out.key("frictionCombine").text("geometricMean");
            if (own_bounce) out.key("restitutionCombine").text("geometricMean");
            out.close('}').close('}');
        }
        out.close('}');
    }

    static void write_filter(JsonText& out, const FilterKey& key) {
        const auto names = [&](std::string_view name, std::uint64_t bits) {
            out.key(name).open('[');
            for (int bit = 0; bit < 64; ++bit) {
                if ((bits >> bit & 1) != 0) out.text("bit " + std::to_string(bit));
            }
            out.close(']');
        };
        const auto [category, mask] = key;
        out.open('{');
        names("collisionSystems", category);
        if (mask != ~0ull) {
            if (std::popcount(mask) <= 32)
                names("collideWithSystems", mask);
            else
                names("notCollideWithSystems", ~mask);
        }
        out.close('}');
    }

    template <class T, class F>
    static void write_list(JsonText& out, std::string_view key, const std::vector<T>& list, F&& write) {
        if (list.empty()) return;
        out.key(key).open('[');
        for (const T& item : list) write(item);
        out.close(']');
    }

    void write_extensions(JsonText& out, bool has_gravity) const {
        std::vector<std::string> used{"KHR_implicit_shapes", "KHR_physics_rigid_bodies"};
        if (has_gravity) used.emplace_back("OMI_physics_gravity");
        write_list(out, "extensionsUsed", used, [&](const std::string& name) { out.text(name); });
        out.key("extensions").open('{');
        if (!implicit_.list().empty()) {
            out.key("KHR_implicit_shapes").open('{');
            write_list(out, "shapes", implicit_.list(),
                       [&](std::uint32_t shape) { write_shape(out, scene_.shapes[shape]); });
            out.close('}');
        }
        out.key("KHR_physics_rigid_bodies").open('{');
        write_list(out, "physicsMaterials", materials_.list(),
                   [&](const MaterialKey& key) { write_material(out, key); });
        write_list(out, "collisionFilters", filters_.list(), [&](const FilterKey& key) { write_filter(out, key); });
        out.close('}');
        if (has_gravity) {
            const float amount = length(scene_.gravity);
            out.key("OMI_physics_gravity").open('{').key("gravity").number(amount);
            if (amount > 0) out.key("direction").vector(scene_.gravity * (1 / amount));
            out.close('}');
        }
        out.close('}');
    }

    void write_document(JsonText& out, GltfForm form) {
        const bool has_gravity = !(scene_.gravity == Scene{}.gravity);
        out.open('{').key("asset").open('{').key("version").text("2.0").key("generator").text("Fase").close('}');
        write_extensions(out, has_gravity);
        JsonText extras;
        extras.open('{');
        if (scene_.settings.time_step) extras.key("timeStep").number(*scene_.settings.time_step);
        if (scene_.settings.sub_steps) extras.key("subSteps").number(*scene_.settings.sub_steps);
        if (scene_.settings.sleep) extras.key("sleep").flag(*scene_.settings.sleep);
        if (has_gravity) extras.key("gravity").vector(scene_.gravity);
        if (extras.str() != "{") out.key("extras").open('{').key("fase").raw_json(extras.close('}').str()).close('}');
        out.key("scene").number(0).key("scenes").open('[').open('{');
        if (!scene_.name.empty()) out.key("name").text(scene_.name);
        write_list(out, "nodes", roots_, [&](std::uint32_t node) { out.number(node); });
        out.close('}').close(']');
        if (node_count_ > 0) out.key("nodes").raw_json(nodes_.str());
        if (scene_.camera) {
            out.key("cameras").open('[').open('{').key("type").text("perspective").key("perspective").open('{');
            out.key("yfov")
                .number(scene_.camera->vertical_angle)
                .key("znear")
                .number(0.05)
                .close('}')
                .close('}')
                .close(']');
        }
        write_list(out, "materials", colours_.list(), [&](const ColourKey& c) {
            const float values[]{std::get<0>(c), std::get<1>(c), std::get<2>(c), std::get<3>(c)};
            out.open('{')
                .key("pbrMetallicRoughness")
                .open('{')
                .key("baseColorFactor")
                .numbers(std::span<const float>(values));
            out.key("metallicFactor").number(0).key("roughnessFactor").number(0.8).close('}');
            if (values[3] < 1) out.key("alphaMode").text("BLEND");
            out.close('}');
        });
        if (view_count_ > 0) {
            out.key("meshes")
                .raw_json(meshes_.str())
                .key("accessors")
                .raw_json(accessors_.str())
                .key("bufferViews")
                .raw_json(views_.str());
            out.key("buffers").open('[').open('{').key("byteLength").number(data_.size());
            if (form == GltfForm::Text)
                out.key("uri").raw_json("\"data:application/octet-stream;base64," + encode_base64(data_) + "\"");
            out.close('}').close(']');
        }
        out.close('}');
    }

    [[nodiscard]] std::string in_container(std::string json) const {
        while (json.size() % 4 != 0) json += ' ';
        std::string out = "glTF";
        const auto u32 = [&](std::size_t value) {
            for (int i = 0; i < 4; ++i) out += static_cast<char>(value >> (8 * i) & 0xff);
        };
        u32(2);
        u32(20 + json.size() + (data_.empty() ? 0 : 8 + data_.size()));
        u32(json.size());
        out += "JSON";
        out += json;
        if (!data_.empty()) {
            u32(data_.size());
            out.append("BIN\0", 4);
            out.append(reinterpret_cast<const char*>(data_.data()), data_.size());
        }
        return out;
    }

    const Scene& scene_;
    JsonText nodes_, meshes_, accessors_, views_;
    std::vector<std::byte> data_;
    std::vector<std::uint32_t> roots_;
    std::uint32_t node_count_ = 0, accessor_count_ = 0, view_count_ = 0;
    Numbering<ColourKey> colours_;
    Numbering<PictureKey> pictures_;
    Numbering<std::uint32_t> implicit_;
    Numbering<MaterialKey> materials_;
    Numbering<FilterKey> filters_;
    std::map<std::uint32_t, std::uint32_t> hull_nodes_;  ///< of each hull among the shapes: the node that has its mesh
};

}  // namespace

Result<std::string> gltf_bytes(const Scene& scene, GltfForm form) {
    try {
        return Writer(scene).run(form);
    } catch (const std::bad_alloc&) {
        return Error{Status::NoMemory, "scene", "found too little memory to write it", {}};
    }
}

Result<void> write_gltf(const Scene& scene, const std::string& path) {
    const bool binary = path.ends_with(".glb");
    if (!binary && !path.ends_with(".gltf"))
        return Error{Status::BadArgument, path, "found another ending, need .glb or .gltf", {}};
    const Result<std::string> bytes = gltf_bytes(scene, binary ? GltfForm::Binary : GltfForm::Text);
    if (!bytes) {
        Error error = bytes.error();
        error.where = path + ": " + error.where;
        return error;
    }
    return write_file(path, std::as_bytes(std::span(*bytes)));
}

}  // namespace fase::scene
