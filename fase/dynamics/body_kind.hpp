#pragma once
/// What may move a body, and along which axes.
#include <cstdint>

namespace fase {

/// Static bodies never move; kinematic ones move as told, nothing pushes them; dynamic ones obey forces.
enum class BodyKind : std::uint8_t { Static, Kinematic, Dynamic };

/// World axes that a dynamic body may not move along or turn about.
struct AxisLocks {
    bool linear_x = false, linear_y = false, linear_z = false;
    bool angular_x = false, angular_y = false, angular_z = false;
    friend constexpr bool operator==(AxisLocks, AxisLocks) = default;
};

}  // namespace fase
