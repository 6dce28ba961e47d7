#pragma once
/// Whether a body or box is static, asleep or awake: the three sets that the broad phase keeps apart.
#include <cstdint>

namespace fase {

/// Only awake boxes look for pairs, among themselves and against the other two sets.
enum class MotionState : std::uint8_t {
    Static,  ///< may be moved, but two static boxes are never a pair
    Asleep,  ///< at rest until something changes or touches it
    Awake,
    Absent,  ///< not in any set; only in lists of boxes that are known by their place
};

}  // namespace fase
