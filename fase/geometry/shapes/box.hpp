#pragma once
/// The rotated box.
#include <string_view>

#include "fase/math/vec3.hpp"

namespace fase {

/// A box around the origin, its faces at right angles to the axes of its frame.
struct Box {
    static constexpr std::string_view name = "box";
    Vec3 half{0.5f, 0.5f, 0.5f};  ///< half sizes in metres, above 0
    friend constexpr bool operator==(const Box&, const Box&) = default;

    /// Farthest corner in `direction`; the shape is the core grown by core_radius(), here 0.
    template <class T> [[nodiscard]] constexpr Vec3Of<T> core_support(Vec3Of<T> direction) const {
        return {direction.x < 0 ? -T(half.x) : T(half.x), direction.y < 0 ? -T(half.y) : T(half.y),
                direction.z < 0 ? -T(half.z) : T(half.z)};
    }
    [[nodiscard]] constexpr float core_radius() const { return 0; }
};

}  // namespace fase
