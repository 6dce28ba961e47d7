#pragma once
/// Linear maps of shapes, taken apart into scales and a rotation.
#include <vector>

#include "fase/geometry/scaled.hpp"

namespace fase::detail {

/// A linear map with a determinant other than 0, and its scale and rotation.
struct LinearMap {
    /// Hulls of mapped round shapes have this many segments around their axis.
    static constexpr int hull_segments = 20;

    Mat3d matrix;
    Vec3d scale;                ///< lengths of the mapped axes
    Mat3d directions;           ///< their directions, right-handed; for a mirroring map one is flipped
    bool perpendicular = true;  ///< whether the mapped axes are perpendicular

    explicit LinearMap(const Mat3d& map);

    /// Returns whether it scales x and z equally, y maybe differently, and keeps the axes perpendicular.
    [[nodiscard]] bool keeps_circles() const;
    /// Returns whether it is a rotation or reflection times one scale.
    [[nodiscard]] bool uniform() const;
    [[nodiscard]] float mean_scale() const { return float((scale.x + scale.y + scale.z) / 3); }
    [[nodiscard]] Quat rotation() const { return to_float(to_quat(directions)); }
};

/// Builds the hull of the mapped points: the image of a shape that does not keep its kind.
[[nodiscard]] Result<RotatedShape> hull_of(std::vector<Vec3> points, const LinearMap& map, int max_vertices = 255);

}  // namespace fase::detail
