/// The BSP tree of a mesh, for the command `fase level`.
#include "cli/level/mesh.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <charconv>
#include <cstdio>
#include <optional>
#include <string_view>

#include "cli/common/clock.hpp"
#include "cli/common/output.hpp"
#include "fase/core/random.hpp"
#include "fase/level/polygon_bsp.hpp"
#include "fase/scene/detail/json.hpp"
#include "fase/scene/gltf.hpp"
#include "fase/scene/obj.hpp"

namespace fase::cli {
namespace {

/// All visible triangles of a glTF scene, in world coordinates.
TriangleMesh mesh_of(const scene::Scene& scene) {
    TriangleMesh all;
    const auto add = [&](const scene::Visual& visual, const Pose& body) {
        const scene::Mesh& mesh = scene.meshes[visual.mesh];
        const auto first = static_cast<std::uint32_t>(all.positions.size());
        for (const Vec3& p : mesh.positions) {
            const Vec3 in_body = visual.linear * p + visual.position;
            all.positions.push_back(to_float(body.position + to_double(rotate(body.rotation, in_body))));
        }
        const bool flipped = determinant(visual.linear) < 0;
        for (std::size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
            const std::uint32_t a = mesh.indices[i], b = mesh.indices[i + 1], c = mesh.indices[i + 2];
            all.indices.insert(all.indices.end(), {first + a, first + (flipped ? c : b), first + (flipped ? b : c)});
        }
    };
    for (const scene::Body& body : scene.bodies)
        for (const scene::Visual& visual : body.visuals) add(visual, {body.def.position, body.def.rotation});
    for (const scene::Visual& visual : scene.scenery) add(visual, {});
    return all;
}

Result<TriangleMesh> read_mesh(const LevelMeshCommand& command) {
    if (command.is_obj) return scene::read_obj(command.file);
    const Result<scene::Scene> scene = scene::read_gltf(command.file);
    if (!scene) return scene.error();
    return mesh_of(*scene);
}

Result<std::optional<Vec3d>> point_of(const std::string& text) {
    if (text.empty()) return std::optional<Vec3d>();
    Vec3d point;
    const char* at = text.data();
    const char* end = at + text.size();
    for (int axis = 0; axis < 3; ++axis) {
        const auto [stop, code] = std::from_chars(at, end, point[axis]);
        const bool good = code == std::errc{} && (axis < 2 ? stop != end && *stop == ',' : stop == end);
        if (!good || !(std::abs(point[axis]) <= 1e9)) {
            return Error{Status::BadArgument,
                         "--point",
                         fmt::format("found \"{}\"; expected X,Y,Z, three numbers within 1e9", printable(text, 60)),
                         {}};
        }
        at = stop + 1;
    }
    return std::optional(point);
}

/// Results of rays through the tree, and of their check against the reference (all triangles).
struct RayResults {
    std::uint64_t cast = 0, hits = 0, checked = 0, wrong = 0;
    double ms = 0;
};

RayResults cast_rays(const level::PolygonBsp& tree, std::uint64_t count, TaskRunner& tasks) {
    constexpr std::uint64_t max_tests = 400'000'000;  // limit of ray-triangle tests by the reference
    Vec3d lo{1e300, 1e300, 1e300}, hi{-1e300, -1e300, -1e300};
    for (const std::uint32_t i : tree.mesh().indices) {
        lo = min(lo, to_double(tree.mesh().positions[i]));
        hi = max(hi, to_double(tree.mesh().positions[i]));
    }
    const Vec3d margin = (hi - lo) * 0.1;
    std::vector<Ray> rays(count);
    Random random(1);
    const auto random_point = [&] {
        const Vec3d p = lo - margin, q = hi + margin;
        return Vec3d{p.x + (q.x - p.x) * double(random.unit()), p.y + (q.y - p.y) * double(random.unit()),
                     p.z + (q.z - p.z) * double(random.unit())};
    };
    for (Ray& ray : rays) {
        ray.origin = random_point();
        ray.direction = normalized(to_float(random_point() - ray.origin));
    }
    std::vector<std::optional<level::PolygonHit>> hits(count);
    const auto start = Clock::now();
    parallel_ranges(tasks, count, 1024, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i) hits[i] = tree.cast_ray(rays[i]);
    });
    RayResults result;
    result.ms = ms_since(start);
    result.cast = count;
    for (const auto& hit : hits) result.hits += hit ? 1 : 0;
    result.checked = std::min<std::uint64_t>(count, std::max<std::uint64_t>(1, max_tests / tree.stats().triangles));
    std::atomic<std::uint64_t> wrong = 0;
    parallel_ranges(tasks, result.checked, 64, [&](std::size_t begin, std::size_t end) {
        std::uint64_t sum = 0;
        for (std::size_t i = begin; i < end; ++i)
            sum += hits[i] != level::cast_ray_brute_force(tree.mesh(), rays[i]) ? 1 : 0;
        wrong += sum;
    });
    result.wrong = wrong;
    return result;
}

