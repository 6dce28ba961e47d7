#pragma once
/// The index that stands for "none".
#include <cstdint>

namespace fase {

/// No element: every index and proxy of 32 bits is smaller.
inline constexpr std::uint32_t no_index = 0xffffffff;

}  // namespace fase
