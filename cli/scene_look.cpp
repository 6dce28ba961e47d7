/// Converts the appearance of a scene to that of a recording.
#include "cli/scene_look.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <utility>

namespace fase::cli {
namespace {

/// Linear light to sRGB's 0..255. Source: IEC 61966-2-1.
std::uint8_t to_srgb(float linear) {
    const float c = std::clamp(linear, 0.0f, 1.0f);
    const float curve = c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1 / 2.4f) - 0.055f;
    return static_cast<std::uint8_t>(std::lround(255 * curve));
}

record::Colour to_recorded(const scene::Colour& colour) {
    const auto alpha = static_cast<std::uint8_t>(std::lround(255 * std::clamp(colour.alpha, 0.0f, 1.0f)));
    // 0 would mean "no colour given".
    return {to_srgb(colour.red), to_srgb(colour.green), to_srgb(colour.blue), std::max<std::uint8_t>(alpha, 1)};
}

/// Whether `m` is a rotation within float precision.
bool is_rotation(const Mat3& m) {
    const Mat3 off = transpose(m) * m - Mat3::identity();
    const float worst = std::sqrt(length_squared(off.x) + length_squared(off.y) + length_squared(off.z));
    return worst < 1e-5f && determinant(m) > 0;
}

/// Creates the recording's meshes: one for each pair of scene mesh and linear map (scale, shear).
class Meshes {
public:
    Meshes(const scene::Scene& scene, std::vector<record::RecordedMesh>& out) : scene_(scene), out_(out) {}

    record::Visual convert(const scene::Visual& visual) {
        record::Visual converted;
        converted.colour = to_recorded(visual.colour);
        converted.pose.position = visual.position;
        const bool rotation_only = is_rotation(visual.linear);
        if (rotation_only) converted.pose.rotation = to_quat(visual.linear);
        converted.mesh = mesh_with(visual.mesh, rotation_only ? Mat3::identity() : visual.linear);
        return converted;
    }

private:
    std::uint32_t mesh_with(std::uint32_t index, const Mat3& linear) {
        const Key key{index,
                      {linear.x.x, linear.x.y, linear.x.z, linear.y.x, linear.y.y, linear.y.z, linear.z.x, linear.z.y,
                       linear.z.z}};
        const auto [entry, is_new] = made_.try_emplace(key, static_cast<std::uint32_t>(out_.size()));
        if (!is_new) return entry->second;
        const scene::Mesh& mesh = scene_.meshes[index];
        record::RecordedMesh recorded;
        recorded.vertices.reserve(mesh.positions.size());
        for (const Vec3 position : mesh.positions) recorded.vertices.push_back(linear * position);
        const bool flipped = determinant(linear) < 0;
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            record::Triangle corners{mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
            if (flipped) std::swap(corners[1], corners[2]);
            recorded.triangles.push_back(corners);
        }
        out_.push_back(std::move(recorded));
        return entry->second;
    }

    using Key = std::pair<std::uint32_t, std::array<float, 9>>;
    const scene::Scene& scene_;
    std::vector<record::RecordedMesh>& out_;
    std::map<Key, std::uint32_t> made_;
};

/// A visual in world coordinates, expressed in the frame of a static body.
scene::Visual in_body_frame(const Pose& body, const scene::Visual& visual) {
    scene::Visual local = visual;
    const LocalPose body_from_world = inverse(LocalPose{to_float(body.position), body.rotation});
    local.position = transform(body_from_world, visual.position);
    local.linear = to_matrix(body_from_world.rotation) * visual.linear;
    return local;
}

}  // namespace

SceneLook look_of(const scene::Scene& scene, std::span<const BodyId> ids) {
    SceneLook look;
    look.head.title = scene.name;
    Meshes meshes(scene, look.head.meshes);
    std::optional<std::size_t> stage;  // index of the look that the scenery is attached to
    Pose stage_pose;
    for (std::size_t i = 0; i < scene.bodies.size() && i < ids.size(); ++i) {
        const scene::Body& body = scene.bodies[i];
        record::BodyLook body_look;
        body_look.body = ids[i];
        body_look.name = body.name;
        for (const scene::Visual& visual : body.visuals) body_look.visuals.push_back(meshes.convert(visual));
        if (!body_look.visuals.empty()) body_look.colour = body_look.visuals.front().colour;
        if (!stage && body.def.kind == BodyKind::Static && !body_look.visuals.empty()) {
            stage = look.head.looks.size();
            stage_pose = {body.def.position, body.def.rotation};
        }
        look.head.looks.push_back(std::move(body_look));
    }
    if (!scene.scenery.empty() && !stage) {
        look.warnings.push_back("meshes without a body are not in the recording (" +
                                std::to_string(scene.scenery.size()) + " times)");
        return look;
    }
    for (const scene::Visual& visual : scene.scenery) {
        look.head.looks[*stage].visuals.push_back(meshes.convert(in_body_frame(stage_pose, visual)));
    }
    return look;
}

}  // namespace fase::cli
