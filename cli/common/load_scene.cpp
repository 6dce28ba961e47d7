/// Loads scenes and boxes by the names of the command line: files or generated kinds.
#include "cli/common/load_scene.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <string_view>

#include "cli/common/input.hpp"
#include "cli/common/output.hpp"
#include "cli/level/scene.hpp"
#include "fase/geometry/bounds.hpp"
#include "fase/record/generate_trace.hpp"
#include "fase/record/trace.hpp"
#include "fase/scene/gltf.hpp"

namespace fase::cli {
namespace {

constexpr FileKind scene_kinds[]{FileKind::Glb, FileKind::Gltf, FileKind::Wad};
constexpr FileKind box_kinds[]{FileKind::Glb, FileKind::Gltf, FileKind::Wad, FileKind::Trace};

Result<scene::Scene> load_scene_file(const std::string& name, const scene::GenerateOptions& options, FileKind kind) {
    if (kind != FileKind::Wad) return scene::read_gltf(name);
    Result<LevelScene> level = load_level_scene(name, {}, options);
    if (!level) return level.error();
    return std::move(level->scene);
}

/// Generates the scene kind of that name. `expected`: the files that the command reads too.
Result<scene::Scene> generate_scene(const std::string& name, const scene::GenerateOptions& options,
                                    std::string_view expected) {
    std::string kinds;
    for (const scene::Generator& kind : scene::generators()) {
        if (kind.name == name) return scene::generate(kind.name, options);
        kinds += (kinds.empty() ? "" : ", ") + std::string(kind.name);
    }
    for (const record::TraceKind& kind : record::trace_kinds()) {
        if (kind.name == name)
            return Error{Status::BadArgument, name, "found a kind of trace; expected a scene",
                         fmt::format("'fase generate {} -o {}.aabt' writes it for 'fase pairs'", name, name)};
    }
    return Error{
        Status::Io, printable(name, 200), fmt::format("no such file; expected {}, or one of {}", expected, kinds), {}};
}

/// The boxes of a trace's first frame.
Result<std::vector<Aabb>> first_boxes(const std::string& name) {
    Result<record::TraceReader> trace = record::TraceReader::open(name);
    if (!trace) return trace.error();
    std::vector<Aabb> boxes;
    if (const Result<bool> read = trace->next(boxes); !read) return read.error();
    return boxes;
}

/// The exact bounds of all colliders of a scene in its initial state.
Result<std::vector<Aabb>> boxes_of(const scene::Scene& scene, const std::string& name) {
    std::vector<Aabb> boxes;
    Result<World> world = World::create(scene::settings_for(scene));
    if (!world) return world.error();
    const Result<std::vector<BodyId>> bodies = scene::instantiate(scene, *world);
    if (!bodies) {
        Error error = bodies.error();
        error.where = name + ": " + error.where;
        return error;
    }
    for (const BodyId id : *bodies) {
        const Result<BodyState> body = world->body(id);
        if (!body) return body.error();
        for (const ColliderId collider_id : world->colliders_of(id)) {
            const Result<ColliderState> collider = world->collider(collider_id);
            if (!collider) return collider.error();
            boxes.push_back(bounds(*collider->shape, body->pose * collider->def.pose));
        }
    }
    if (boxes.empty())
        return Error{Status::BadArgument, name, "found a scene without colliders; expected at least one",
                     "'fase run' with --auto-colliders and --trace writes boxes of its meshes"};
    return boxes;
}

}  // namespace

bool file_exists(const std::string& path) {
    struct stat info {};
    return ::stat(path.c_str(), &info) == 0;
}

Result<scene::Scene> load_scene(const std::string& name, const scene::GenerateOptions& options) {
    if (!file_exists(name)) return generate_scene(name, options, "a .gltf, .glb or .wad file");
    const Result<FileKind> kind = check_input(name, {"run", "scenes (.gltf, .glb) and levels (.wad)", scene_kinds});
    return kind ? load_scene_file(name, options, *kind) : kind.error();
}

Result<std::vector<Aabb>> load_boxes(const std::string& name) {
    if (!file_exists(name)) {
        const Result<scene::Scene> scene = generate_scene(name, {}, "a .gltf, .glb, .wad or .aabt file");
        return scene ? boxes_of(*scene, name) : scene.error();
    }
    const Result<FileKind> kind =
        check_input(name, {"query", "scenes (.gltf, .glb), levels (.wad) and traces (.aabt)", box_kinds});
    if (!kind) return kind.error();
    if (*kind == FileKind::Trace) return first_boxes(name);
    const Result<scene::Scene> scene = load_scene_file(name, {}, *kind);
    return scene ? boxes_of(*scene, name) : scene.error();
}

}  // namespace fase::cli
