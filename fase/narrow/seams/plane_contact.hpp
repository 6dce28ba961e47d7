#pragma once
/// The contact of a moving convex shape with the plane of one face.
#include <span>

#include "fase/math/transform_d.hpp"
#include "fase/narrow/detail/core_view.hpp"
#include "fase/narrow/manifold.hpp"
#include "fase/narrow/seams/shown_faces.hpp"

namespace fase::narrow {

/// Returns a view of a convex shape; one without a table for others.
[[nodiscard]] CoreView view_of(const Shape& shape);

/// A convex shape at a pose, and the path that it takes.
struct MovingCore {
    CoreView view;
    TransformD pose;
    Vec3d path;

    [[nodiscard]] Vec3d support(Vec3d direction) const {
        return transform(pose, view.support(transpose_times(pose.rotation, direction)));
    }
    /// Metres from a plane to the shape, below 0 when part of it is behind.
    [[nodiscard]] double height(const CoreFace& plane) const {
        return dot(plane.normal, support(-plane.normal)) - plane.offset - view.radius;
    }
};

/// Metres between all places of the shape on its path and another shape; 0 when it touches it.
[[nodiscard]] double clearance_of(const MovingCore& mover, const Shape& other, const TransformD& pose);

/// Where a shape is over a face.
struct OverFace {
    bool now = false;
    bool later = false;  ///< now, or somewhere on its path
};
/// Tests the lowest feature of the shape against the sides of a face, one by one.
[[nodiscard]] OverFace over_face(const MovingCore& mover, const ShownFaces& faces, int face);

/// Notes which corners of the shape's lowest feature above a face are over this face, or come over it on the path.
/// `over`: by corner; entries are only ever set. Returns the number of corners.
int mark_corners_over(const MovingCore& mover, const ShownFaces& faces, int face, std::span<bool> over);

/// Which points a contact with the plane of a face has.
struct PlaneLimits {
    double margin = 0;        ///< metres above the plane, at most
    double depth_beside = 0;  ///< metres below the plane, at most, of points that are not over the face
    bool swept = false;       ///< also the part of the feature that comes over the face on the path
    bool whole = false;       ///< all of the feature
};
/// Returns the contact of the shape's lowest feature with the plane of a face: that part of it that is over the face,
/// or all of it when none is. The normal is that of the face.
[[nodiscard]] Manifold plane_contact(const MovingCore& mover, const ShownFaces& faces, int face,
                                     const PlaneLimits& limits);

}  // namespace fase::narrow
