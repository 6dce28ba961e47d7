#pragma once
/// Infinity, as the narrow phase compares distances with it.
#include <limits>

namespace fase::narrow {

inline constexpr double infinity = std::numeric_limits<double>::infinity();

}  // namespace fase::narrow
