#pragma once
/// Adds normals to a triangle mesh: smooth across flat edges, sharp across creases.
#include <span>

#include "fase/record/tables.hpp"

namespace fase::record {

/// Returns the mesh with a unit normal at each corner: the area-weighted mean over those triangles around the vertex
/// whose normals differ from the corner's triangle by less than `crease` radians. Corners of a vertex with equal
/// normals share one vertex of the result. Omits triangles without area. O(corners × triangles around a vertex).
[[nodiscard]] RecordedMesh with_normals(std::span<const Vec3> vertices, std::span<const Triangle> triangles,
                                        float crease = 0.7f);

}  // namespace fase::record
