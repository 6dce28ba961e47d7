/// Builds a scene from a level of a WAD file: static solids, and dynamic bodies in its rooms.
#include "cli/level/scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_map>

#include "cli/common/output.hpp"
#include "fase/core/detail/file_kind.hpp"
#include "fase/level/bsp_compiler.hpp"
#include "fase/level/level_room.hpp"
#include "fase/level/level_solids.hpp"
#include "fase/scene/generate/builder.hpp"

namespace fase::cli {
namespace {

constexpr std::size_t max_bodies = 100'000;
constexpr float max_radius = 0.42f;  // metres: bound of every body around its centre
constexpr int tries_per_body = 40;   // random positions

/// Occupied positions, in a hash grid with cells of twice the maximum radius.
class OccupiedPlaces {
public:
    /// Adds a position; false if another one is too near.
    bool try_insert(Vec3d p) {
        const double size = 2 * max_radius;
        const std::int64_t x = cell(p.x / size), y = cell(p.y / size), z = cell(p.z / size);
        for (std::int64_t i = 0; i < 27; ++i) {
            const auto neighbours = cells_.find(key(x + i % 3 - 1, y + i / 3 % 3 - 1, z + i / 9 - 1));
            if (neighbours == cells_.end()) continue;
            for (const Vec3d& other : neighbours->second)
                if (length_squared(other - p) < size * size) return false;
        }
        cells_[key(x, y, z)].push_back(p);
        return true;
    }

private:
    std::unordered_map<std::uint64_t, std::vector<Vec3d>> cells_;

    static std::int64_t cell(double x) {
        const auto whole = static_cast<std::int64_t>(x);
        return double(whole) > x ? whole - 1 : whole;
    }
    static std::uint64_t key(std::int64_t x, std::int64_t y, std::int64_t z) {
        return (static_cast<std::uint64_t>(x) & 0x1fffff) << 42 | (static_cast<std::uint64_t>(y) & 0x1fffff) << 21 |
               (static_cast<std::uint64_t>(z) & 0x1fffff);
    }
};

/// Adds the level to a scene as one static body.
void add_level(const level::LevelSolids& solids, scene::Scene& scene) {
    scene::Body body;
    body.name = "level";
    body.def.kind = BodyKind::Static;
    for (const level::LevelSolid& solid : solids.solids) {
        scene::Collider collider;
        collider.shape = static_cast<std::uint32_t>(scene.shapes.size());
        collider.def.pose = solid.pose;
        collider.def.user = solid.source;
        scene.shapes.push_back(solid.shape);
        body.colliders.push_back(collider);
    }
    const auto add_visuals = [&](const std::map<int, TriangleMesh>& meshes, const char* name, Vec3 tint) {
        for (const auto& [light, mesh] : meshes) {
            const float brightness = 0.05f + 0.035f * static_cast<float>(light);
            body.visuals.push_back({static_cast<std::uint32_t>(scene.meshes.size()),
                                    {},
                                    Mat3::identity(),
                                    {tint.x * brightness, tint.y * brightness, tint.z * brightness, 1}});
            scene.meshes.push_back({name, mesh.positions, mesh.indices});
        }
    };
    add_visuals(solids.floors, "floors", {0.95f, 0.9f, 0.75f});
    add_visuals(solids.walls, "walls", {0.75f, 0.55f, 0.45f});
    scene.bodies.insert(scene.bodies.begin(), std::move(body));
}

/// Places bodies of all shapes at free positions.
class BodyPlacer {
public:
    BodyPlacer(const level::Map& map, const level::LevelBsp& bsp, std::uint64_t seed)
        : map_(map), bsp_(bsp), random_(seed), builder_(map.name) {
        shapes_ = {builder_.shape(Sphere{0.25f}),           builder_.shape(Box{{0.2f, 0.2f, 0.2f}}),
                   builder_.shape(Capsule{0.18f, 0.2f}),    builder_.shape(Cylinder{0.22f, 0.2f}),
                   builder_.shape(Box{{0.3f, 0.1f, 0.2f}}), builder_.hull(scene::rock_points(random_, 0.3f, 20))};
        for (const level::SubSector& s : bsp.sub_sectors)
            for (const level::Seg& seg : bsp.edges(s)) box_.add(bsp.vertices[seg.from]);
    }

