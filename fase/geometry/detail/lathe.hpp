#pragma once
/// Triangle meshes of surfaces of revolution.
#include <span>
#include <vector>

#include "fase/geometry/mesh.hpp"

namespace fase::detail {

/// One circle of a surface of revolution about the y axis; a radius of 0 is a pole.
struct Ring {
    double radius = 0, y = 0;
};

/// Triangulates the surface between rings, which are ordered from top to bottom. The first and the last ring are poles
/// or are closed by a fan. `segments`: a multiple of 4.
[[nodiscard]] TriangleMesh lathe(std::span<const Ring> rings, int segments);

/// Returns the rings of a sphere, its upper half shifted by +half_length, its lower half by -half_length.
[[nodiscard]] std::vector<Ring> capsule_rings(double radius, double half_length, int segments);

}  // namespace fase::detail
