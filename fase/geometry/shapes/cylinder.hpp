#pragma once
/// The round cylinder.
#include <cmath>
#include <string_view>

#include "fase/math/vec3.hpp"

namespace fase {

/// A round cylinder around the y axis of its frame, from -half_height to half_height.
struct Cylinder {
    static constexpr std::string_view name = "cylinder";
    float radius = 0.5f;       ///< metres, above 0
    float half_height = 0.5f;  ///< metres, above 0
    friend constexpr bool operator==(const Cylinder&, const Cylinder&) = default;

    /// Farthest point in `direction`, on a rim (on the axis when the direction has no sideways part).
    template <class T> [[nodiscard]] Vec3Of<T> core_support(Vec3Of<T> direction) const {
        const T sideways = std::sqrt(direction.x * direction.x + direction.z * direction.z);
        const T scale = sideways > 0 ? T(radius) / sideways : T(0);
        return {direction.x * scale, direction.y < 0 ? -T(half_height) : T(half_height), direction.z * scale};
    }
    [[nodiscard]] constexpr float core_radius() const { return 0; }
};

}  // namespace fase
