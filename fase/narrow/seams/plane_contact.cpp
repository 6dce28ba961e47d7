/// The contact of a moving convex shape with the plane of one face.
#include "fase/narrow/seams/plane_contact.hpp"

#include <algorithm>
#include <array>
#include <cstddef>

#include "fase/narrow/detail/clip.hpp"
#include "fase/narrow/detail/gjk.hpp"
#include "fase/narrow/detail/infinity.hpp"
#include "fase/narrow/detail/polygon.hpp"

namespace fase::narrow {

CoreView view_of(const Shape& shape) {
    return std::visit(
        [](const auto& s) {
            if constexpr (ConvexShape<std::decay_t<decltype(s)>>) {
                return core_view(s);
            } else {
                return CoreView{};
            }
        },
        shape);
}

namespace {

constexpr double seam_gap = 1e-3;  // metres beyond a face that count as over it, for what comes over it
constexpr double sliver = 1e-4;    // metres inside a face that do not yet count as over it

/// The lowest feature of the shape's core above a plane. A face whose corners miss the lowest point counts as this
/// point.
void find_lowest(const MovingCore& mover, Vec3d up, Feature& lowest) {
    mover.view.table->feature(mover.view.shape, transpose_times(mover.pose.rotation, -up), lowest);
    double least = infinity;
    for (std::size_t i = 0; i < static_cast<std::size_t>(lowest.count); ++i) {
        lowest.corners[i].position = transform(mover.pose, lowest.corners[i].position);
        least = std::min(least, dot(up, lowest.corners[i].position));
    }
    constexpr double rounding = 1e-4;
    const Vec3d bottom = mover.support(-up);
    if (dot(up, bottom) > least - rounding) return;
    lowest.corners[0] = {bottom, 0x3FFF};
    lowest.count = 1;
}

/// The face, swept by `by`, as a reference of clipping; false: it has more corners than a feature, and is not clipped.
/// Source of the sweep: a convex polygon and its copy, joined at the corners between sides that move and those that do
/// not.
bool as_reference(const ShownFaces& faces, int face, Vec3d by, Feature& reference) {
    const int corners = faces.corner_count(face);
    if (corners < 3 || corners + 2 > Feature::capacity) return false;
    reference.count = 0;
    reference.normal = faces.plane(face).normal;
    by = by - reference.normal * dot(reference.normal, by);
    const auto put = [&](Vec3d position) {
        const auto index = static_cast<std::uint32_t>(reference.count++);
        reference.corners[index] = {position, index};
    };
    const auto moves = [&](int i) {  // the side that begins at corner i
        const Vec3d side = faces.corner(face, (i + 1) % corners) - faces.corner(face, i);
        return dot(cross(side, reference.normal), by) > 0;
    };
    bool moved = moves(corners - 1);
    for (int i = 0; i < corners; ++i) {
        const Vec3d corner = faces.corner(face, i);
        const bool next = moves(i);
        if (moved) put(corner + by);
        if (!moved || !next) put(corner);
        if (!moved && next) put(corner + by);
        moved = next;
    }
    return true;
}

/// Points of the contact: on the core, with their heights above the plane.
struct PlanePoints {
    Buffer<ManifoldPoint, ClipPolygon::capacity> points;
    int count = 0;
};

Manifold reduced(const PlanePoints& found, Vec3d normal) {
    Manifold manifold;
    manifold.normal = to_float(normal);
    std::array<int, 4> chosen{0, 1, 2, 3};
    int kept = found.count;
    if (kept > 4) {
        const Vec3 u = to_float(any_perpendicular(normal)), v = cross(manifold.normal, u);
        const auto at = [&](int i) { return found.points[static_cast<std::size_t>(i)].position; };
        kept = choose_four(
            found.count, [&](int i) { return dot(u, at(i) - at(0)); }, [&](int i) { return dot(v, at(i) - at(0)); },
            [&](int i) { return found.points[static_cast<std::size_t>(i)].separation; }, 1e-5f, chosen);
    }
    manifold.count = kept;
    for (std::size_t i = 0; i < static_cast<std::size_t>(kept); ++i)
        manifold.points[i] = found.points[static_cast<std::size_t>(chosen[i])];
    return manifold;
}

/// The volume that a core covers on its path, for GJK, which reads nothing but the support function.
constexpr CoreTable swept_table{[](const void* shape, Vec3d direction) {
                                    const MovingCore& mover = *static_cast<const MovingCore*>(shape);
                                    const Vec3d support = mover.support(direction);
                                    return dot(mover.path, direction) > 0 ? support + mover.path : support;
                                },
                                nullptr,
                                nullptr,
                                nullptr,
                                nullptr,
                                nullptr,
                                false,
                                false};

}  // namespace

double clearance_of(const MovingCore& mover, const Shape& other, const TransformD& pose) {
    const CoreView view = view_of(other);
    if (!view.table) return 0;
    const CoreView swept{&mover, &swept_table, mover.view.radius};
    const GjkResult found = gjk(swept, view, pose, {.tolerance = 1e-6});
    if (found.state == GjkResult::State::Overlap) return 0;
    return std::max(0.0, found.distance - mover.view.radius - view.radius);
}

OverFace over_face(const MovingCore& mover, const ShownFaces& faces, int face) {
    if (faces.is_half_space()) return {true, true};
    const Vec3d normal = faces.plane(face).normal;
    Feature lowest;
    find_lowest(mover, normal, lowest);
    OverFace over{true, true};
    const int corners = faces.corner_count(face);
    Vec3d from = faces.corner(face, corners - 1);
    for (int i = 0; i < corners && over.later; ++i) {
        const Vec3d to = faces.corner(face, i), out = normalized(cross(to - from, normal));
        double beyond = infinity;
        for (std::size_t k = 0; k < static_cast<std::size_t>(lowest.count); ++k)
            beyond = std::min(beyond, dot(out, lowest.corners[k].position - from));
        over.now = over.now && beyond < -sliver;
        over.later = beyond + std::min(0.0, dot(out, mover.path)) <= seam_gap;
        from = to;
    }
    over.now = over.now && over.later;
    return over;
}

int mark_corners_over(const MovingCore& mover, const ShownFaces& faces, int face, std::span<bool> over) {
    Feature lowest, reference;
    find_lowest(mover, faces.plane(face).normal, lowest);
    if (!as_reference(faces, face, -mover.path, reference)) return lowest.count;
    const ClipFrame frame(reference);
    for (std::size_t i = 0; i < static_cast<std::size_t>(lowest.count); ++i)
        over[i] = over[i] || frame.contains(frame.flatten(lowest.corners[i]));
    return lowest.count;
}

Manifold plane_contact(const MovingCore& mover, const ShownFaces& faces, int face, const PlaneLimits& limits) {
    const CoreFace plane = faces.plane(face);
    PlanePoints found;
    const auto add = [&](Vec3d on_core, std::uint32_t name) {
        const double separation = dot(plane.normal, on_core) - plane.offset - mover.view.radius;
        if (separation > limits.margin) return;
        if (!limits.whole && separation < -limits.depth_beside && !faces.covers(face, on_core, seam_gap)) return;
        const Vec3d middle = on_core - plane.normal * (mover.view.radius + separation / 2);
        found.points[static_cast<std::size_t>(found.count++)] = {to_float(middle), static_cast<float>(separation),
                                                                 name};
    };
    Feature lowest, reference;
    find_lowest(mover, plane.normal, lowest);
    if (!limits.whole && as_reference(faces, face, limits.swept ? -mover.path : Vec3d{}, reference)) {
        const ClipFrame frame(reference);
        const ClipPolygon over = frame.clip(lowest);
        for (int i = 0; i < over.count; ++i) {
            const ClipPoint& point = over.points[static_cast<std::size_t>(i)];
            add(frame.lift(point), point.name);
        }
        if (over.count > 0) return reduced(found, plane.normal);
    }
    for (int i = 0; i < lowest.count; ++i) {
        const Corner& corner = lowest.corners[static_cast<std::size_t>(i)];
        add(corner.position, corner.id << 15 | 0x7FFF);
    }
    return reduced(found, plane.normal);
}

}  // namespace fase::narrow
