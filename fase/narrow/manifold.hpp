#pragma once
/// The contact manifold: the output of the narrow phase for two shapes.
#include <array>
#include <cstdint>

#include "fase/math/vec3.hpp"

namespace fase::narrow {

/// One contact point.
struct ManifoldPoint {
    Vec3 position;              ///< half-way between the two surfaces
    float separation = 0;       ///< metres along the normal: below 0 when the shapes overlap there
    std::uint32_t feature = 0;  ///< id of the feature pair (vertex, edge, face), stable from step to step
};

/// How two shapes touch: up to 4 points on one plane. `normal` is unit and points from a to b. Frame: that of shape a,
/// unless a function says otherwise. No point: the shapes are farther apart than the margin.
struct Manifold {
    Vec3 normal{0, 1, 0};
    int count = 0;
    std::array<ManifoldPoint, 4> points;
};

}  // namespace fase::narrow
