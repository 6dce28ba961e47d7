#pragma once
/// The interface of a convex shape to the general narrow phase: one function table per kind of shape.
#include <cstdint>

#include "fase/geometry/shapes.hpp"
#include "fase/narrow/detail/buffer.hpp"

namespace fase::narrow {

/// A flat face of a core: dot(normal, p) <= offset for all points of the core. `normal` is unit; frame of the shape.
struct CoreFace {
    Vec3d normal;
    double offset = 0;
};

/// A straight edge of a core, from `from` to `from + along`, between two faces of unit normals `left` and `right`.
struct CoreEdge {
    Vec3d from, along;
    Vec3d left, right;
};

/// One corner of a Feature; `id` is unique among the corners of the shape and stable from step to step (below 2^15).
struct Corner {
    Vec3d position;
    std::uint32_t id = 0;
};

/// The supporting feature of a core in a direction: a face (3 corners or more, counter-clockwise seen from outside), a
/// segment (2) or a point (1). Frame of the shape.
struct Feature {
    static constexpr int capacity = 64;  ///< faces with more corners are subsampled evenly to this many
    Buffer<Corner, capacity> corners;
    int count = 0;
    Vec3d normal;          ///< unit, outward; for a face only
    bool rounded = false;  ///< the corners are samples of the rim of a face, or a line of a curved side
};

/// The functions of one kind of shape; `shape` always points to a shape of that kind.
struct CoreTable {
    Vec3d (*support)(const void* shape, Vec3d direction);
    void (*feature)(const void* shape, Vec3d direction, Feature& out);
    int (*face_count)(const void* shape);
    CoreFace (*face)(const void* shape, int index);
    int (*edge_count)(const void* shape);
    CoreEdge (*edge)(const void* shape, int index);
    bool polyhedral;  ///< faces and edges describe it completely: the core is a polyhedron, a segment or a point
    bool wire;        ///< the edges have no faces (a segment, a cylinder's axis): CoreEdge::left and right are 0
};

/// The core of a convex shape and its radius. Refers to the shape; cheap to copy.
struct CoreView {
    const void* shape = nullptr;
    const CoreTable* table = nullptr;
    double radius = 0;

    /// Returns the farthest point of the core in `direction` (any length), frame of the shape.
    [[nodiscard]] Vec3d support(Vec3d direction) const { return table->support(shape, direction); }
};

/// The faces, edges and features of a shape's core. The primary template is for cores without flat parts; a shape with
/// faces, edges or a flat feature specialises it. Same members as CoreTable, on the shape itself.
template <ConvexShape S> struct CoreFeatures {
    static constexpr bool polyhedral = false, wire = false;
    static int face_count(const S&) { return 0; }
    static CoreFace face(const S&, int) { return {}; }
    static int edge_count(const S&) { return 0; }
    static CoreEdge edge(const S&, int) { return {}; }
    static void feature(const S& shape, Vec3d direction, Feature& out) {
        out.count = 1;
        out.corners[0] = {shape.core_support(direction), 0};
        out.rounded = true;
    }
};

/// A point: its only feature is itself.
template <> struct CoreFeatures<Sphere> {
    static constexpr bool polyhedral = true, wire = true;
    static int face_count(const Sphere&) { return 0; }
    static CoreFace face(const Sphere&, int) { return {}; }
    static int edge_count(const Sphere&) { return 0; }
    static CoreEdge edge(const Sphere&, int) { return {}; }
    static void feature(const Sphere&, Vec3d, Feature& out) {
        out.count = 1;
        out.corners[0] = {};
        out.rounded = false;
    }
};

/// A segment.
template <> struct CoreFeatures<Capsule> {
    static constexpr bool polyhedral = true, wire = true;
    static int face_count(const Capsule&) { return 0; }
    static CoreFace face(const Capsule&, int) { return {}; }
    static int edge_count(const Capsule& c) { return c.half_length > 0 ? 1 : 0; }
    static CoreEdge edge(const Capsule& c, int) {
        const double h = c.half_length;
        return {{0, -h, 0}, {0, 2 * h, 0}, {}, {}};
    }
    static void feature(const Capsule& c, Vec3d, Feature& out) {
        const double h = c.half_length;
        out.count = h > 0 ? 2 : 1;
        out.corners[0] = {{0, -h, 0}, 0};
        out.corners[1] = {{0, h, 0}, 1};
        out.rounded = false;
    }
};

template <> struct CoreFeatures<Box> {
    static constexpr bool polyhedral = true, wire = false;
    static int face_count(const Box&) { return 6; }
    static CoreFace face(const Box& box, int index);
    static int edge_count(const Box&) { return 12; }
    static CoreEdge edge(const Box& box, int index);
    static void feature(const Box& box, Vec3d direction, Feature& out);
};

template <> struct CoreFeatures<ConvexHull> {
    static constexpr bool polyhedral = true, wire = false;
    static int face_count(const ConvexHull& hull) { return static_cast<int>(hull.faces.size()); }
    static CoreFace face(const ConvexHull& hull, int index);
    static int edge_count(const ConvexHull& hull) { return static_cast<int>(hull.edges.size()); }
    static CoreEdge edge(const ConvexHull& hull, int index);
    static void feature(const ConvexHull& hull, Vec3d direction, Feature& out);
};

/// Two flat caps, sampled by 12 points of the rim that rotate with the shape, and a line of the side. Its axis is its
/// only edge: the normals of the side are perpendicular to it.
template <> struct CoreFeatures<Cylinder> {
    static constexpr bool polyhedral = false, wire = true;
    static int face_count(const Cylinder&) { return 2; }
    static CoreFace face(const Cylinder& cylinder, int index) {
        return {{0, index == 0 ? 1.0 : -1.0, 0}, cylinder.half_height};
    }
    static int edge_count(const Cylinder&) { return 1; }
    static CoreEdge edge(const Cylinder& cylinder, int) {
        return {{0, -double(cylinder.half_height), 0}, {0, 2 * double(cylinder.half_height), 0}, {}, {}};
    }
    static void feature(const Cylinder& cylinder, Vec3d direction, Feature& out);
};

/// The function table of S.
template <ConvexShape S>
inline constexpr CoreTable core_table{
    [](const void* s, Vec3d d) { return static_cast<const S*>(s)->core_support(d); },
    [](const void* s, Vec3d d, Feature& out) { CoreFeatures<S>::feature(*static_cast<const S*>(s), d, out); },
    [](const void* s) { return CoreFeatures<S>::face_count(*static_cast<const S*>(s)); },
    [](const void* s, int i) { return CoreFeatures<S>::face(*static_cast<const S*>(s), i); },
    [](const void* s) { return CoreFeatures<S>::edge_count(*static_cast<const S*>(s)); },
    [](const void* s, int i) { return CoreFeatures<S>::edge(*static_cast<const S*>(s), i); },
    CoreFeatures<S>::polyhedral,
    CoreFeatures<S>::wire};

/// Returns a view of `shape`, which must outlive it.
template <ConvexShape S> [[nodiscard]] CoreView core_view(const S& shape) {
    return {&shape, &core_table<S>, shape.core_radius()};
}

}  // namespace fase::narrow
