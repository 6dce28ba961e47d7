/// Generates the scenes of `fase bench queries` and their queries; reads OBJ files.
#include "bench/query_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "fase/core/detail/file_kind.hpp"
#include "fase/core/detail/files.hpp"
#include "fase/core/detail/text.hpp"
#include "fase/core/random.hpp"

namespace fase::bench {
namespace {

constexpr std::size_t max_bytes = std::size_t{1} << 28;
constexpr std::size_t pile_frames = 60;

Vec3 point_in(Random& random, const Aabb& box) {
    const float x = random.between(box.lo.x, box.hi.x), y = random.between(box.lo.y, box.hi.y),
                z = random.between(box.lo.z, box.hi.z);
    return {x, y, z};
}
Vec3 random_direction(Random& random) {
    for (;;) {
        const Vec3d point = to_double(point_in(random, {{-1, -1, -1}, {1, 1, 1}}));
        const double size = length(point);
        if (size > 0.1 && size <= 1) return to_float(point * (1 / size));
    }
}

/// The frustum of a camera with a view 70 degrees wide and 42 degrees high.
Frustum camera(Vec3d eye, Vec3d ahead, double far) {
    const Vec3d beside = cross(ahead, Vec3d{0, 1, 0});
    const Vec3d right = beside * (1 / length(beside)), up = cross(right, ahead);
    Frustum frustum;
    const auto side = [](Vec3d normal, Vec3d on) {
        const Vec3d unit = normal * (1 / length(normal));
        return Frustum::Side{unit, dot(unit, on)};
    };
    constexpr double wide = 0.7, high = 0.39;
    frustum.sides = {side(right * -1 - ahead * wide, eye), side(right - ahead * wide, eye),
                     side(up * -1 - ahead * high, eye),    side(up - ahead * high, eye),
                     side(ahead * -1, eye + ahead * 0.1),  side(ahead, eye + ahead * far)};
    return frustum;
}

/// Generates rays and cameras at random points in the bounds of the boxes, and query boxes of twice their mean size.
SceneQueries random_queries(const std::vector<broad::Move>& boxes, const QueryCounts& counts) {
    Random random(7);
    Aabb bounds;
    Vec3d sizes;
    for (const broad::Move& m : boxes) {
        bounds = merge(bounds, m.box);
        sizes = sizes + to_double(extent(m.box));
    }
    const Vec3 half = to_float(sizes * (1 / static_cast<double>(std::max<std::size_t>(boxes.size(), 1))));
    SceneQueries queries;
    for (std::size_t i = 0; i < counts.rays; ++i) {
        Ray ray;
        ray.origin = to_double(point_in(random, bounds));
        ray.direction = random_direction(random);
        queries.rays.push_back(ray);
    }
    for (std::size_t i = 0; i < counts.boxes; ++i) {
        const Vec3 at = point_in(random, bounds);
        queries.boxes.push_back({at - half, at + half});
    }
    const double far = length(to_double(extent(bounds)));
    for (std::size_t i = 0; i < counts.frusta; ++i) {
        Vec3d ahead = to_double(random_direction(random));
        ahead.y *= 0.3;
        if (std::abs(ahead.x) + std::abs(ahead.z) < 0.1) ahead.x = 1;
        ahead = ahead * (1 / length(ahead));
        queries.frusta.push_back(camera(to_double(point_in(random, bounds)), ahead, far));
    }
    return queries;
}

/// Adds the bounding box of each triangle.
void add_triangle_boxes(QueryScene& scene) {
    for (std::size_t i = 0; i + 2 < scene.mesh.indices.size(); i += 3) {
        Aabb box;
        for (std::size_t k = i; k < i + 3; ++k) {
            const Vec3 at = scene.mesh.positions[scene.mesh.indices[k]];
            box = merge(box, {at, at});
        }
        scene.boxes.push_back({static_cast<broad::Proxy>(i / 3), box});
    }
}

/// Returns the next word of a line and removes it; "" at the end.
std::string_view next_word(std::string_view& line) {
    const std::size_t begin = std::min(line.find_first_not_of(" \t\r"), line.size());
    const std::size_t end = std::min(line.find_first_of(" \t\r", begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

bool read_vertex(std::string_view line, std::vector<Vec3>& positions) {
    Vec3 at;
    for (int axis = 0; axis < 3; ++axis) {
        const std::string_view word = next_word(line);
        const auto read = std::from_chars(word.data(), word.data() + word.size(), at[axis]);
        if (read.ec != std::errc() || !(std::abs(at[axis]) <= 1e9f)) return false;
    }
    positions.push_back(at);
    return true;
}

bool read_face(std::string_view line, TriangleMesh& mesh) {
    std::vector<std::uint32_t> corners;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
        long long number = 0;  // "7" or "7/1/3"; counts from 1; negative: from the last vertex
        const auto read = std::from_chars(word.data(), word.data() + word.size(), number);
        const auto count = static_cast<long long>(mesh.positions.size());
        const long long index = number < 0 ? count + number : number - 1;
        if (read.ec != std::errc() || index < 0 || index >= count) return false;
        corners.push_back(static_cast<std::uint32_t>(index));
    }
    for (std::size_t i = 2; i < corners.size(); ++i)
        mesh.indices.insert(mesh.indices.end(), {corners[0], corners[i - 1], corners[i]});
    return corners.size() >= 3;
}

}  // namespace

void QueryScene::boxes_at(std::size_t frame, std::vector<broad::Move>& out) const {
    out = boxes;
    for (broad::Move& m : out) {
        const Vec3d at = to_double(centre(m.box));
        const double from_axis = std::sqrt(at.x * at.x + at.z * at.z);
        const double angle = 0.4 * static_cast<double>(frame) / (1 + from_axis);
        // A rotation without sine and cosine: the same bits on every machine.
        const double half = angle / 2, scale = 1 / (1 + half * half);
        const double c = (1 - half * half) * scale, s = 2 * half * scale;
        const Vec3 by = to_float(Vec3d{c * at.x - s * at.z, at.y, s * at.x + c * at.z} - at);
        m.box = {m.box.lo + by, m.box.hi + by};
    }
}

QueryScene static_boxes(const QueryCounts& counts) {
    QueryScene scene;
    scene.name = "static";
    const std::size_t count = counts.items != 0 ? counts.items : 1000000;
    const float side = 5 * static_cast<float>(std::cbrt(static_cast<double>(count)));
    Random random(1);
    for (broad::Proxy p = 0; p < count; ++p) {
        const Vec3 at = point_in(random, {{0, 0, 0}, {side, side, side}});
        const Vec3 half = point_in(random, {{0.1f, 0.1f, 0.1f}, {1, 1, 1}});
        scene.boxes.push_back({p, {at - half, at + half}});
    }
    scene.queries = random_queries(scene.boxes, counts);
    return scene;
}

QueryScene stirred_pile(const QueryCounts& counts) {
    QueryScene scene;
    scene.name = "pile";
    scene.frames = pile_frames;
    const std::size_t count = std::max<std::size_t>((counts.items != 0 ? counts.items : 1000000) / 50, 1);
    const float radius = 1.1f * static_cast<float>(std::cbrt(static_cast<double>(count)));
    Random random(2);
    while (scene.boxes.size() < count) {
        const Vec3 at = point_in(random, {{-radius, 0, -radius}, {radius, radius / 2, radius}});
        const float reach = radius - 2 * at.y;
        if (at.x * at.x + at.z * at.z > reach * reach) continue;
        const Vec3 half = point_in(random, {{0.2f, 0.2f, 0.2f}, {0.5f, 0.5f, 0.5f}});
        scene.boxes.push_back({static_cast<broad::Proxy>(scene.boxes.size()), {at - half, at + half}});
    }
    scene.queries = random_queries(scene.boxes, counts);
    return scene;
}

Result<QueryScene> level_from(const std::string& obj_file, const QueryCounts& counts) {
    const Result<std::vector<std::byte>> bytes = read_file(obj_file, max_bytes);
    if (!bytes) return bytes.error();
    if (const FileKind kind = kind_of(*bytes); kind != FileKind::Obj && kind != FileKind::Other)
        return wrong_kind(obj_file, kind, "a mesh as OBJ text");
    std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    QueryScene scene;
    const std::size_t slash = obj_file.rfind('/');
    scene.name = "level: " + (slash == std::string::npos ? obj_file : obj_file.substr(slash + 1));
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        const std::string_view word = next_word(line);
        const bool valid = word == "v"   ? read_vertex(line, scene.mesh.positions)
                           : word == "f" ? read_face(line, scene.mesh)
                                         : true;
        if (valid) continue;
        return Error{Status::Format,
                     detail::at_line(obj_file, number),
                     word == "v" ? "found a vertex without three numbers; expected x y z"
                                 : "found a face with missing vertices; expected three or more that exist",
                     {}};
    }
    if (scene.mesh.indices.empty()) return Error{Status::Format, obj_file, "found no faces; expected at least one", {}};
    add_triangle_boxes(scene);
    scene.queries = random_queries(scene.boxes, counts);
    return scene;
}

QueryScene generated_level(const QueryCounts& counts) {
    QueryScene scene;
    scene.name = "level";
    Random random(3);
    constexpr std::uint32_t side = 150;
    for (std::uint32_t z = 0; z <= side; ++z) {
        for (std::uint32_t x = 0; x <= side; ++x) {
            const bool tower = x % 10 > 6 && z % 10 > 6;
            const float height = tower ? 8 + random.between(0, 4) : random.between(0, 0.5f);
            scene.mesh.positions.push_back({static_cast<float>(x), height, static_cast<float>(z)});
        }
    }
    for (std::uint32_t z = 0; z < side; ++z) {
        for (std::uint32_t x = 0; x < side; ++x) {
            const std::uint32_t a = z * (side + 1) + x, b = a + 1, c = a + side + 1, d = c + 1;
            scene.mesh.indices.insert(scene.mesh.indices.end(), {a, c, b, b, c, d});
        }
    }
    add_triangle_boxes(scene);
    scene.queries = random_queries(scene.boxes, counts);
    return scene;
}

}  // namespace fase::bench
