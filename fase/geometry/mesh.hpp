#pragma once
/// Shapes as triangle meshes and as surface points, for drawing and for hulls of scaled shapes.
#include <cstdint>
#include <vector>

#include "fase/geometry/shapes.hpp"

namespace fase {

/// Triangles over shared points: three indices each, counter-clockwise seen from outside.
struct TriangleMesh {
    std::vector<Vec3> positions;  ///< metres, in the frame of the shape
    std::vector<std::uint32_t> indices;
};

/// Triangulates the surface of a shape. Boxes and hulls are exact. Round shapes have `detail` segments around their
/// axis (at least 4, rounded up to a multiple of 4); all vertices are on the true surface, so that the mesh is within
/// radius · (1 - cos²(pi / detail)) of it. A half-space is a square of 200 m. Deterministic: uses no libm function
/// except sqrt.
[[nodiscard]] TriangleMesh triangles(const Shape& shape, int detail = 32);

/// Returns the positions of triangles(): the corners of a box or hull, points on the surface of other shapes.
[[nodiscard]] std::vector<Vec3> sample_points(const Shape& shape, int detail = 32);

}  // namespace fase
