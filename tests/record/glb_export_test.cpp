/// Tests the exported animation: the file is valid, and the bodies are where they were.
#include "fase/record/glb_export.hpp"

#include <gtest/gtest.h>
#include <tiny_gltf.h>

#include <cstring>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "tests/record/artificial_run.hpp"

namespace fase::record {
namespace {

using nlohmann::json;

std::vector<std::byte> exported(const std::string& name, const ArtificialRun& run, std::uint64_t frames) {
    EXPECT_TRUE(record_run(name, run, frames));
    Result<Player> player = Player::open(name);
    EXPECT_TRUE(player);
    Result<std::vector<std::byte>> glb = export_glb(*player);
    EXPECT_TRUE(glb);
    return std::move(*glb);
}

std::uint32_t u32_at(const std::vector<std::byte>& bytes, std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, 4);
    return value;
}

/// The JSON document and the binary part; the constructor checks the container.
struct Container {
    json document;
    std::vector<std::byte> binary;
    explicit Container(const std::vector<std::byte>& glb) {
        EXPECT_EQ(u32_at(glb, 0), 0x46546c67u);
        EXPECT_EQ(u32_at(glb, 4), 2u);
        EXPECT_EQ(u32_at(glb, 8), glb.size());
        const std::uint32_t text = u32_at(glb, 12);
        EXPECT_EQ(text % 4, 0u);
        EXPECT_EQ(u32_at(glb, 16), 0x4e4f534au);
        document = json::parse(reinterpret_cast<const char*>(glb.data()) + 20,
                               reinterpret_cast<const char*>(glb.data()) + 20 + text);
        const std::size_t rest = 20 + text;
        if (rest == glb.size()) return;
        EXPECT_EQ(u32_at(glb, rest) % 4, 0u);
        EXPECT_EQ(u32_at(glb, rest + 4), 0x004e4942u);
        binary.assign(glb.begin() + static_cast<std::ptrdiff_t>(rest) + 8, glb.end());
        EXPECT_EQ(u32_at(glb, rest), binary.size());
    }
    [[nodiscard]] std::vector<float> floats(std::size_t accessor) const {
        const json& a = document["accessors"][accessor];
        const json& view = document["bufferViews"][a["bufferView"].get<std::size_t>()];
        const std::string type = a["type"];
        const std::size_t parts = type == "SCALAR" ? 1 : type == "VEC3" ? 3 : 4;
        std::vector<float> out(a["count"].get<std::size_t>() * parts);
        std::memcpy(out.data(),
                    binary.data() + view["byteOffset"].get<std::size_t>() + a["byteOffset"].get<std::size_t>(),
                    out.size() * 4);
        return out;
    }
};

TEST(GlbExport, IsAValidFile) {
    const TemporaryFolder folder;
    const Container glb(exported(folder / "run", ArtificialRun(60), 90));
    const json& views = glb.document["bufferViews"];
    std::size_t end = 0;
    for (const json& view : views) {
        EXPECT_EQ(view["byteOffset"].get<std::size_t>(), end);
        EXPECT_GT(view["byteLength"].get<std::size_t>(), 0u);
        EXPECT_EQ(end % 4, 0u);
        end += view["byteLength"].get<std::size_t>();
    }
    EXPECT_EQ(end, glb.binary.size());
    EXPECT_EQ(glb.document["buffers"][0]["byteLength"], glb.binary.size());
    for (const json& a : glb.document["accessors"]) {
        const json& view = views[a["bufferView"].get<std::size_t>()];
        const std::string type = a["type"];
        const std::size_t size = 4 * (type == "SCALAR" ? 1 : type == "VEC3" ? 3 : 4);
        EXPECT_EQ(a["byteOffset"].get<std::size_t>() % 4, 0u);
        EXPECT_GT(a["count"].get<std::size_t>(), 0u);
        EXPECT_LE(a["byteOffset"].get<std::size_t>() + a["count"].get<std::size_t>() * size,
                  view["byteLength"].get<std::size_t>());
    }
    const json& meshes = glb.document["meshes"];
    for (const json& mesh : meshes) {
        for (const json& primitive : mesh["primitives"]) {
            const std::size_t position = primitive["attributes"]["POSITION"],
                              normal = primitive["attributes"]["NORMAL"];
            const json& a = glb.document["accessors"][position];
            EXPECT_EQ(a["count"], glb.document["accessors"][normal]["count"]);
            const std::vector<float> points = glb.floats(position), normals = glb.floats(normal);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                float lo = points[axis], hi = points[axis];
                for (std::size_t i = axis; i < points.size(); i += 3) {
                    lo = std::min(lo, points[i]);
                    hi = std::max(hi, points[i]);
                }
                EXPECT_EQ(a["min"][axis].get<float>(), lo);
                EXPECT_EQ(a["max"][axis].get<float>(), hi);
            }
            for (std::size_t i = 0; i < normals.size(); i += 3) {
                EXPECT_NEAR(length(Vec3{normals[i], normals[i + 1], normals[i + 2]}), 1, 1e-4);
            }
            const json& indices = glb.document["accessors"][primitive["indices"].get<std::size_t>()];
            const std::size_t at = views[indices["bufferView"].get<std::size_t>()]["byteOffset"].get<std::size_t>() +
                                   indices["byteOffset"].get<std::size_t>();
            for (std::size_t i = 0; i < indices["count"].get<std::size_t>(); ++i) {
                EXPECT_LT(u32_at(glb.binary, at + 4 * i), a["count"].get<std::uint32_t>());
            }
        }
    }
    EXPECT_LE(meshes.size(), 40u);  // two shapes in few colours, not one mesh per body
    const json& animation = glb.document["animations"][0];
    for (const json& sampler : animation["samplers"]) {
        const std::vector<float> times = glb.floats(sampler["input"]);
        const json& input = glb.document["accessors"][sampler["input"].get<std::size_t>()];
        EXPECT_EQ(input["count"], glb.document["accessors"][sampler["output"].get<std::size_t>()]["count"]);
        EXPECT_EQ(input["min"][0].get<float>(), times.front());
        EXPECT_EQ(input["max"][0].get<float>(), times.back());
        for (std::size_t i = 1; i < times.size(); ++i) EXPECT_GT(times[i], times[i - 1]);
    }
    std::set<std::pair<std::size_t, std::string>> targets;
    for (const json& channel : animation["channels"]) {
        const std::size_t node = channel["target"]["node"];
        EXPECT_LT(node, glb.document["nodes"].size());
        EXPECT_TRUE(targets.emplace(node, channel["target"]["path"].get<std::string>()).second);
    }
}

