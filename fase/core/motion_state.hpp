#pragma once
/// Whether a body or box is static, asleep or awake: the three sets that the broad phase keeps apart.
#include <cstdint>

namespace fase {

/// Pairs are found among awake boxes and between awake boxes and the other two sets.
enum class MotionState : std::uint8_t {
    Static,  ///< may be moved, but two static boxes are never a pair
    Asleep,  ///< at rest until something changes or touches it
    Awake,
    Absent,  ///< in no set; used only in lists of boxes that are identified by their index
};

}  // namespace fase
