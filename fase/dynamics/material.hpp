#pragma once
/// Surface materials and how two of them combine.
#include <cstdint>

namespace fase {

/// How the coefficients of two colliders combine. When the modes differ, the one later in this list is used (the order
/// of the glTF extension KHR_physics_rigid_bodies).
enum class CombineMode : std::uint8_t { GeometricMean, Multiply, Maximum, Minimum, Average };

/// Friction and restitution of a surface.
struct Material {
    float friction = 0.6f;  ///< Coulomb's coefficient, 0 or more
    float restitution = 0;  ///< 0: no bounce, 1: elastic
    CombineMode friction_combine = CombineMode::GeometricMean;
    CombineMode restitution_combine = CombineMode::Maximum;
    friend constexpr bool operator==(const Material&, const Material&) = default;
};

/// Returns the combined coefficient of two surfaces; symmetric in a and b.
[[nodiscard]] float combined(float a, CombineMode mode_a, float b, CombineMode mode_b);

}  // namespace fase