TEST(GlbExport, IsReadByTinyGltf) {
    const TemporaryFolder folder;
    const std::vector<std::byte> glb = exported(folder / "run", ArtificialRun(60), 90);
    tinygltf::TinyGLTF reader;
    tinygltf::Model model;
    std::string error, warning;
    ASSERT_TRUE(reader.LoadBinaryFromMemory(&model, &error, &warning,
                                            reinterpret_cast<const unsigned char*>(glb.data()),
                                            static_cast<unsigned>(glb.size())))
        << error;
    EXPECT_EQ(error, "");
    EXPECT_EQ(warning, "");
    ASSERT_EQ(model.animations.size(), 1u);
    EXPECT_EQ(model.nodes.size(), 61u);
    EXPECT_EQ(model.nodes[0].children.size(), 60u);
    EXPECT_EQ(model.nodes[1].name, "ground");
    EXPECT_GE(model.meshes.size(), 2u);
}

/// Evaluates channels at a time as a glTF player does; without a channel, uses the value of the node.
class Playback {
public:
    explicit Playback(const Container& glb) : glb_(glb) {
        const json& animation = glb.document["animations"][0];
        for (const json& channel : animation["channels"]) {
            const json& sampler = animation["samplers"][channel["sampler"].get<std::size_t>()];
            channels_[{channel["target"]["node"], channel["target"]["path"]}] = {glb.floats(sampler["input"]),
                                                                                 glb.floats(sampler["output"])};
        }
    }
    [[nodiscard]] Vec3d translation(std::size_t node, double time) const {
        const auto found = channels_.find({node, "translation"});
        if (found == channels_.end()) {
            const json& t = glb_.document["nodes"][node]["translation"];
            return {t[0], t[1], t[2]};
        }
        const auto [k, fraction] = place(found->second.times, time);
        const auto& v = found->second.values;
        const auto at = [&](std::size_t i) { return Vec3d{v[3 * i], v[3 * i + 1], v[3 * i + 2]}; };
        return at(k) + (at(k + (fraction > 0 ? 1 : 0)) - at(k)) * fraction;
    }
    /// Returns the angle in radians between the rotation at that time and `expected`.
    [[nodiscard]] double rotation_error(std::size_t node, double time, Quat expected) const {
        const auto found = channels_.find({node, "rotation"});
        const Quatd target = normalized(to_double(expected));
        if (found == channels_.end()) {
            const json& n = glb_.document["nodes"][node];
            Quatd q;
            if (n.contains("rotation")) q = {n["rotation"][0], n["rotation"][1], n["rotation"][2], n["rotation"][3]};
            return distance_between_rotations(q, q, 0, target);
        }
        const auto [k, fraction] = place(found->second.times, time);
        const auto& v = found->second.values;
        const auto at = [&](std::size_t i) { return Quatd{v[4 * i], v[4 * i + 1], v[4 * i + 2], v[4 * i + 3]}; };
        return distance_between_rotations(at(k), at(k + (fraction > 0 ? 1 : 0)), fraction, target);
    }
    [[nodiscard]] bool is_there(std::size_t node, double time) const {
        const auto found = channels_.find({node, "scale"});
        if (found == channels_.end()) return true;
        std::size_t k = 0;
        while (k + 1 < found->second.times.size() && found->second.times[k + 1] <= time + 1e-6) ++k;
        return found->second.values[3 * k] == 1;
    }

private:
    struct Channel {
        std::vector<float> times, values;
    };
    static std::pair<std::size_t, double> place(const std::vector<float>& times, double time) {
        if (time <= times.front()) return {0, 0};
        if (time >= times.back()) return {times.size() - 1, 0};
        std::size_t k = 0;
        while (times[k + 1] < time) ++k;
        return {k, (time - times[k]) / (times[k + 1] - times[k])};
    }
    static double distance_between_rotations(Quatd a, Quatd b, double fraction, Quatd target);
    const Container& glb_;
    std::map<std::pair<std::size_t, std::string>, Channel> channels_;
};

