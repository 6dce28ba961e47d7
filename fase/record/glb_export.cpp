/// Exports bodies as glTF nodes and their motion as animation channels.
#include "fase/record/glb_export.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <tuple>

#include "fase/geometry/mesh.hpp"
#include "fase/record/export/creased_mesh.hpp"
#include "fase/record/export/glb_builder.hpp"
#include "fase/record/export/motion_keys.hpp"

namespace fase::record {
namespace {

using nlohmann::json;

/// Collects the motion of one body, frame by frame.
struct Motion {
    Motion(const GlbOptions& options)
        : positions(options.metres), rotations(options.degrees * 3.14159265358979323846 / 180) {}
    MotionKeys<Vec3d> positions;
    MotionKeys<Quatd> rotations;
    std::vector<std::pair<double, bool>> presence;  ///< times at which it appears (true) or disappears
};

json to_json(Vec3 v) { return {v.x, v.y, v.z}; }
json to_json(Quat q) { return {q.x, q.y, q.z, q.w}; }
bool is_identity(Quat q) { return q == Quat{} || q == Quat{0, 0, 0, -1}; }

/// Returns the colour of a body without a colour.
Colour default_colour(const RecordedBody& body, std::uint32_t row) {
    if (body.kind == 0) return {150, 152, 158, 255};
    if (body.kind == 1) return {214, 152, 62, 255};
    constexpr std::array<Colour, 6> dynamic{{{92, 140, 196, 255},
                                             {118, 164, 206, 255},
                                             {196, 110, 92, 255},
                                             {208, 168, 104, 255},
                                             {124, 168, 122, 255},
                                             {160, 128, 182, 255}}};
    return dynamic[row * 2654435761u / 715827883u % dynamic.size()];
}
float linear_from_srgb(std::uint8_t value) {
    const float v = float(value) / 255;
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

/// Returns a recorded shape as triangles with normals.
RecordedMesh mesh_of(const RecordedShape& shape, int detail) {
    const std::optional<Shape> exact = shape_of(shape);
    if (!exact) return with_normals(shape.vertices, shape.triangles);
    const TriangleMesh mesh = triangles(*exact, detail);
    std::vector<Triangle> corners;
    for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        corners.push_back({mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]});
    }
    return with_normals(mesh.positions, corners);
}

class Exporter {
public:
    Exporter(Player& player, const GlbOptions& options)
        : player_(player),
          tables_(player.tables()),
          options_(options),
          motions_(tables_.bodies.size()),
          parts_(tables_.bodies.size()) {}

    Result<std::vector<std::byte>> run() {
        document_["asset"] = {{"version", "2.0"}, {"generator", tables_.head.program}};
        collect_parts();
        if (Result<void> read = read_motions(); !read) return read.error();
        add_nodes();
        return glb_.finish(document_.dump(-1, ' ', false, json::error_handler_t::replace));
    }

private:
    /// A mesh of a body: of a shape or a visual.
    using PartKey = std::tuple<bool, std::uint32_t, float, float, float, float, float, float, float>;
    struct Part {
        bool is_visual;
        std::uint32_t source;  ///< row of the shape or mesh
        LocalPose pose;
        Colour colour;
        [[nodiscard]] PartKey key() const {
            const Vec3 p = pose.position;
            const Quat q = pose.rotation;
            return {is_visual, source, p.x, p.y, p.z, q.x, q.y, q.z, q.w};
        }
        [[nodiscard]] std::uint32_t colour_key() const {
            return std::uint32_t(colour.red) << 24 | colour.green << 16 | colour.blue << 8 | colour.alpha;
        }
    };
    struct Accessors {
        std::uint32_t positions, normals, indices;
    };

    void collect_parts() {
        for (const RecordedVisual& visual : tables_.visuals) {
            if (tables_.meshes[visual.mesh].triangles.empty()) continue;
            parts_[visual.body].push_back({true, visual.mesh, visual.pose, colour_of(visual.colour, visual.body)});
        }
        for (const RecordedCollider& collider : tables_.colliders) {
            std::vector<Part>& parts = parts_[collider.body];
            const bool has_visuals = !parts.empty() && parts[0].is_visual;
            const bool ended = collider.end_frame != std::numeric_limits<std::uint64_t>::max();
            if (has_visuals || collider.sensor || ended) continue;
            parts.push_back({false, collider.shape, collider.pose, colour_of({}, collider.body)});
        }
    }
    [[nodiscard]] Colour colour_of(Colour preferred, std::uint32_t row) const {
        if (preferred.alpha != 0) return preferred;
        const RecordedBody& body = tables_.bodies[row];
        return body.colour.alpha != 0 ? body.colour : default_colour(body, row);
    }

