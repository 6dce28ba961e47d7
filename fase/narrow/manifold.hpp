#pragma once
/// What the narrow phase says of two shapes: where, how deep, which way.
#include <array>
#include <cstdint>

#include "fase/math/vec3.hpp"

namespace fase::narrow {

/// One point of contact.
struct ManifoldPoint {
    Vec3 at;               ///< half-way between the two surfaces
    float separation = 0;  ///< metres along the normal: below 0 when the shapes overlap there
    std::uint32_t feature =
        0;  ///< names the pair of features (vertex, edge, face) that meet: the same from step to step
};

/// How two shapes touch: up to 4 points on one plane. `normal` is unit and points from a to b. Frame: that of shape a,
/// unless a function says otherwise. No point: the shapes are farther apart than the margin that was asked for.
struct Manifold {
    Vec3 normal{0, 1, 0};
    int count = 0;
    std::array<ManifoldPoint, 4> points;
};

}  // namespace fase::narrow
