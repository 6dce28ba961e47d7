/// How a scene looks, in the words of a recording.
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

/// Whether the columns are a rotation's, to what float can tell.
bool is_rotation(const Mat3& m) {
    const Mat3 off = transpose(m) * m - Mat3::identity();
    const float worst = std::sqrt(length_squared(off.x) + length_squared(off.y) + length_squared(off.z));
    return worst < 1e-5f && determinant(m) > 0;
}

/// Gives out the recording's meshes: one for each mesh of the scene and each way in which it is stretched.
class Meshes {
public:
    Meshes(const scene::Scene& scene, std::vector<record::RecordedMesh>& out) : scene_(scene), out_(out) {}

    record::Visual place(const scene::Visual& visual) {
        record::Visual placed;
        placed.colour = to_recorded(visual.colour);
        placed.pose.position = visual.position;
        const bool turned_only = is_rotation(visual.linear);
        if (turned_only) placed.pose.rotation = to_quat(visual.linear);
        placed.mesh = stretched(visual.mesh, turned_only ? Mat3::identity() : visual.linear);
        return placed;
    }

private:
    std::uint32_t stretched(std::uint32_t index, const Mat3& linear) {
        const Key key{index,
                      {linear.x.x, linear.x.y, linear.x.z, linear.y.x, linear.y.y, linear.y.z, linear.z.x, linear.z.y,
                       linear.z.z}};
        const auto [place, is_new] = made_.try_emplace(key, static_cast<std::uint32_t>(out_.size()));
        if (!is_new) return place->second;
        const scene::Mesh& mesh = scene_.meshes[index];
        record::RecordedMesh recorded;
        recorded.vertices.reserve(mesh.positions.size());
        for (const Vec3 position : mesh.positions) recorded.vertices.push_back(linear * position);
        const bool inside_out = determinant(linear) < 0;
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            record::Triangle corners{mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
            if (inside_out) std::swap(corners[1], corners[2]);
            recorded.triangles.push_back(corners);
        }
        out_.push_back(std::move(recorded));
        return place->second;
    }

    using Key = std::pair<std::uint32_t, std::array<float, 9>>;
    const scene::Scene& scene_;
    std::vector<record::RecordedMesh>& out_;
    std::map<Key, std::uint32_t> made_;
};

/// A visual of the world as one of a body that never moves.
scene::Visual seen_from(const Pose& body, const scene::Visual& visual) {
    scene::Visual moved = visual;
    const LocalPose back = inverse(LocalPose{to_float(body.position), body.rotation});
    moved.position = transform(back, visual.position);
    moved.linear = to_matrix(back.rotation) * visual.linear;
    return moved;
}

}  // namespace

SceneLook look_of(const scene::Scene& scene, std::span<const BodyId> ids) {
    SceneLook look;
    look.head.title = scene.name;
    Meshes meshes(scene, look.head.meshes);
    std::optional<std::size_t> stage;  // index of the look that scenery is put on
    Pose stage_pose;
    for (std::size_t i = 0; i < scene.bodies.size() && i < ids.size(); ++i) {
        const scene::Body& body = scene.bodies[i];
        record::BodyLook one;
        one.body = ids[i];
        one.name = body.name;
        for (const scene::Visual& visual : body.visuals) one.visuals.push_back(meshes.place(visual));
        if (!one.visuals.empty()) one.colour = one.visuals.front().colour;
        if (!stage && body.def.kind == BodyKind::Static && !one.visuals.empty()) {
            stage = look.head.looks.size();
            stage_pose = {body.def.position, body.def.rotation};
        }
        look.head.looks.push_back(std::move(one));
    }
    if (!scene.scenery.empty() && !stage) {
        look.warnings.push_back("meshes that belong to no body are not in the recording (" +
                                std::to_string(scene.scenery.size()) + " times)");
        return look;
    }
    for (const scene::Visual& visual : scene.scenery) {
        look.head.looks[*stage].visuals.push_back(meshes.place(seen_from(stage_pose, visual)));
    }
    return look;
}

}  // namespace fase::cli
