#pragma once
/// The faces that a piece of the ground shows: of a box, a hull or a half-space, in the frame of the moving shape.
#include <variant>

#include "fase/geometry/shapes.hpp"
#include "fase/math/transform_d.hpp"
#include "fase/narrow/detail/core_view.hpp"

namespace fase::narrow {

/// A view of a convex piece as a set of flat faces. Pieces without such faces have none: they hide nothing.
class ShownFaces {
public:
    ShownFaces(const Shape& shape, const TransformD& pose)
        : box_(std::get_if<Box>(&shape)),
          hull_(std::get_if<ConvexHull>(&shape)),
          is_half_space_(std::holds_alternative<HalfSpace>(shape)),
          pose_(pose) {}

    [[nodiscard]] int count() const;
    /// A face without bounds.
    [[nodiscard]] bool is_half_space() const { return is_half_space_; }
    /// The plane of a face: dot(normal, p) <= offset for all points of the piece.
    [[nodiscard]] CoreFace plane(int face) const;
    [[nodiscard]] int corner_count(int face) const;
    [[nodiscard]] Vec3d corner(int face, int index) const;
    /// Whether a point may be nearer to the piece than `distance`: exact along the axes of a box, always for others.
    [[nodiscard]] bool is_near(Vec3d point, double distance) const {
        if (!box_) return true;
        const Vec3d local = abs(transform_back(pose_, point)), half = to_double(box_->half);
        return local.x <= half.x + distance && local.y <= half.y + distance && local.z <= half.z + distance;
    }
    /// Whether a point is over a face that is enlarged by `grown` metres, at any height.
    [[nodiscard]] bool covers(int face, Vec3d point, double grown) const;
    /// Returns the point of a face that is nearest to `point`.
    [[nodiscard]] Vec3d nearest(int face, Vec3d point) const;
    /// Calls f(corner) for each corner of the piece.
    template <class F> void for_each_corner(const F& f) const {
        if (box_)
            for (unsigned i = 0; i < 8; ++i) f(box_corner(i));
        if (hull_)
            for (const Vec3 v : hull_->vertices) f(transform(pose_, to_double(v)));
    }

private:
    [[nodiscard]] Vec3d box_corner(unsigned bits) const;

    const Box* box_;
    const ConvexHull* hull_;
    bool is_half_space_;
    const TransformD& pose_;
};

/// Returns the point of a segment that is nearest to `point`.
[[nodiscard]] Vec3d nearest_on_segment(Vec3d from, Vec3d to, Vec3d point);

}  // namespace fase::narrow
