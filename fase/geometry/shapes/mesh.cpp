/// The functions of the triangle mesh.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "fase/core/detail/text.hpp"
#include "fase/geometry/detail/shape_functions.hpp"

namespace fase::detail {
namespace {

Vec3d scaled_point(const Mesh& mesh, Vec3 p) {
    // Products of floats are exact in double; the shape's own corners are rounded to float.
    return {double(p.x * mesh.scale.x), double(p.y * mesh.scale.y), double(p.z * mesh.scale.z)};
}

Aabb local_box(const Mesh& mesh) {
    const Aabb box = mesh.data->bounds();
    const Vec3 a = to_float(scaled_point(mesh, box.lo)), b = to_float(scaled_point(mesh, box.hi));
    return {min(a, b), max(a, b)};
}

}  // namespace

/// The box around the mesh's rotated box: larger than a box around the rotated vertices, but it takes no time.
Aabb bounds_of(const Mesh& mesh, const Pose& pose) {
    const Aabb box = local_box(mesh);
    const Mat3d r = rotation_matrix(pose.rotation);
    const Vec3d centre = (to_double(box.lo) + to_double(box.hi)) * 0.5, half = to_double(box.hi) - centre;
    const Vec3d middle = r * centre, reach = abs(r.x) * half.x + abs(r.y) * half.y + abs(r.z) * half.z;
    return box_at(pose.position, middle - reach, middle + reach);
}

float outer_radius_of(const Mesh& mesh) {
    double farthest = 0;
    for (const Vec3 v : mesh.data->vertices()) farthest = std::max(farthest, length_squared(scaled_point(mesh, v)));
    return float_above(std::sqrt(farthest));
}

float inner_radius_of(const Mesh&) { return 0; }

Solid solid_of(const Mesh&, double) { return {}; }

TriangleMesh mesh_of(const Mesh& mesh, int) {
    TriangleMesh out;
    for (const Vec3 v : mesh.data->vertices()) out.positions.push_back(to_float(scaled_point(mesh, v)));
    std::vector<std::uint32_t> order(mesh.data->size());
    std::iota(order.begin(), order.end(), 0u);
    std::ranges::sort(order, {}, [&](std::uint32_t place) { return mesh.data->number(place); });
    for (const std::uint32_t place : order) {
        auto [a, b, c] = mesh.data->corners(place);
        if (mesh.is_mirrored()) std::swap(b, c);
        out.indices.insert(out.indices.end(), {a, b, c});
    }
    return out;
}

/// A map along the axes changes the scale; any other one makes new vertices.
Result<RotatedShape> image_of(const Mesh& mesh, const LinearMap& map) {
    const Mat3d& m = map.matrix;
    if (m.x.y == 0 && m.x.z == 0 && m.y.x == 0 && m.y.z == 0 && m.z.x == 0 && m.z.y == 0) {
        const Vec3 s = to_float(Vec3d{m.x.x, m.y.y, m.z.z});
        return RotatedShape{Mesh{mesh.data, {mesh.scale.x * s.x, mesh.scale.y * s.y, mesh.scale.z * s.z}}, {}};
    }
    std::vector<Vec3> vertices;
    for (const Vec3 v : mesh.data->vertices()) vertices.push_back(to_float(m * scaled_point(mesh, v)));
    std::vector<std::array<std::uint32_t, 3>> corners;
    std::vector<std::uint32_t> numbers;
    const bool mirrored = mesh.is_mirrored() != (determinant(m) < 0);
    for (std::size_t t = 0; t < mesh.data->size(); ++t) {
        auto [a, b, c] = mesh.data->corners(t);
        if (mirrored) std::swap(b, c);
        corners.push_back({a, b, c});
        numbers.push_back(mesh.data->number(t));
    }
    const std::span<const std::uint8_t> materials = mesh.data->materials();
    auto built = assemble_mesh(std::move(vertices), std::move(corners), std::move(numbers),
                               {materials.begin(), materials.end()}, mesh.data->report(), mesh.data->two_sided());
    if (!built) return built.error();
    return RotatedShape{Mesh{*std::move(built)}, {}};
}

Result<void> check_of(const Mesh& mesh) {
    const auto wrong = [](const char* where, std::string found, const char* expected) {
        return Error{Status::BadArgument, where, "found " + found + "; expected " + expected, ""};
    };
    if (mesh.data == nullptr || mesh.data->size() == 0)
        return wrong("mesh.data", "no triangles", "data that CollisionMesh::build() returned");
    for (int axis = 0; axis < 3; ++axis) {
        const float size = std::abs(mesh.scale[axis]);
        if (!(size >= Mesh::min_scale && size <= Mesh::max_scale))
            return wrong("mesh.scale", format("{}", mesh.scale[axis]), "a size from 1e-4 to 1e4");
    }
    const Aabb box = local_box(mesh);
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::max(-box.lo[axis], box.hi[axis]) <= max_shape_size))
            return wrong("mesh", format("a coordinate of {} m", std::max(-box.lo[axis], box.hi[axis])),
                         "at most 1e5 m");
    return {};
}

Aabb unscaled(const Mesh& mesh, const Aabb& box) {
    if (mesh.scale == Vec3{1, 1, 1}) return box;
    Aabb result;
    for (int axis = 0; axis < 3; ++axis) {
        const double a = double(box.lo[axis]) / mesh.scale[axis], b = double(box.hi[axis]) / mesh.scale[axis];
        // Twice: the scaled corners were rounded, too.
        result.lo[axis] = float_below(float_below(std::min(a, b)));
        result.hi[axis] = float_above(float_above(std::max(a, b)));
    }
    return result;
}

}  // namespace fase::detail
