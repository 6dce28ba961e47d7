#pragma once
/// Clipping of a face or an edge against the sides of a reference face, in the plane of that face.
#include "fase/narrow/detail/core_view.hpp"

namespace fase::narrow {

/// A point over the reference face: (u, v) in its plane, `height` above it. `name` is the id of its feature pair.
struct ClipPoint {
    double u = 0, v = 0, height = 0;
    std::uint32_t name = 0;
    std::uint32_t edge = 0;  ///< id of the side to the next point: an incident edge or a reference side
};

/// A convex polygon (or a segment, or a point) over a reference face.
struct ClipPolygon {
    static constexpr int capacity = 2 * Feature::capacity;
    Buffer<ClipPoint, capacity> points;
    int count = 0;
};

/// The frame of a reference feature with 3 corners or more: (u, v, height) is right-handed, height along its normal.
class ClipFrame {
public:
    explicit ClipFrame(const Feature& reference);

    [[nodiscard]] ClipPoint flatten(const Corner& corner) const;
    [[nodiscard]] Vec3d lift(const ClipPoint& point) const {
        return origin_ + u_ * point.u + v_ * point.v + normal_ * point.height;
    }
    [[nodiscard]] Vec3d normal() const { return normal_; }
    /// Whether the point is over the face, to rounding.
    [[nodiscard]] bool contains(const ClipPoint& point) const;
    /// Returns the part of the incident feature over the reference face. A corner outside by up to a millionth of the
    /// face's size counts as inside, so that flush faces keep their corners. Names depend on the features, not on the
    /// order. Source: Sutherland, Hodgman 1974, Reentrant polygon clipping.
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
