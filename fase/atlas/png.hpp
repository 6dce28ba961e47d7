#pragma once
/// PNG files in and out.
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "fase/atlas/image.hpp"
#include "fase/core/result.hpp"

namespace fase::atlas {

/// An image out of the bytes of a PNG file: 1 to 16 bits (of 16, the upper eight, rounded), grey, colours, palette,
/// transparency, interlaced; colours as they are stored, without gamma. Format when the file is not whole and right:
/// any wrong checksum, missing part, palette index that has no colour, or more than `max_pixels`. `where` names the
/// source in errors. Memory: the image, and of a palette's indices one byte a pixel.
[[nodiscard]] Result<Image> read_png(std::span<const std::byte> bytes, const std::string& where);

/// The same of a regular file of at most 1 GiB; Io when it cannot be read.
[[nodiscard]] Result<Image> read_png_file(const std::string& path);

/// A PNG file of 8 bits RGBA. The same image gives the same bytes with the same version of zlib. BadArgument for an
/// image without pixels; Capacity for one with a side above max_page_side.
[[nodiscard]] Result<std::vector<std::byte>> write_png(const Image& image);

}  // namespace fase::atlas
