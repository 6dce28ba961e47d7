/// The command `fase info`: prints the kind and the contents of a file.
#include "cli/info.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <vector>

#include "cli/common/arguments.hpp"
#include "cli/common/command_registry.hpp"
#include "cli/common/facts.hpp"
#include "cli/common/input.hpp"
#include "cli/common/output.hpp"
#include "fase/atlas/png.hpp"
#include "fase/core/detail/files.hpp"
#include "fase/level/map.hpp"
#include "fase/level/wad.hpp"
#include "fase/record/player.hpp"
#include "fase/record/trace.hpp"
#include "fase/scene/gltf.hpp"
#include "fase/scene/obj.hpp"

namespace fase::cli {
namespace {

const char* kind_name(BodyKind kind) {
    switch (kind) {
        case BodyKind::Static: return "static";
        case BodyKind::Kinematic: return "kinematic";
        case BodyKind::Dynamic: return "dynamic";
    }
    return "unknown";
}

Result<Facts> scene_facts(const InfoOptions& options) {
    const Result<scene::Scene> read = scene::read_gltf(options.file);
    if (!read) return read.error();
    const scene::Scene& s = *read;
    std::map<std::string, std::size_t> kinds{{"static", 0}, {"kinematic", 0}, {"dynamic", 0}}, shapes;
    std::size_t colliders = 0, sensors = 0, visuals = s.scenery.size(), triangles = 0;
    for (const scene::Body& body : s.bodies) {
        ++kinds[kind_name(body.def.kind)];
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

std::string coordinates(Vec3 v) { return fmt::format("{} {} {}", v.x, v.y, v.z); }

/// Reads, and so validates, the whole trace.
Result<Facts> trace_facts(const InfoOptions& options) {
    Result<record::TraceReader> trace = record::TraceReader::open(options.file);
    if (!trace) return trace.error();
    std::vector<Aabb> before, boxes;
    Aabb bounds;
    std::size_t infinite = 0, moves = 0, woken = 0, static_boxes = 0, asleep = 0;
    double size_sum = 0;
    float smallest = Aabb::infinity, largest = 0;
    std::vector<std::uint8_t> has_moved(trace->boxes(), 0);
    for (std::uint32_t frame = 0; frame < trace->frames(); ++frame) {
        if (const Result<bool> read = trace->next(boxes); !read) return read.error();
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const Vec3 sides = extent(boxes[i]);
            const float size = std::max({sides.x, sides.y, sides.z});
            const bool is_infinite = !(size < Aabb::infinity);
            if (!is_infinite) bounds = merge(bounds, boxes[i]);
            if (frame == 0) {
                infinite += is_infinite ? 1 : 0;
                size_sum += is_infinite ? 0.0 : double(size);
                smallest = std::min(smallest, size);
                largest = std::max(largest, size);
            } else if (!(boxes[i] == before[i])) {
                has_moved[i] = 1;
                ++moves;
            }
        }
        before.swap(boxes);
    }
    for (std::size_t i = 0; i < trace->boxes(); ++i) {
        const bool is_static = (trace->flags()[i] & record::trace_static) != 0;
        static_boxes += is_static ? 1 : 0;
        if (is_static || (trace->flags()[i] & record::trace_asleep) == 0) continue;
        ++asleep;
        woken += has_moved[i];
    }
    const auto moved = static_cast<std::size_t>(std::count(has_moved.begin(), has_moved.end(), 1));
    Facts facts;
    facts.add("kind", "box trace (AABT)");
    facts.add("version", record::trace_version);
    facts.add("boxes", trace->boxes());
    facts.add("frames", trace->frames());
    facts.add("static", static_boxes);
    facts.add("asleep", asleep);
    facts.add("woken", woken);
    facts.add("moved", moved);
    facts.add("moves_a_frame",
              trace->frames() < 2 ? 0.0 : static_cast<double>(moves) / static_cast<double>(trace->frames() - 1));
    facts.add("infinite", infinite);
    if (infinite < trace->boxes()) {
        facts.add("least_size", smallest);
        facts.add("mean_size", size_sum / static_cast<double>(trace->boxes() - infinite));
    }
    if (infinite == 0) facts.add("largest_size", largest);
    if (!is_empty(bounds)) {
        facts.add("room_least", std::string_view(coordinates(bounds.lo)));
        facts.add("room_largest", std::string_view(coordinates(bounds.hi)));
    }
    facts.add("bytes", trace->bytes());
    facts.add("warnings", std::vector<std::string>{});
    return facts;
}

Result<Facts> wad_facts(const InfoOptions& options) {
    const Result<level::Wad> wad = level::Wad::read(options.file);
    if (!wad) return wad.error();
    std::vector<std::string> maps, warnings;
    for (const std::size_t marker : wad->map_markers()) {
        maps.push_back(wad->lumps[marker].name);
        const Result<level::Map> map = level::read_map(options.file, *wad, maps.back());
        if (!map) warnings.push_back(map.error().text());
    }
    std::size_t bytes = 0;
    for (const level::Lump& lump : wad->lumps) bytes += lump.bytes.size();
    Facts facts;
    facts.add("kind", wad->kind == level::Wad::Kind::Whole ? "WAD of a game (IWAD)" : "WAD of additions (PWAD)");
    facts.add("lumps", wad->lumps.size());
    facts.add("lump_bytes", bytes);
    facts.add("map_count", maps.size());
    facts.add("maps", std::move(maps));
    facts.add("warnings", std::move(warnings));
    return facts;
}

Result<Facts> mesh_facts(const InfoOptions& options) {
    const Result<TriangleMesh> mesh = scene::read_obj(options.file);
    if (!mesh) return mesh.error();
    Aabb bounds;
    for (const std::uint32_t corner : mesh->indices)
        bounds = merge(bounds, {mesh->positions[corner], mesh->positions[corner]});
    Facts facts;
    facts.add("kind", "OBJ mesh");
    facts.add("vertices", mesh->positions.size());
    facts.add("triangles", mesh->indices.size() / 3);
    if (!is_empty(bounds)) {
        facts.add("room_least", std::string_view(coordinates(bounds.lo)));
        facts.add("room_largest", std::string_view(coordinates(bounds.hi)));
    }
    facts.add("warnings", std::vector<std::string>{});
    return facts;
}

Result<Facts> image_facts(const InfoOptions& options) {
    const Result<atlas::Image> image = atlas::read_png_file(options.file);
    if (!image) return image.error();
    Facts facts;
    facts.add("kind", "PNG image");
    facts.add("width", image->size.width);
    facts.add("height", image->size.height);
    facts.add("warnings", std::vector<std::string>{});
    return facts;
}

Result<Facts> facts_of(const InfoOptions& options) {
    static constexpr FileKind kinds[]{FileKind::Recording, FileKind::Trace, FileKind::Wad, FileKind::Glb,
                                      FileKind::Gltf,      FileKind::Obj,   FileKind::Png};
    const Result<FileKind> kind = check_input(
        options.file,
        {"info", "scenes (.gltf, .glb), recordings, traces, levels (.wad), .obj meshes and .png images", kinds});
    if (!kind) {
        const std::string part = options.file + ".part";
        const Result<FileKind> unfinished = kind_of_file(part);
        if (kind.status() != Status::Io || !unfinished) return kind.error();
        if (*unfinished != FileKind::Trace) return recording_facts(options);
        Error error = kind.error();
        error.problem += fmt::format("; found an unfinished trace {}", part);
        error.remedy = fmt::format("'fase info {}' describes it", shell_word(part));
        return error;
    }
    switch (*kind) {
        case FileKind::Recording: return recording_facts(options);
        case FileKind::Trace: return trace_facts(options);
        case FileKind::Wad: return wad_facts(options);
        case FileKind::Obj: return mesh_facts(options);
        case FileKind::Png: return image_facts(options);
        default: return scene_facts(options);
    }
}

}  // namespace

int run_info(const InfoOptions& options) {
    const Result<Facts> facts = facts_of(options);
    if (!facts) return refuse(facts.error());
    const std::string text = options.json ? facts->json() : facts->lines();
    std::fwrite(text.data(), 1, text.size(), stdout);
    return exit_ok;
}

void add_info(Command& program, CommandRegistry& registry) {
    auto& info = registry.options<InfoOptions>();
    Command command = program.add_command("info", "Print the kind and the contents of a file");
    command.add_text("FILE", "A scene, a recording, a trace, a WAD, an OBJ mesh or a PNG image", info.file).required();
    add_json(command, info.json);
    command.set_footer(
        "\nExamples:\n  fase info scene.glb\n  fase info castle.faserec --json\n  fase info rain.aabt\n  fase info "
        "doom.wad");
    registry.on(command, [&info] { return run_info(info); });
}

}  // namespace fase::cli
