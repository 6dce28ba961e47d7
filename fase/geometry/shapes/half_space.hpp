#pragma once
/// The half-space: endless solid ground.
#include <string_view>

#include "fase/geometry/plane.hpp"

namespace fase {

/// All points with y <= 0 in its frame: endless ground under the plane y = 0. Only for static and kinematic bodies
/// (it has no mass). It has no support point: pairs with it go through support of the other shape.
struct HalfSpace {
    static constexpr std::string_view name = "half_space";
    friend constexpr bool operator==(const HalfSpace&, const HalfSpace&) = default;
};

}  // namespace fase