    /// Adds up to `count` bodies; returns how many fit.
    std::size_t add_bodies(std::size_t count) {
        std::size_t added = 0;
        for (std::size_t tries = 0; tries < tries_per_body * count && added < count; ++tries) {
            const std::optional<Vec3d> place = free_place();
            if (!place || !occupied_.try_insert(*place)) continue;
            static constexpr Vec3 colours[] = {{0.8f, 0.2f, 0.15f}, {0.2f, 0.5f, 0.8f}, {0.9f, 0.7f, 0.2f},
                                               {0.3f, 0.65f, 0.3f}, {0.7f, 0.4f, 0.7f}, {0.6f, 0.6f, 0.6f}};
            const std::size_t kind = added++ % shapes_.size();
            const scene::BodyStyle style{
                "thrown", {colours[kind].x, colours[kind].y, colours[kind].z, 1}, 500, {.friction = 0.5f}};
            const Vec3 velocity = scene::random_direction(random_) * random_.between(0, 4);
            scene::Body& body = builder_.add(
                shapes_[kind], style,
                {.position = *place, .rotation = scene::random_rotation(random_), .linear_velocity = velocity});
            body.def.angular_damping = 0.5f;  // so that rolling bodies come to rest
        }
        return added;
    }
    [[nodiscard]] scene::Scene take() { return builder_.take(); }

private:
    const level::Map& map_;
    const level::LevelBsp& bsp_;
    Random random_;
    scene::Builder builder_;
    level::PlanBox box_;
    OccupiedPlaces occupied_;
    std::vector<std::uint32_t> shapes_;

    std::optional<Vec3d> free_place() {
        const level::Point p{box_.lo.x + (box_.hi.x - box_.lo.x) * double(random_.unit()),
                             box_.lo.y + (box_.hi.y - box_.lo.y) * double(random_.unit())};
        const double share = double(random_.unit());
        const auto room = level::clearance_around(bsp_, map_, p, double(max_radius) / level_scale);
        if (!room) return std::nullopt;
        const double low = room->floor * level_scale + double(max_radius),
                     high = room->ceiling * level_scale - double(max_radius);
        if (!(low < high)) return std::nullopt;
        return level::to_world(p, (low + (high - low) * share) / level_scale, level_scale);
    }
};

}  // namespace

bool is_wad(const std::string& path) {
    const Result<FileKind> kind = kind_of_file(path);
    return kind && *kind == FileKind::Wad;
}

Result<LevelScene> load_level_scene(const std::string& path, const std::string& map,
                                    const scene::GenerateOptions& options) {
    if (options.count > max_bodies) {
        return Error{Status::OutOfRange,
                     "--count",
                     fmt::format("found {}; expected at most {} in a level", options.count, max_bodies),
                     {}};
    }
    const Result<level::Wad> wad = level::Wad::read(path);
    if (!wad) return wad.error();
    const std::vector<std::size_t> markers = wad->map_markers();
    if (markers.empty() && map.empty())
        return Error{Status::Format, path, "found no map; expected THINGS and LINEDEFS after a marker", {}};
    Result<level::Map> read = level::read_map(path, *wad, map.empty() ? wad->lumps[markers[0]].name : map);
    if (!read) return read.error();
    LevelScene level;
    level.map = *std::move(read);
    const auto with_map_name = [&](Error error) {
        error.where = fmt::format("{}: {} {}", path, level.map.name, error.where);
        return error;
    };
    Result<level::LevelBsp> bsp = level::compile(level.map);
    if (!bsp) return with_map_name(bsp.error());
    level.bsp = *std::move(bsp);
    const Result<level::LevelSolids> solids = level::make_solids(level.bsp, level.map, {.scale = level_scale});
    if (!solids) return with_map_name(solids.error());

    const std::size_t count = options.count > 0 ? options.count : default_level_bodies;
    BodyPlacer placer(level.map, level.bsp, options.seed);
    const std::size_t added = placer.add_bodies(count);
    level.scene = placer.take();
    add_level(*solids, level.scene);
    for (const std::string& what : level.map.left_out)
        level.scene.warnings.push_back(fmt::format("{}: left out {}", level.map.name, what));
    if (added < count) level.scene.warnings.push_back(fmt::format("only {} of {} bodies fit", added, count));
    return level;
}

std::size_t bodies_outside(const LevelScene& level, const World& world, std::span<const BodyId> ids) {
    std::size_t outside = 0;
    for (const BodyId id : ids) {
        const Result<BodyState> body = world.body(id);
        if (!body || body->kind != BodyKind::Dynamic) continue;
        if (!level::is_inside(level.bsp, level.map, body->centre, level_scale, 0.005)) ++outside;
    }
    return outside;
}

}  // namespace fase::cli
