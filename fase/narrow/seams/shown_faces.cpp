/// The faces that a piece of the ground shows: of a box, a hull or a half-space, in the frame of the moving shape.
#include "fase/narrow/seams/shown_faces.hpp"

#include <algorithm>
#include <cstddef>

namespace fase::narrow {
namespace {

/// Corner k of face `face` of a box, as bits, counter-clockwise seen from outside; in the order of BoxFaces::face().
unsigned corner_bits(int face, int k) {
    const int axis = face >> 1, u = axis == 2 ? 0 : axis + 1, v = u == 2 ? 0 : u + 1;
    const bool positive = (face & 1) == 0;
    const int turn = positive ? k : 3 - k;
    const unsigned side = positive ? 1u << axis : 0u;
    return side | (turn == 1 || turn == 2 ? 1u << u : 0u) | (turn >= 2 ? 1u << v : 0u);
}

}  // namespace

Vec3d nearest_on_segment(Vec3d from, Vec3d to, Vec3d point) {
    const Vec3d along = to - from;
    const double squared = length_squared(along);
    return squared > 0 ? from + along * std::clamp(dot(point - from, along) / squared, 0.0, 1.0) : from;
}

int ShownFaces::count() const {
    if (box_) return 6;
    return hull_ ? static_cast<int>(hull_->faces.size()) : is_half_space_ ? 1 : 0;
}

CoreFace ShownFaces::plane(int face) const {
    Vec3d normal;
    if (box_) {
        const Vec3d axis = pose_.rotation[face >> 1];
        normal = face & 1 ? -axis : axis;
        return {normal, dot(normal, pose_.position) + double(box_->half[face >> 1])};
    }
    if (is_half_space_) return {pose_.rotation.y, dot(pose_.rotation.y, pose_.position)};
    const ConvexHull::Face& one = hull_->faces[static_cast<std::size_t>(face)];
    normal = pose_.rotation * normalized(to_double(one.plane.normal));
    return {normal, dot(normal, corner(face, 0))};
}

int ShownFaces::corner_count(int face) const {
    if (box_) return 4;
    return hull_ ? static_cast<int>(hull_->faces[static_cast<std::size_t>(face)].count) : 0;
}

Vec3d ShownFaces::box_corner(unsigned bits) const {
    const Vec3d half = to_double(box_->half);
    return transform(pose_,
                     Vec3d{bits & 1u ? half.x : -half.x, bits & 2u ? half.y : -half.y, bits & 4u ? half.z : -half.z});
}

Vec3d ShownFaces::corner(int face, int index) const {
    if (box_) return box_corner(corner_bits(face, index));
    const ConvexHull::Face& one = hull_->faces[static_cast<std::size_t>(face)];
    return transform(pose_,
                     to_double(hull_->vertices[hull_->face_vertices[one.first + static_cast<std::size_t>(index)]]));
}

bool ShownFaces::covers(int face, Vec3d point, double grown) const {
    if (is_half_space_) return true;
    if (box_) {
        const Vec3d local = transform_back(pose_, point);
        for (int axis = 0; axis < 3; ++axis)
            if (axis != face >> 1 && std::abs(local[axis]) > double(box_->half[axis]) + grown) return false;
        return true;
    }
    const Vec3d normal = plane(face).normal;
    const int corners = corner_count(face);
    Vec3d from = corner(face, corners - 1);
    for (int i = 0; i < corners; ++i) {
        const Vec3d to = corner(face, i), out = cross(to - from, normal);
        if (dot(out, point - from) > grown * length(out)) return false;
        from = to;
    }
    return true;
}

Vec3d ShownFaces::nearest(int face, Vec3d point) const {
    const CoreFace on = plane(face);
    const Vec3d below = point - on.normal * (dot(on.normal, point) - on.offset);
    if (covers(face, below, 0)) return below;
    const int corners = corner_count(face);
    Vec3d from = corner(face, corners - 1), best = from;
    for (int i = 0; i < corners; ++i) {
        const Vec3d to = corner(face, i), candidate = nearest_on_segment(from, to, below);
        if (length_squared(candidate - below) < length_squared(best - below)) best = candidate;
        from = to;
    }
    return best;
}

}  // namespace fase::narrow
