#pragma once
/// RGBA images in memory, with the operations that an atlas needs.
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fase/atlas/rectangle.hpp"

namespace fase::atlas {

/// The pixel limit for images that are read: 64 Mi pixels, 256 MiB.
inline constexpr std::int64_t max_pixels = std::int64_t{1} << 26;

/// Rows of pixels from top to bottom; each pixel is red, green, blue, alpha of 8 bits, not premultiplied.
struct Image {
    Size size;
    std::vector<std::uint8_t> pixels;  ///< 4 * width * height

    Image() = default;
    /// Creates an image that is all transparent black.
    explicit Image(Size extent) : size(extent), pixels(4 * static_cast<std::size_t>(area_of(extent))) {}
    [[nodiscard]] std::uint8_t* at(int x, int y) {
        return pixels.data() +
               4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(size.width) + static_cast<std::size_t>(x));
    }
    [[nodiscard]] const std::uint8_t* at(int x, int y) const { return const_cast<Image*>(this)->at(x, y); }
    friend bool operator==(const Image&, const Image&) = default;
};

/// Returns the smallest area that contains every pixel that is not fully transparent; the upper left pixel if all are.
[[nodiscard]] Area visible_part(const Image& image);

/// Returns a copy of a part, which must be inside the image.
[[nodiscard]] Image cut_out(const Image& image, const Area& part);

/// Returns a hash: equal for equal images, and different for different images with very high probability.
[[nodiscard]] std::uint64_t hash_of(const Image& image);

/// Copies an image onto a page with its upper left corner at x, y; clips what is outside the page.
/// @param rotated rotate by 90° clockwise: the left column becomes the top row, from right to left
/// @param extrude the number of pixels around the image that repeat its edge
void paste(Image& page, const Image& image, int x, int y, bool rotated, int extrude);

}  // namespace fase::atlas
