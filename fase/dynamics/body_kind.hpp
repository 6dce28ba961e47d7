#pragma once
/// Body kinds and axis locks.
#include <cstdint>

namespace fase {

/// Static bodies never move. Kinematic bodies move with the velocity set by the user and are not affected by forces or
/// contacts. Dynamic bodies respond to both.
enum class BodyKind : std::uint8_t { Static, Kinematic, Dynamic };

/// World axes along which a dynamic body cannot move, or about which it cannot rotate.
struct AxisLocks {
    bool linear_x = false, linear_y = false, linear_z = false;
    bool angular_x = false, angular_y = false, angular_z = false;
    friend constexpr bool operator==(AxisLocks, AxisLocks) = default;
};

}  // namespace fase
