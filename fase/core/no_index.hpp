#pragma once
/// The sentinel index.
#include <cstdint>

namespace fase {

/// Means "no element": every valid index and proxy of 32 bits is smaller.
inline constexpr std::uint32_t no_index = 0xffffffff;

}  // namespace fase
