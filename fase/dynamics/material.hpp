#pragma once
/// What surfaces are like, and how two of them become one number.
#include <cstdint>

namespace fase {

/// How the materials of two colliders become one number; of two modes the one later in this list counts
/// (the order of the glTF extension KHR_physics_rigid_bodies).
enum class CombineMode : std::uint8_t { GeometricMean, Multiply, Maximum, Minimum, Average };

/// What a surface is like.
struct Material {
    float friction = 0.6f;  ///< Coulomb's coefficient, 0 or more
    float restitution = 0;  ///< 0: no bounce, 1: all of it
    CombineMode friction_combine = CombineMode::GeometricMean;
    CombineMode restitution_combine = CombineMode::Maximum;
    friend constexpr bool operator==(const Material&, const Material&) = default;
};

/// The coefficient of two surfaces that meet; the same in both orders.
[[nodiscard]] float combined(float a, CombineMode mode_a, float b, CombineMode mode_b);

}  // namespace fase
