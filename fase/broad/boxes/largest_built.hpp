#pragma once
/// The range of coordinates in trees and grids.

namespace fase::broad {

/// Largest coordinate (metres) of boxes in trees and grids: areas of such boxes and their sums are finite in float.
inline constexpr float largest_built = 1e17f;

}  // namespace fase::broad
