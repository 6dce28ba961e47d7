#pragma once
/// Clipping of a face or an edge against the sides of a reference face, in the plane of that face.
#include "fase/narrow/detail/core_view.hpp"

namespace fase::narrow {

/// A point over the reference face: (u, v) in its plane, `height` above it. `name` names the features that meet in it.
struct ClipPoint {
    double u = 0, v = 0, height = 0;
    std::uint32_t name = 0;
    std::uint32_t edge =
        0;  ///< what the side from here to the next point lies on: an incident edge or a reference side
};

/// A convex polygon (or a segment, or a point) over a reference face.
struct ClipPolygon {
    static constexpr int capacity = 2 * Feature::capacity;
    Buffer<ClipPoint, capacity> points;
    int count = 0;
};

/// The plane of a reference feature with 3 corners or more: (u, v, height) is a right-handed frame, height along its
/// normal.
class ClipFrame {
public:
    explicit ClipFrame(const Feature& reference);

    [[nodiscard]] ClipPoint flatten(const Corner& corner) const;
    [[nodiscard]] Vec3d lift(const ClipPoint& point) const {
        return origin_ + u_ * point.u + v_ * point.v + normal_ * point.height;
    }
    [[nodiscard]] Vec3d normal() const { return normal_; }
    /// Is the point over the face, or outside by no more than rounding?
    [[nodiscard]] bool contains(const ClipPoint& point) const;
    /// The part of the incident feature that lies over the reference face; corners within a millionth of the face's
    /// size outside count as inside, so that flush faces keep their corners. Names follow the features, not the order.
    /// Source: Sutherland, Hodgman 1974, Reentrant polygon clipping.
    [[nodiscard]] ClipPolygon clip(const Feature& incident) const;

private:
    struct Side {
        double u, v, offset;  ///< outside: u * p.u + v * p.v > offset
        std::uint32_t id;
        [[nodiscard]] double beyond(const ClipPoint& p) const { return u * p.u + v * p.v - offset; }
    };
    void clip_polygon(ClipPolygon& polygon) const;
    void clip_segment(ClipPolygon& segment) const;

    Vec3d origin_, u_, v_, normal_;
    Buffer<Side, Feature::capacity> sides_;
    int side_count_ = 0;
    double slack_ = 0;
};

}  // namespace fase::narrow
