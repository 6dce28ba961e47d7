#pragma once
/// The capsule: all points within a radius of a segment.
#include <string_view>

#include "fase/math/vec3.hpp"

namespace fase {

/// All points within `radius` of the segment from (0, -half_length, 0) to (0, half_length, 0).
struct Capsule {
    static constexpr std::string_view name = "capsule";
    float radius = 0.25f;      ///< metres, above 0
    float half_length = 0.5f;  ///< metres, half the segment, not counting the caps; 0 or more
    friend constexpr bool operator==(const Capsule&, const Capsule&) = default;

    /// Farther end of the segment; the shape is the core grown by core_radius().
    template <class T> [[nodiscard]] constexpr Vec3Of<T> core_support(Vec3Of<T> direction) const {
        return {0, direction.y < 0 ? -T(half_length) : T(half_length), 0};
    }
    [[nodiscard]] constexpr float core_radius() const { return radius; }
};

}  // namespace fase
