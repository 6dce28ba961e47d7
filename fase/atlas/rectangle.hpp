#pragma once
/// Sizes and positions on a page. All are whole pixels; y points down.
#include <cstdint>

namespace fase::atlas {

/// A width and a height.
struct Size {
    int width = 0, height = 0;
    friend bool operator==(const Size&, const Size&) = default;
};

/// Returns the number of pixels.
[[nodiscard]] constexpr std::int64_t area_of(Size size) { return std::int64_t{size.width} * size.height; }

/// A part of a page; x and y are its upper left pixel.
struct Area {
    int x = 0, y = 0, width = 0, height = 0;
    friend bool operator==(const Area&, const Area&) = default;
};

/// Returns whether two areas share a pixel.
[[nodiscard]] constexpr bool overlaps(const Area& a, const Area& b) {
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

/// A distinct rectangle size. The packing rules see kinds; how many rectangles have that size is stored separately.
using Kind = Size;

/// One placed rectangle of a kind. Rotated: its width and height are exchanged.
struct PlacedKind {
    std::uint32_t kind = 0;
    int x = 0, y = 0;
    bool rotated = false;
};

}  // namespace fase::atlas
