#pragma once
/// Reads and writes PNG files.
#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "fase/atlas/image.hpp"
#include "fase/core/result.hpp"

namespace fase::atlas {

/// Decodes the bytes of a PNG file: 1 to 16 bits (16 bits are rounded to 8), grey, colours, palette, transparency,
/// interlaced. Colours are returned as stored, without gamma correction. Error Format for an incomplete or invalid
/// file: a wrong checksum, a missing part, a palette index without a colour, or more than `max_pixels`. `where` names
/// the source in errors. Memory: the image, plus one byte per pixel for a palette image.
[[nodiscard]] Result<Image> read_png(std::span<const std::byte> bytes, const std::string& where);

/// Reads and decodes a regular file of at most 1 GiB; errors of read_png(), and Io when it cannot be read.
[[nodiscard]] Result<Image> read_png_file(const std::string& path);

/// Encodes an image as a PNG file of 8 bits RGBA. The same image gives the same bytes with the same version of zlib.
/// Errors: BadArgument for an image without pixels; Capacity for a side above max_page_side.
[[nodiscard]] Result<std::vector<std::byte>> write_png(const Image& image);

}  // namespace fase::atlas
