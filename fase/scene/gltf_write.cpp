/// Writes a scene as a glTF document: shapes, materials, meshes, and the nodes of NodeWriter.
#include "fase/scene/gltf_write.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstring>
#include <map>
#include <new>

#include "fase/core/detail/files.hpp"
#include "fase/core/no_index.hpp"
#include "fase/geometry/mesh.hpp"
#include "fase/scene/detail/uri.hpp"
#include "fase/scene/gltf/node_writer.hpp"

namespace fase::scene {
namespace {

using gltf::ColourKey;
using gltf::FilterKey;
using gltf::JsonText;
using gltf::MaterialKey;

/// Checks every index in the scene.
Result<void> check_indices(const Scene& scene) {
    const auto bad = [](std::string where, std::size_t found, std::size_t size) {
        return Error{Status::OutOfRange,
                     std::move(where),
                     fmt::format("found index {}; expected one below {}", found, size),
                     {}};
    };
    const auto has_mesh = [&](const Visual& visual) { return visual.mesh < scene.meshes.size(); };
    for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
        for (const Collider& collider : scene.bodies[i].colliders) {
            if (collider.shape >= scene.shapes.size())
                return bad(fmt::format("bodies[{}].colliders", i), collider.shape, scene.shapes.size());
        }
        for (const Visual& visual : scene.bodies[i].visuals) {
            if (!has_mesh(visual)) return bad(fmt::format("bodies[{}].visuals", i), visual.mesh, scene.meshes.size());
        }
    }
    for (const Visual& visual : scene.scenery) {
        if (!has_mesh(visual)) return bad("scenery", visual.mesh, scene.meshes.size());
    }
    for (const Mesh& mesh : scene.meshes) {
        if (mesh.positions.empty())
            return Error{Status::BadArgument, "meshes", "found a mesh without points; expected at least one", {}};
        for (const std::uint32_t index : mesh.indices) {
            if (index >= mesh.positions.size()) return bad("meshes", index, mesh.positions.size());
        }
    }
    return {};
}

/// Writes type and parameters of a shape in KHR_implicit_shapes; the caller closes the parameters.
struct ShapeFields {
    JsonText& out;

    JsonText& type(std::string_view name) const { return out.key("type").text(name).key(name).open('{'); }
    void round(std::string_view name, float half_height, float radius) const {
        type(name)
            .key("height")
            .number(2.0 * double(half_height))
            .key("radiusTop")
            .number(radius)
            .key("radiusBottom")
            .number(radius);
    }
    void operator()(const Sphere& sphere) const { type("sphere").key("radius").number(sphere.radius); }
    void operator()(const Box& box) const { type("box").key("size").vector(to_double(box.half) * 2.0); }
    void operator()(const Capsule& capsule) const { round("capsule", capsule.half_length, capsule.radius); }
    void operator()(const Cylinder& cylinder) const { round("cylinder", cylinder.half_height, cylinder.radius); }
    void operator()(const HalfSpace&) const { type("plane"); }
    void operator()(const ConvexHull&) const { unexpected(); }
    void operator()(const fase::Mesh&) const { unexpected(); }
    void unexpected() const {
        assert(false && "hulls and meshes are written as the meshes of nodes");
        type("plane");
    }
};

class Writer {
public:
    explicit Writer(const Scene& scene) : scene_(scene), nodes_(scene) {}

    Result<std::string> run(GltfForm form) {
        write_meshes();
        JsonText out;
        write_document(out, form);
        if (!out.all_finite() || !nodes_.nodes().all_finite() || !accessors_.all_finite()) {
            return Error{
                Status::BadArgument, "scene", "found a number that is not finite; expected finite numbers", {}};
        }
        return form == GltfForm::Text ? out.str() : in_container(out.str());
    }

private:
    /// Appends numbers to the buffer and adds a view of them; returns the view's index.
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

