/// RGBA images in memory, with the operations that an atlas needs.
#include "fase/atlas/image.hpp"

#include <algorithm>
#include <cstring>

#include "fase/core/hash.hpp"

namespace fase::atlas {

Area visible_part(const Image& image) {
    const int width = image.size.width, height = image.size.height;
    const auto row_is_visible = [&](int y) {
        for (int x = 0; x < width; ++x)
            if (image.at(x, y)[3] != 0) return true;
        return false;
    };
    int top = 0, bottom = height;
    while (top < height && !row_is_visible(top)) ++top;
    if (top == height) return {0, 0, std::min(width, 1), std::min(height, 1)};
    while (!row_is_visible(bottom - 1)) --bottom;
    int left = width, right = 0;
    for (int y = top; y < bottom; ++y) {
        for (int x = 0; x < left; ++x)
            if (image.at(x, y)[3] != 0) left = x;
        for (int x = width; x > right; --x)
            if (image.at(x - 1, y)[3] != 0) right = x;
    }
    return {left, top, right - left, bottom - top};
}

Image cut_out(const Image& image, const Area& part) {
    Image out(Size{part.width, part.height});
    for (int y = 0; y < part.height; ++y)
        std::memcpy(out.at(0, y), image.at(part.x, part.y + y), 4 * static_cast<std::size_t>(part.width));
    return out;
}

std::uint64_t hash_of(const Image& image) {
    Hasher hash;
    hash.add(static_cast<std::uint64_t>(image.size.width));
    hash.add(static_cast<std::uint64_t>(image.size.height));
    std::uint64_t word = 0;
    for (std::size_t i = 0; i < image.pixels.size(); i += 4) {
        std::uint32_t pixel = 0;
        for (std::size_t k = 0; k < 4; ++k) pixel |= std::uint32_t{image.pixels[i + k]} << (8 * k);
        word = word << 32 | pixel;
        if (i % 8 == 4) hash.add(word);
    }
    hash.add(word);
    return hash.value();
}

void paste(Image& page, const Image& image, int x, int y, bool rotated, int extrude) {
    const int width = rotated ? image.size.height : image.size.width;
    const int height = rotated ? image.size.width : image.size.height;
    for (int j = std::max(-extrude, -y); j < std::min(height + extrude, page.size.height - y); ++j) {
        const int row = std::clamp(j, 0, height - 1);
        for (int i = std::max(-extrude, -x); i < std::min(width + extrude, page.size.width - x); ++i) {
            const int column = std::clamp(i, 0, width - 1);
            const std::uint8_t* from = rotated ? image.at(row, image.size.height - 1 - column) : image.at(column, row);
            std::memcpy(page.at(x + i, y + j), from, 4);
        }
    }
}

}  // namespace fase::atlas