/// Interpolates as the specification says (slerp along the shorter arc); an independent reference implementation.
double Playback::distance_between_rotations(Quatd a, Quatd b, double fraction, Quatd target) {
    const double d = a.x * b.x + a.y * b.y + a.z * b.z + a.w * b.w;
    const double s = d < 0 ? -1 : 1, angle = std::acos(std::min(1.0, std::abs(d)));
    const double p = angle > 1e-6 ? std::sin((1 - fraction) * angle) / std::sin(angle) : 1 - fraction;
    const double q = (angle > 1e-6 ? std::sin(fraction * angle) / std::sin(angle) : fraction) * s;
    const Quatd at = normalized(Quatd{a.x * p + b.x * q, a.y * p + b.y * q, a.z * p + b.z * q, a.w * p + b.w * q});
    const Quatd difference = conjugate(at) * target;
    return 2 * std::atan2(length(difference.vector()), std::abs(difference.w));
}

TEST(GlbExport, PlaysTheRecordedMotion) {
    const TemporaryFolder folder;
    for (const double origin : {0.0, 1e6}) {
        const ArtificialRun run(60, origin);
        const std::string name = folder / ("run" + std::to_string(origin));
        const Container glb(exported(name, run, 90));
        const Playback playback(glb);
        const json& root = glb.document["nodes"][0];
        const Vec3d offset = root.contains("translation")
                                 ? Vec3d{root["translation"][0], root["translation"][1], root["translation"][2]}
                                 : Vec3d{};
        double worst_metres = 0, worst_degrees = 0;
        std::size_t seen = 0;
        for (std::uint64_t k = 0; k < 90; ++k) {
            const Frame frame = run.frame(k);
            const double time = frame.time - run.frame(0).time;
            std::set<std::size_t> there;
            for (const BodyFrame& body : frame.bodies) {
                const std::size_t node = body.row + 1;
                there.insert(node);
                if (body.row % 19 == 4) continue;  // jumps a kilometre, where floats are imprecise
                worst_metres =
                    std::max(worst_metres, length(playback.translation(node, time) + offset - body.pose.position));
                worst_degrees =
                    std::max(worst_degrees, playback.rotation_error(node, time, body.pose.rotation) * 57.29578);
                ++seen;
            }
            for (std::size_t node = 1; node <= 60; ++node)
                EXPECT_EQ(playback.is_there(node, time), there.count(node) == 1);
        }
        EXPECT_GT(seen, 4000u);
        EXPECT_LT(worst_metres, 0.0015);  // 1 mm from the keys, the rest from the quanta
        EXPECT_LT(worst_degrees, 0.13);
        EXPECT_GT(worst_metres, 0.0001);
    }
}

TEST(GlbExport, ARecordingWithoutFramesIsRefused) {
    const TemporaryFolder folder;
    ASSERT_TRUE(record_run(folder / "run", ArtificialRun(3), 0));
    Result<Player> player = Player::open(folder / "run");
    ASSERT_TRUE(player);
    const auto glb = export_glb(*player);
    ASSERT_FALSE(glb);
    EXPECT_EQ(glb.error().text(), folder / "run" + ": found no complete frame; expected at least one");
    EXPECT_EQ(glb.status(), Status::Format);
}

TEST(GlbExport, ARecordingWithoutBodiesGivesAValidFile) {
    const TemporaryFolder folder;
    const std::vector<std::byte> glb = exported(folder / "run", ArtificialRun(0), 1);
    const Container container(glb);
    EXPECT_EQ(container.document["asset"]["version"], "2.0");
    EXPECT_FALSE(container.document.contains("buffers"));
    tinygltf::TinyGLTF reader;
    tinygltf::Model model;
    std::string error, warning;
    EXPECT_TRUE(reader.LoadBinaryFromMemory(&model, &error, &warning,
                                            reinterpret_cast<const unsigned char*>(glb.data()),
                                            static_cast<unsigned>(glb.size())))
        << error;
}

}  // namespace
}  // namespace fase::record
