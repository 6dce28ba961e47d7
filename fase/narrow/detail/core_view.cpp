/// Faces, edges and features of boxes, hulls and cylinders.
#include "fase/narrow/detail/core_view.hpp"

#include <array>
#include <limits>

namespace fase::narrow {
namespace {

/// Returns the next axis in cyclic order, so that (axis, next, next of next) is right-handed.
constexpr int next_axis(int axis) { return axis == 2 ? 0 : axis + 1; }

/// Returns the corner of a box by its id: bit k set means the positive side of axis k.
Vec3d box_corner(const Box& box, std::uint32_t id) {
    return {(id & 1) ? double(box.half.x) : -double(box.half.x), (id & 2) ? double(box.half.y) : -double(box.half.y),
            (id & 4) ? double(box.half.z) : -double(box.half.z)};
}

/// Returns the outward unit normal of a hull's face from its corners (Newell's method), exact to double precision.
Vec3d face_normal(const ConvexHull& hull, const ConvexHull::Face& face) {
    const Vec3d origin = to_double(hull.vertices[hull.face_vertices[face.first]]);
    Vec3d sum;
    for (std::uint32_t i = 1; i + 1 < face.count; ++i) {
        const Vec3d u = to_double(hull.vertices[hull.face_vertices[face.first + i]]) - origin;
        const Vec3d v = to_double(hull.vertices[hull.face_vertices[face.first + i + 1]]) - origin;
        sum += cross(u, v);
    }
    const double l = length(sum);
    return l > 0 ? sum * (1 / l) : to_double(face.plane.normal);
}

}  // namespace

CoreFace CoreFeatures<Box>::face(const Box& box, int index) {
    const int axis = index >> 1;
    Vec3d normal;
    normal[axis] = (index & 1) ? -1 : 1;
    return {normal, box.half[axis]};
}

CoreEdge CoreFeatures<Box>::edge(const Box& box, int index) {
    const int axis = index >> 2, u = next_axis(axis), v = next_axis(u);
    CoreEdge edge;
    edge.from[axis] = -double(box.half[axis]);
    edge.along[axis] = 2 * double(box.half[axis]);
    edge.left[u] = (index & 1) ? 1 : -1;
    edge.right[v] = (index & 2) ? 1 : -1;
    edge.from[u] = edge.left[u] * box.half[u];
    edge.from[v] = edge.right[v] * box.half[v];
    return edge;
}

void CoreFeatures<Box>::feature(const Box& box, Vec3d direction, Feature& out) {
    const Vec3d size = abs(direction);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const bool positive = direction[axis] >= 0;
    const std::uint32_t bit = 1u << axis, u = 1u << next_axis(axis), v = 1u << next_axis(next_axis(axis));
    const std::uint32_t side = positive ? bit : 0;
    const std::array<std::uint32_t, 4> ids{side, side | u, side | u | v, side | v};
    out.count = 4;
    for (int i = 0; i < 4; ++i) {
        const std::uint32_t id = ids[static_cast<std::size_t>(positive ? i : 3 - i)];
        out.corners[static_cast<std::size_t>(i)] = {box_corner(box, id), id};
    }
    out.normal = {};
    out.normal[axis] = positive ? 1 : -1;
    out.rounded = false;
}

CoreFace CoreFeatures<ConvexHull>::face(const ConvexHull& hull, int index) {
    const ConvexHull::Face& face = hull.faces[static_cast<std::size_t>(index)];
    CoreFace result{face_normal(hull, face), -std::numeric_limits<double>::infinity()};
    for (std::uint32_t i = 0; i < face.count; ++i) {
        const double along = dot(result.normal, to_double(hull.vertices[hull.face_vertices[face.first + i]]));
        if (along > result.offset) result.offset = along;
    }
    return result;
}

CoreEdge CoreFeatures<ConvexHull>::edge(const ConvexHull& hull, int index) {
    const ConvexHull::Edge& edge = hull.edges[static_cast<std::size_t>(index)];
    const Vec3d from = to_double(hull.vertices[edge.from]);
    return {from, to_double(hull.vertices[edge.to]) - from, to_double(hull.faces[edge.face_a].plane.normal),
            to_double(hull.faces[edge.face_b].plane.normal)};
}

void CoreFeatures<ConvexHull>::feature(const ConvexHull& hull, Vec3d direction, Feature& out) {
    const Vec3 d = to_float(direction);
    std::size_t best = 0;
    float max_along = 0;
    for (std::size_t i = 0; i < hull.faces.size(); ++i) {
        const float along = dot(hull.faces[i].plane.normal, d);
        if (i == 0 || along > max_along) {
            best = i;
            max_along = along;
        }
    }
    const ConvexHull::Face& face = hull.faces[best];
    const auto total = static_cast<int>(face.count);
    out.count = total < Feature::capacity ? total : Feature::capacity;
    for (int i = 0; i < out.count; ++i) {
        const auto corner = static_cast<std::uint32_t>(static_cast<long long>(i) * total / out.count);
        const std::uint32_t id = hull.face_vertices[face.first + corner];
        out.corners[static_cast<std::size_t>(i)] = {to_double(hull.vertices[id]), id & 0x7FFF};
    }
    out.normal = face_normal(hull, face);
    out.rounded = false;
}

void CoreFeatures<Cylinder>::feature(const Cylinder& cylinder, Vec3d direction, Feature& out) {
    constexpr double half = 0.5, root = 0.86602540378443864676;  // cosines of 60 and 30 degrees
    constexpr std::array<double, 12> cosine{1, root, half, 0, -half, -root, -1, -root, -half, 0, half, root};
    const double r = cylinder.radius, h = cylinder.half_height;
    const double sideways = std::sqrt(direction.x * direction.x + direction.z * direction.z);
    out.rounded = true;
    if (sideways > std::abs(direction.y)) {
        const Vec3d out_of_axis{direction.x / sideways, 0, direction.z / sideways};
        out.count = 2;
        out.normal = out_of_axis;
        out.corners[0] = {{r * out_of_axis.x, -h, r * out_of_axis.z}, 24};
        out.corners[1] = {{r * out_of_axis.x, h, r * out_of_axis.z}, 25};
        return;
    }
    const bool top = direction.y >= 0;
    out.count = 12;
    out.normal = {0, top ? 1.0 : -1.0, 0};
    for (std::uint32_t i = 0; i < 12; ++i) {
        const std::uint32_t k = top ? 11 - i : i;  // counter-clockwise about +y goes from x to -z
        out.corners[i] = {{r * cosine[k], top ? h : -h, r * cosine[(k + 9) % 12]}, k + (top ? 12u : 0u)};
    }
}

}  // namespace fase::narrow
