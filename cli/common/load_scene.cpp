/// Loads scenes and boxes by the names of the command line: files or generated kinds.
#include "cli/common/load_scene.hpp"

#include <sys/stat.h>

#include <cstring>

#include "cli/common/output.hpp"
#include "cli/level/scene.hpp"
#include "fase/core/detail/files.hpp"
#include "fase/geometry/bounds.hpp"
#include "fase/record/trace.hpp"
#include "fase/scene/gltf.hpp"

namespace fase::cli {
namespace {

bool exists(const std::string& path) {
    struct stat info {};
    return ::stat(path.c_str(), &info) == 0;
}

bool is_trace(const std::string& path) {
    const Result<FileStart> start = read_start(path, record::trace_magic.size());
    return start && start->bytes.size() == record::trace_magic.size() &&
           std::memcmp(start->bytes.data(), record::trace_magic.data(), record::trace_magic.size()) == 0;
}

}  // namespace

Result<scene::Scene> load_scene(const std::string& name, const scene::GenerateOptions& options) {
    if (is_wad(name)) {
        Result<LevelScene> level = load_level_scene(name, {}, options);
        if (!level) return level.error();
        return std::move(level->scene);
    }
    if (exists(name)) return scene::read_gltf(name);
    std::string kinds;
    for (const scene::Generator& kind : scene::generators()) {
        if (kind.name == name) return scene::generate(kind.name, options);
        kinds += (kinds.empty() ? "" : ", ") + std::string(kind.name);
    }
    return Error{
        Status::Io, printable(name, 200), "no such file; expected a .gltf, .glb or .wad file, or one of " + kinds, {}};
}

Result<std::vector<Aabb>> load_boxes(const std::string& name) {
    std::vector<Aabb> boxes;
    if (is_trace(name)) {
        Result<record::TraceReader> trace = record::TraceReader::open(name);
        if (!trace) return trace.error();
        if (const Result<bool> read = trace->next(boxes); !read) return read.error();
        return boxes;
    }
    const Result<scene::Scene> scene = load_scene(name);
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
