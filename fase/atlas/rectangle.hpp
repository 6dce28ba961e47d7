#pragma once
/// The words of packing: sizes, and where on a page something lies. All in whole pixels, y down.
#include <cstdint>

namespace fase::atlas {

/// How wide and how high.
struct Size {
    int width = 0, height = 0;
    friend bool operator==(const Size&, const Size&) = default;
};

/// Pixels in it.
[[nodiscard]] constexpr std::int64_t area_of(Size size) { return std::int64_t{size.width} * size.height; }

/// A part of a page; x and y are its upper left pixel.
struct Area {
    int x = 0, y = 0, width = 0, height = 0;
    friend bool operator==(const Area&, const Area&) = default;
};

/// Whether two areas share a pixel.
[[nodiscard]] constexpr bool overlaps(const Area& a, const Area& b) {
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

/// Sizes that are the same, as the rules of packing see them: how many there are is kept beside.
using Kind = Size;

/// One rectangle of a kind, laid down. Turned: it lies with width and height exchanged.
struct Laid {
    std::uint32_t kind = 0;
    int x = 0, y = 0;
    bool turned = false;
};

}  // namespace fase::atlas