    Result<void> read_motions() {
        Frame frame;
        double first = 0;
        std::vector<std::uint32_t> before, now;
        for (std::uint64_t k = 0; k < player_.frames(); ++k) {
            if (Result<void> read = player_.read(k, frame); !read) return read;
            if (k == 0) {
                first = frame.time;
                choose_origin(frame);
            }
            const double time = k == 0 ? 0 : frame.time - first;
            if (k != 0 && !(time > end_ && static_cast<float>(time) > static_cast<float>(end_))) continue;
            end_ = time;
            now.clear();
            for (const BodyFrame& body : frame.bodies) {
                now.push_back(body.row);
                std::optional<Motion>& motion = motions_[body.row];
                if (!motion) motion.emplace(options_);
                motion->positions.add(time, body.pose.position - origin_);
                motion->rotations.add(time, to_double(body.pose.rotation));
                if (motion->presence.empty() || !motion->presence.back().second)
                    motion->presence.emplace_back(time, true);
            }
            for (const std::uint32_t row : before) {
                if (!std::binary_search(now.begin(), now.end(), row)) motions_[row]->presence.emplace_back(time, false);
            }
            before.swap(now);
        }
        return {};
    }
    /// Moves the origin to the mean position of the moving bodies, because floats far from 0 are imprecise.
    void choose_origin(const Frame& frame) {
        Vec3d sum;
        double count = 0;
        for (const BodyFrame& body : frame.bodies) {
            if (body.kind == 0) continue;
            sum += body.pose.position;
            count += 1;
        }
        if (count > 0 && length(sum) > 1000 * count) {
            origin_ = {std::round(sum.x / count), std::round(sum.y / count), std::round(sum.z / count)};
        }
    }

    std::uint32_t material_of(const Part& part) {
        const auto [found, inserted] = materials_.try_emplace(part.colour_key(), 0);
        if (!inserted) return found->second;
        json& list = document_["materials"];
        found->second = static_cast<std::uint32_t>(list.size());
        const Colour c = part.colour;
        json material{
            {"pbrMetallicRoughness",
             {{"baseColorFactor",
               {linear_from_srgb(c.red), linear_from_srgb(c.green), linear_from_srgb(c.blue), float(c.alpha) / 255}},
              {"metallicFactor", 0},
              {"roughnessFactor", 0.8}}}};
        if (c.alpha != 255) material["alphaMode"] = "BLEND";
        list.push_back(std::move(material));
        return found->second;
    }

    /// Returns the accessors of a part; nullopt if it has no triangles.
    std::optional<Accessors> accessors_of(const Part& part) {
        const auto [found, inserted] = geometries_.try_emplace(part.key());
        if (!inserted) return found->second;
        RecordedMesh mesh =
            part.is_visual ? tables_.meshes[part.source] : mesh_of(tables_.shapes[part.source], options_.detail);
        if (mesh.normals.empty()) mesh = with_normals(mesh.vertices, mesh.triangles);
        for (Vec3& v : mesh.vertices) v = transform(part.pose, v);
        for (Vec3& n : mesh.normals) {
            n = normalized(rotate(part.pose.rotation, n));
            if (!(length_squared(n) > 0.5f)) n = {0, 1, 0};
        }
        if (mesh.triangles.empty()) return std::nullopt;
        found->second = Accessors{glb_.add_positions(mesh.vertices), glb_.add_normals(mesh.normals),
                                  glb_.add_indices(mesh.triangles)};
        return found->second;
    }

    /// Returns the index of the mesh of these parts; nullopt if they have no triangles.
    std::optional<std::uint32_t> mesh_of_parts(const std::vector<Part>& parts) {
        std::vector<std::pair<PartKey, std::uint32_t>> key;
        for (const Part& part : parts) key.emplace_back(part.key(), part.colour_key());
        const auto [found, inserted] = meshes_.try_emplace(std::move(key));
        if (!inserted) return found->second;
        json primitives = json::array();
        for (const Part& part : parts) {
            const std::optional<Accessors> accessors = accessors_of(part);
            if (!accessors) continue;
            primitives.push_back({{"attributes", {{"POSITION", accessors->positions}, {"NORMAL", accessors->normals}}},
                                  {"indices", accessors->indices},
                                  {"material", material_of(part)}});
        }
        if (primitives.empty()) return std::nullopt;
        json& list = document_["meshes"];
        found->second = static_cast<std::uint32_t>(list.size());
        list.push_back({{"primitives", std::move(primitives)}});
        return found->second;
    }

    void add_channel(std::size_t node, const char* path, std::uint32_t times, std::uint32_t values,
                     const char* interpolation) {
        samplers_.push_back({{"input", times}, {"output", values}, {"interpolation", interpolation}});
        channels_.push_back({{"sampler", samplers_.size() - 1}, {"target", {{"node", node}, {"path", path}}}});
    }

