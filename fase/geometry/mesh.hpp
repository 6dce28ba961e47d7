#pragma once
/// Shapes as triangles and as points of their surface, for pictures and for hulls of what has no shape of its own.
#include <cstdint>
#include <vector>

#include "fase/geometry/shapes.hpp"

namespace fase {

/// Triangles over shared points: three indices each, counter-clockwise seen from outside.
struct TriangleMesh {
    std::vector<Vec3> positions;  ///< metres, in the frame of the shape
    std::vector<std::uint32_t> indices;
};

/// The surface of a shape. Boxes and hulls are exact; round shapes are cut into `detail` (at least 3, rounded up to
/// even) segments around their axis, all points lying on the true surface, so that the mesh stays within radius · (1 -
/// cos²(pi / detail)) of it; a half-space is a square of 200 m. Deterministic: no libm but sqrt.
[[nodiscard]] TriangleMesh triangles(const Shape& shape, int detail = 32);

/// The positions of triangles(): every corner of a box or hull, points all over the others.
[[nodiscard]] std::vector<Vec3> sample_points(const Shape& shape, int detail = 32);

}  // namespace fase