    /// Adds accessors of a mesh's positions and indices; the second is no_index for a mesh without triangles.
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
        if (indices.empty()) return {first, no_index};
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
            if (geometry.second != no_index) meshes_.key("indices").number(geometry.second);
            if (material) meshes_.key("material").number(*material);
            meshes_.close('}').close(']').close('}');
        };
        std::map<std::uint32_t, std::pair<std::uint32_t, std::uint32_t>> geometries;
        for (const auto& [mesh, colour] : nodes_.coloured_meshes()) {
            const Mesh& m = scene_.meshes[mesh];
            const auto [entry, inserted] = geometries.try_emplace(mesh, no_index, no_index);
            if (inserted) entry->second = add_geometry(m.positions, m.indices);
            write(m.name, entry->second, colour);
        }
        for (const auto& [shape, node] : nodes_.hull_nodes()) {
            const TriangleMesh mesh = triangles(scene_.shapes[shape]);
            write("", add_geometry(mesh.positions, mesh.indices), std::nullopt);
        }
        views_.close(']');
        accessors_.close(']');
        meshes_.close(']');
        while (data_.size() % 4 != 0) data_.push_back(std::byte{0});
    }

    static void write_shape(JsonText& out, const Shape& shape) {
        out.open('{');
        std::visit(ShapeFields{out}, shape);
        out.close('}').close('}');
    }

    static void write_material(JsonText& out, const MaterialKey& key) {
        const auto& [friction, restitution, friction_combine, restitution_combine] = key;
        const auto mode = [](CombineMode m) {
            switch (m) {
                case CombineMode::Minimum: return "minimum";
                case CombineMode::Maximum: return "maximum";
                case CombineMode::Multiply: return "multiply";
                case CombineMode::Average: break;
                case CombineMode::GeometricMean: break;  // not in KHR: written in the extras
            }
            return "average";
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
        const bool friction_in_extras = friction_combine == CombineMode::GeometricMean,
                   restitution_in_extras = restitution_combine == CombineMode::GeometricMean;
        if (friction_in_extras || restitution_in_extras) {
            out.key("extras").open('{').key("fase").open('{');
            if (friction_in_extras) out.key("frictionCombine").text("geometricMean");
            if (restitution_in_extras) out.key("restitutionCombine").text("geometricMean");
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
        if (!nodes_.implicit_shapes().empty()) {
            out.key("KHR_implicit_shapes").open('{');
            write_list(out, "shapes", nodes_.implicit_shapes(),
                       [&](std::uint32_t shape) { write_shape(out, scene_.shapes[shape]); });
            out.close('}');
        }
        out.key("KHR_physics_rigid_bodies").open('{');
        write_list(out, "physicsMaterials", nodes_.materials(),
                   [&](const MaterialKey& key) { write_material(out, key); });
        write_list(out, "collisionFilters", nodes_.filters(), [&](const FilterKey& key) { write_filter(out, key); });
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
        if (extras.str() != "{") out.key("extras").open('{').key("fase").value(extras.close('}')).close('}');
        out.key("scene").number(0).key("scenes").open('[').open('{');
        if (!scene_.name.empty()) out.key("name").text(scene_.name);
        write_list(out, "nodes", nodes_.roots(), [&](std::uint32_t node) { out.number(node); });
        out.close('}').close(']');
        if (nodes_.node_count() > 0) out.key("nodes").raw_json(nodes_.nodes().str());
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
        write_list(out, "materials", nodes_.colours(), [&](const ColourKey& c) {
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
    gltf::NodeWriter nodes_;
    JsonText meshes_, accessors_, views_;
    std::vector<std::byte> data_;
    std::uint32_t accessor_count_ = 0, view_count_ = 0;
};

}  // namespace

Result<std::string> gltf_bytes(const Scene& scene, GltfForm form) {
    try {
        if (auto checked = check_indices(scene); !checked) return checked.error();
        return Writer(scene).run(form);
    } catch (const std::bad_alloc&) {
        return Error{Status::NoMemory, "scene", "found too little memory to write the scene", {}};
    }
}

Result<void> write_gltf(const Scene& scene, const std::string& path) {
    const bool binary = path.ends_with(".glb");
    if (!binary && !path.ends_with(".gltf"))
        return Error{Status::BadArgument, path, "found another extension; expected .glb or .gltf", {}};
    const Result<std::string> bytes = gltf_bytes(scene, binary ? GltfForm::Binary : GltfForm::Text);
    if (!bytes) {
        Error error = bytes.error();
        error.where = path + ": " + error.where;
        return error;
    }
    return write_file(path, std::as_bytes(std::span(*bytes)));
}

}  // namespace fase::scene
