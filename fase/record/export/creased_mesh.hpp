#pragma once
/// Normals for triangles that have none: smooth over gentle edges, sharp over hard ones.
#include <span>

#include "fase/record/recording/tables.hpp"

namespace fase::record {

/// The mesh with a unit normal at each corner: the mean, weighted by area, of those triangles around the vertex that
/// are turned against the corner's own by less than `crease` radians. Corners of a vertex with equal normals are one
/// vertex of the result. Triangles without area are left out. O(corners times triangles around a vertex).
[[nodiscard]] RecordedMesh with_normals(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                        float crease = 0.7f);

}  // namespace fase::record
