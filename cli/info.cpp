/// The command `fase info`: says what a file is and what is in it.
#include "cli/info.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <cstring>
#include <map>
#include <utility>
#include <variant>
#include <vector>

#include "cli/arguments.hpp"
#include "cli/output.hpp"
#include "cli/start.hpp"
#include "fase/core/files.hpp"
#include "fase/record/format.hpp"
#include "fase/record/player.hpp"
#include "fase/scene/gltf.hpp"
#include "fase/scene/json.hpp"

namespace fase::cli {
namespace {

/// A JSON string as text that can do no harm on a terminal: without its quotes, control characters still escaped.
std::string unquoted(std::string_view quoted) {
    std::string safe;
    for (std::size_t i = 1; i + 1 < quoted.size(); ++i) {
        if (quoted[i] == '\\' && (quoted[i + 1] == '"' || quoted[i + 1] == '\\')) ++i;
        safe += quoted[i];
    }
    return safe;
}

/// Facts about a file in their order: printed as lines or as one JSON object.
class Facts {
public:
    void add(std::string key, std::string_view text) { entries_.push_back({std::move(key), scene::quoted(text)}); }
    void add(std::string key, const char* text) { add(std::move(key), std::string_view(text)); }
    void add(std::string key, bool value) { entries_.push_back({std::move(key), value ? "true" : "false"}); }
    template <class T>
    requires std::is_arithmetic_v<T>
    void add(std::string key, T number) { entries_.push_back({std::move(key), fmt::format("{}", number)}); }
    void add(std::string key, const std::vector<std::string>& texts) {
        std::vector<std::string> values;
        for (const std::string& text : texts) values.push_back(scene::quoted(text));
        entries_.push_back({std::move(key), std::move(values)});
    }
    void add(std::string key, const std::map<std::string, std::size_t>& counts) {
        entries_.push_back({std::move(key), counts});
    }