std::string text_of(const level::PolygonBspStats& s, double ms) {
    return fmt::format(
        "{} triangles ({} without surface), {} pieces ({} cuts), {} nodes, {} leaves: {} solid, {} empty{}\n"
        "depth {:.2f} mean, {} worst; {} bytes; {:.1f} ms; {}\n",
        s.triangles, s.dropped, s.pieces, s.splits, s.nodes, s.leaves, s.solid, s.empty,
        s.mixed == 0 ? "" : fmt::format(", {} mixed", s.mixed), s.mean_depth, s.worst_depth, s.bytes, ms,
        s.closed ? "closed" : "not closed: a point is solid if its winding number is above one half");
}

Result<int> build_tree(const LevelMeshCommand& command) {
    const Result<std::optional<Vec3d>> point = point_of(command.point);
    if (!point) return point.error();
    Result<TriangleMesh> mesh = read_mesh(command);
    if (!mesh) return mesh.error();
    const auto tasks = make_thread_runner(command.threads);
    const auto start = Clock::now();
    const Result<level::PolygonBsp> tree = level::PolygonBsp::build(*std::move(mesh), {.tasks = tasks.get()});
    const double ms = ms_since(start);
    if (!tree) {
        Error error = tree.error();
        error.where = command.file + ": " + error.where;
        return error;
    }
    const level::PolygonBspStats& s = tree->stats();
    std::optional<RayResults> rays;
    if (command.rays > 0) rays = cast_rays(*tree, command.rays, *tasks);
    std::string text;
    if (command.json) {
        text = fmt::format(
            "{{\"mesh\": {}, \"triangles\": {}, \"dropped\": {}, \"pieces\": {}, \"splits\": {}, \"nodes\": {}, "
            "\"leaves\": {}, \"solid\": {}, \"empty\": {}, \"mixed\": {}, \"mean_depth\": {:.6g}, \"worst_depth\": {}, "
            "\"closed\": {}, \"bytes\": {}, \"ms\": {:.3f}",
            scene::quoted(command.file), s.triangles, s.dropped, s.pieces, s.splits, s.nodes, s.leaves, s.solid,
            s.empty, s.mixed, s.mean_depth, s.worst_depth, s.closed, s.bytes, ms);
        if (*point) text += fmt::format(", \"point_solid\": {}", tree->is_solid(**point));
        if (rays)
            text +=
                fmt::format(", \"rays\": {{\"cast\": {}, \"met\": {}, \"checked\": {}, \"wrong\": {}, \"ms\": {:.3f}}}",
                            rays->cast, rays->hits, rays->checked, rays->wrong, rays->ms);
        text += "}\n";
    } else {
        text = text_of(s, ms);
        if (*point)
            text += fmt::format("({:g}, {:g}, {:g}) is {}\n", (*point)->x, (*point)->y, (*point)->z,
                                tree->is_solid(**point) ? "solid" : "empty");
        if (rays)
            text += fmt::format("{} rays, {} hits, {:.1f} ms; {} checked against all triangles: {} wrong\n", rays->cast,
                                rays->hits, rays->ms, rays->checked, rays->wrong);
    }
    std::fwrite(text.data(), 1, text.size(), stdout);
    return rays && rays->wrong > 0 ? exit_check_failed : exit_ok;
}

}  // namespace

int run_level_mesh(const LevelMeshCommand& command) {
    const Result<int> code = build_tree(command);
    return code ? *code : refuse(code.error());
}

}  // namespace fase::cli
