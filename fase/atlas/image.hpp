#pragma once
/// Images in memory, as sprites need them.
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fase/atlas/rectangle.hpp"

namespace fase::atlas {

/// The most pixels that an image may have that is read: 64 Mi, 256 MiB.
inline constexpr std::int64_t max_pixels = std::int64_t{1} << 26;

/// Rows of pixels from above, each red, green, blue, alpha of 8 bits, not premultiplied.
struct Image {
    Size size;
    std::vector<std::uint8_t> pixels;  ///< 4 * width * height

    Image() = default;
    /// All transparent black.
    explicit Image(Size extent) : size(extent), pixels(4 * static_cast<std::size_t>(area_of(extent))) {}
    [[nodiscard]] std::uint8_t* at(int x, int y) {
        return pixels.data() +
               4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x));
    }
    [[nodiscard]] const std::uint8_t* at(int x, int y) const { return const_cast<Image*>(this)->at(x, y); }
    friend bool operator==(const Image&, const Image&) = default;
};

/// The least part of an image outside of which all is fully transparent; one pixel, the upper left, when all is.
[[nodiscard]] Area visible_part(const Image& image);

/// A copy of a part, which must lie inside.
[[nodiscard]] Image cut_out(const Image& image, const Area& part);

/// A number that equal images share, and others hardly ever do.
[[nodiscard]] std::uint64_t hash_of(const Image& image);

/// Copies an image onto a page with its upper left corner at x, y, or, where that lies outside, what of it is inside.
/// @param rotated turned by 90° clockwise: its left column becomes the upper row, from right to left
/// @param extrude so many pixels around it repeat its edge
void paste(Image& page, const Image& image, int x, int y, bool rotated, int extrude);

}  // namespace fase::atlas