    [[nodiscard]] std::string json() const {
        std::string text = "{";
        for (const Entry& entry : entries_) {
            if (text.size() > 1) text += ", ";
            text += scene::quoted(entry.key) + ": ";
            if (const auto* value = std::get_if<std::string>(&entry.value)) {
                text += *value;
            } else if (const auto* list = std::get_if<std::vector<std::string>>(&entry.value)) {
                text += fmt::format("[{}]", fmt::join(*list, ", "));
            } else {
                std::vector<std::string> members;
                for (const auto& [name, count] : std::get<Counts>(entry.value))
                    members.push_back(fmt::format("{}: {}", scene::quoted(name), count));
                text += fmt::format("{{{}}}", fmt::join(members, ", "));
            }
        }
        return text + "}\n";
    }
    /// Aligned lines; empty lists are left out.
    [[nodiscard]] std::string lines() const {
        std::string text;
        const auto line = [&](std::string_view key, std::string_view value) {
            text += fmt::format("{:<20} {}\n", key, value);
        };
        for (const Entry& entry : entries_) {
            if (const auto* value = std::get_if<std::string>(&entry.value)) {
                const bool is_text = value->front() == '"';
                line(entry.key, is_text ? unquoted(*value) : *value);
            } else if (const auto* list = std::get_if<std::vector<std::string>>(&entry.value)) {
                for (std::size_t i = 0; i < list->size(); ++i) line(i == 0 ? entry.key : "", unquoted((*list)[i]));
            } else {
                bool first = true;
                for (const auto& [name, count] : std::get<Counts>(entry.value)) {
                    line(std::exchange(first, false) ? entry.key : "", fmt::format("{} {}", count, name));
                }
            }
        }
        return text;
    }

private:
    using Counts = std::map<std::string, std::size_t>;
    struct Entry {
        std::string key;
        std::variant<std::string, std::vector<std::string>, Counts> value;  ///< texts as JSON has them
    };
    std::vector<Entry> entries_;
};

Result<Facts> scene_facts(const InfoOptions& options) {
    const Result<scene::Scene> read = scene::read_gltf(options.file);
    if (!read) return read.error();
    const scene::Scene& s = *read;
    std::map<std::string, std::size_t> kinds{{"static", 0}, {"kinematic", 0}, {"dynamic", 0}}, shapes;
    std::size_t colliders = 0, sensors = 0, visuals = s.scenery.size(), triangles = 0;
    for (const scene::Body& body : s.bodies) {
        ++kinds[body.def.kind == BodyKind::Static      ? "static"
                : body.def.kind == BodyKind::Kinematic ? "kinematic"
                                                       : "dynamic"];
        visuals += body.visuals.size();
        for (const scene::Collider& collider : body.colliders) {
            ++(collider.def.sensor ? sensors : colliders);
            ++shapes[std::string(name_of(s.shapes[collider.shape]))];
        }
    }
    for (const scene::Mesh& mesh : s.meshes) triangles += mesh.indices.size() / 3;
    std::map<std::string, std::size_t> joints;
    for (const scene::Joint& joint : s.joints) ++joints[joint.type];
    Facts facts;
    facts.add("kind", "glTF scene");
    facts.add("name", std::string_view(s.name));
    facts.add("bodies", s.bodies.size());
    facts.add("bodies_by_kind", kinds);
    facts.add("colliders", colliders);
    facts.add("sensors", sensors);
    facts.add("shapes", s.shapes.size());
    facts.add("colliders_by_shape", shapes);
    facts.add("joints", s.joints.size());
    facts.add("joints_by_type", joints);
    facts.add("meshes", s.meshes.size());
    facts.add("mesh_triangles", triangles);
    facts.add("visuals", visuals);
    facts.add("gravity", std::string_view(fmt::format("{} {} {} m/s²", s.gravity.x, s.gravity.y, s.gravity.z)));
    facts.add("extensions_used", s.extensions_used);
    facts.add("extensions_required", s.extensions_required);
    facts.add("warnings", s.warnings);
    return facts;
}

Result<Facts> recording_facts(const InfoOptions& options) {
    const Result<record::Player> player = record::Player::open(options.file);
    if (!player) return player.error();
    const record::Head& head = player->head();
    const record::Tables& tables = player->tables();
    Facts facts;
    facts.add("kind", "Fase recording");
    facts.add("title", std::string_view(head.title));
    facts.add("program", std::string_view(head.program));
    facts.add("frames", player->frames());
    facts.add("time_step", head.time_step);
    facts.add("seconds", static_cast<double>(player->frames()) * double(head.time_step));
    facts.add("bodies", tables.bodies.size());
    facts.add("colliders", tables.colliders.size());
    facts.add("shapes", tables.shapes.size());
    facts.add("meshes", tables.meshes.size());
    facts.add("complete", player->complete());
    facts.add("bytes", player->file_bytes());
    facts.add("good_bytes", player->good_bytes());
    facts.add("warnings",
              player->lost().empty() ? std::vector<std::string>{} : std::vector<std::string>{player->lost()});
    return facts;
}

/// A trace's head: "AABT", version, boxes, frames, a flag byte a box (padded to 4), then 24 bytes a box and frame.
Result<Facts> trace_facts(const InfoOptions& options, const FileStart& start) {
    const auto refused = [&](std::string at, std::string problem) {
        return Error{Status::Format, options.file + ": byte " + at, std::move(problem), {}};
    };
    if (start.bytes.size() < 16)
        return refused("0", fmt::format("found {} bytes, need a head of 16", start.bytes.size()));
    const auto u32 = [&](std::size_t offset) {
        std::uint32_t value = 0;
        for (std::size_t i = 0; i < 4; ++i) value |= std::to_integer<std::uint32_t>(start.bytes[offset + i]) << (8 * i);
        return value;
    };
    const std::uint64_t version = u32(4), boxes = u32(8), frames = u32(12);
    if (version != 1) return refused("4", fmt::format("found trace version {}, this program reads 1", version));
    if (boxes == 0 || frames == 0)
        return refused("8", fmt::format("found {} boxes in {} frames, need at least one of each", boxes, frames));
    // boxes * 24 stays below 2^37; frames are found by division, so that nothing overflows.
    const std::uint64_t head = 16 + (boxes + 3) / 4 * 4, frame = boxes * 24;
    if (start.size < head || (start.size - head) % frame != 0 || (start.size - head) / frame != frames) {
        return refused("8", fmt::format("found {} boxes in {} frames in a file of {} bytes, need a size that fits",
                                        boxes, frames, start.size));
    }
    Facts facts;
    facts.add("kind", "box trace (AABT)");
    facts.add("version", version);
    facts.add("boxes", boxes);
    facts.add("frames", frames);
    facts.add("bytes", start.size);
    facts.add("warnings", std::vector<std::string>{});
    return facts;
}

Result<Facts> facts_of(const InfoOptions& options) {
    const Result<FileStart> start = read_start(options.file, 16);
    if (!start) {
        const bool unfinished = read_start(options.file + ".part", 16).has_value();
        return unfinished ? recording_facts(options) : Result<Facts>(start.error());
    }
    const std::string_view head(reinterpret_cast<const char*>(start->bytes.data()), start->bytes.size());
    if (head.starts_with(record::file_magic.substr(0, 7))) return recording_facts(options);
    if (head.starts_with("AABT")) return trace_facts(options, *start);
    return scene_facts(options);
}

}  // namespace

int run_info(const InfoOptions& options) {
    const Result<Facts> facts = facts_of(options);
    if (!facts) return refuse(facts.error());
    const std::string text = options.json ? facts->json() : facts->lines();
    std::fwrite(text.data(), 1, text.size(), stdout);
    return exit_ok;
}

void add_info(CLI::App& app, Start& start) {
    auto& info = start.options<InfoOptions>();
    CLI::App& command = *app.add_subcommand("info", "Say what a file is and what is in it");
    add_text(command, "FILE", "A scene or a recording", info.file)->required();
    add_json(command, info.json);
    command.footer("\nExamples:\n  fase info scene.glb\n  fase info castle.faserec --json");
    start.on(command, [&info] { return run_info(info); });
}

}  // namespace fase::cli
