/// Loads scenes and boxes by the names of the command line: files or generated kinds.
#include "cli/common/load_scene.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <string_view>

#include "cli/common/output.hpp"
#include "cli/level/scene.hpp"
#include "fase/core/detail/file_kind.hpp"
#include "fase/geometry/bounds.hpp"
#include "fase/record/trace.hpp"
#include "fase/scene/gltf.hpp"

namespace fase::cli {
namespace {

constexpr std::string_view scene_files = "a .gltf, .glb or .wad file";

Result<scene::Scene> load_scene_file(const std::string& name, const scene::GenerateOptions& options,
                                     std::string_view expected) {
    const Result<FileKind> kind = kind_of_file(name);
    if (!kind) return kind.error();
    switch (*kind) {
        case FileKind::Wad: {
            Result<LevelScene> level = load_level_scene(name, {}, options);
            if (!level) return level.error();
            return std::move(level->scene);
        }
        case FileKind::Glb:
        case FileKind::Json:
        case FileKind::Other: return scene::read_gltf(name);
        default: return wrong_kind(name, *kind, expected);
    }
}

Result<scene::Scene> load_any_scene(const std::string& name, const scene::GenerateOptions& options,
                                    std::string_view expected) {
    if (file_exists(name)) return load_scene_file(name, options, expected);
    std::string kinds;
    for (const scene::Generator& kind : scene::generators()) {
        if (kind.name == name) return scene::generate(kind.name, options);
        kinds += (kinds.empty() ? "" : ", ") + std::string(kind.name);
    }
    return Error{
        Status::Io, printable(name, 200), fmt::format("no such file; expected {}, or one of {}", expected, kinds), {}};
}

}  // namespace

bool file_exists(const std::string& path) {
    struct stat info {};
    return ::stat(path.c_str(), &info) == 0;
}

Result<scene::Scene> load_scene(const std::string& name, const scene::GenerateOptions& options) {
    return load_any_scene(name, options, scene_files);
}

Result<std::vector<Aabb>> load_boxes(const std::string& name) {
    std::vector<Aabb> boxes;
    const Result<FileKind> kind = kind_of_file(name);
    if (kind && *kind == FileKind::Trace) {
        Result<record::TraceReader> trace = record::TraceReader::open(name);
        if (!trace) return trace.error();
        if (const Result<bool> read = trace->next(boxes); !read) return read.error();
        return boxes;
    }
    const Result<scene::Scene> scene = load_any_scene(name, {}, "a .gltf, .glb, .wad or .aabt file");
    if (!scene) return scene.error();
    Result<World> world = World::create(scene::settings_for(*scene));
    if (!world) return world.error();
    const Result<std::vector<BodyId>> bodies = scene::instantiate(*scene, *world);
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
        return Error{Status::BadArgument, name, "found a scene without colliders; expected at least one", {}};
    return boxes;
}

}  // namespace fase::cli