    /// Adds the times of keys. If two times are equal as floats, increases the second: times must be ascending.
    template <class Key> std::uint32_t add_times(const std::vector<Key>& keys) {
        std::vector<float> times;
        for (const Key& key : keys) {
            float time = static_cast<float>(time_of(key));
            if (!times.empty() && !(time > times.back())) time = std::nextafter(times.back(), INFINITY);
            times.push_back(time);
        }
        return glb_.add_times(times);
    }
    template <class Value> static double time_of(const MotionKey<Value>& key) { return key.time; }
    static double time_of(const std::pair<double, bool>& change) { return change.first; }

    void add_motion(std::size_t number, json& node, Motion& motion) {
        const auto& positions = motion.positions.finish();
        std::vector<Vec3> points;
        for (const auto& key : positions) points.push_back(to_float(key.value));
        node["translation"] = to_json(points[0]);
        if (points.size() > 1)
            add_channel(number, "translation", add_times(positions), glb_.add_points(points), "LINEAR");

        const auto& rotations = motion.rotations.finish();
        std::vector<Quat> quaternions;
        for (const auto& key : rotations) {
            Quat q = to_float(key.value);
            if (!quaternions.empty()) {
                const Quat b = quaternions.back();
                if (q.x * b.x + q.y * b.y + q.z * b.z + q.w * b.w < 0) q = {-q.x, -q.y, -q.z, -q.w};
            }
            quaternions.push_back(q);
        }
        if (!is_identity(quaternions[0])) node["rotation"] = to_json(quaternions[0]);
        if (quaternions.size() > 1)
            add_channel(number, "rotation", add_times(rotations), glb_.add_rotations(quaternions), "LINEAR");

        if (motion.presence.size() == 1 && motion.presence[0].first == 0) return;
        if (motion.presence[0].first > 0) motion.presence.insert(motion.presence.begin(), {0.0, false});
        std::vector<Vec3> scales;
        for (const auto& [time, present] : motion.presence) scales.push_back(present ? Vec3{1, 1, 1} : Vec3{});
        node["scale"] = to_json(scales[0]);
        add_channel(number, "scale", add_times(motion.presence), glb_.add_points(scales), "STEP");
    }

    void add_nodes() {
        json nodes = json::array(), children = json::array();
        nodes.push_back({{"name", tables_.head.title.empty() ? "recording" : tables_.head.title}});
        if (!(origin_ == Vec3d{})) nodes[0]["translation"] = {origin_.x, origin_.y, origin_.z};
        for (std::uint32_t row = 0; row < tables_.bodies.size(); ++row) {
            if (!motions_[row]) continue;
            json node;
            const std::string& name = tables_.bodies[row].name;
            node["name"] = name.empty() ? "body " + std::to_string(tables_.bodies[row].index) : name;
            if (!parts_[row].empty()) {
                const std::optional<std::uint32_t> mesh = mesh_of_parts(parts_[row]);
                if (mesh) node["mesh"] = *mesh;
            }
            add_motion(nodes.size(), node, *motions_[row]);
            children.push_back(nodes.size());
            nodes.push_back(std::move(node));
        }
        if (!children.empty()) nodes[0]["children"] = std::move(children);
        document_["nodes"] = std::move(nodes);
        document_["scenes"] = {{{"nodes", {0}}}};
        document_["scene"] = 0;
        if (!channels_.empty()) {
            document_["animations"] = {
                {{"name", "motion"}, {"channels", std::move(channels_)}, {"samplers", std::move(samplers_)}}};
        }
    }

    Player& player_;
    const Tables& tables_;
    GlbOptions options_;
    std::vector<std::optional<Motion>> motions_;
    std::vector<std::vector<Part>> parts_;  ///< by body row
    Vec3d origin_;
    double end_ = 0;
    GlbBuilder glb_;
    json document_;
    json channels_ = json::array(), samplers_ = json::array();
    std::map<PartKey, std::optional<Accessors>> geometries_;
    std::map<std::vector<std::pair<PartKey, std::uint32_t>>, std::optional<std::uint32_t>> meshes_;
    std::map<std::uint32_t, std::uint32_t> materials_;
};

}  // namespace

Result<std::vector<std::byte>> export_glb(Player& player, const GlbOptions& options) {
    if (Result<void> has_frames = player.check_has_frames(); !has_frames) return has_frames.error();
    if (!(options.metres >= 0) || !(options.degrees >= 0) || options.detail < 3 || options.detail > 1000) {
        return Error{
            Status::BadArgument, "GlbOptions", "expected metres and degrees of 0 or more, and detail of 3 to 1000", {}};
    }
    return Exporter(player, options).run();
}

}  // namespace fase::record
