#pragma once
/// The ball around the origin.
#include <string_view>

#include "fase/math/vec3.hpp"

namespace fase {

/// A ball around the origin of its frame.
struct Sphere {
    static constexpr std::string_view name = "sphere";
    float radius = 0.5f;  ///< metres, above 0
    friend constexpr bool operator==(const Sphere&, const Sphere&) = default;

    /// Farthest point of the core (here one point) in `direction`; the shape is the core grown by core_radius().
    template <class T> [[nodiscard]] constexpr Vec3Of<T> core_support(Vec3Of<T>) const { return {}; }
    [[nodiscard]] constexpr float core_radius() const { return radius; }
};

}  // namespace fase
