#pragma once
/// Finds and reads the images of an atlas.
#include <span>
#include <string>
#include <vector>

#include "fase/atlas/atlas.hpp"
#include "fase/core/result.hpp"

namespace fase::cli {

/// An image file and the name of its sprite.
struct SpriteFile {
    std::string path, name;
};

/// Finds the PNG files among `inputs` and, recursively, in the folders among them, sorted by name. A sprite from a
/// folder is named by its path relative to it ("hero/run.png"), a single file by its file name. Refused: two sprites of
/// one name; a link that leads out of its folder; no files.
[[nodiscard]] Result<std::vector<SpriteFile>> find_sprites(std::span<const std::string> inputs);

/// Images that were read, and why others were not.
struct SpriteImages {
    std::vector<atlas::Sprite> sprites;
    std::vector<Error> bad;  ///< one for each file that is no valid PNG image or cannot be opened
};

/// Reads the files. Errors: Capacity for more than 2^28 pixels in total; NoMemory.
[[nodiscard]] Result<SpriteImages> read_sprites(std::span<const SpriteFile> files);

/// Reads rectangles from a text file: width and height per line; skips empty lines. `where` of an error is FILE:LINE.
[[nodiscard]] Result<std::vector<atlas::Size>> read_rectangles(const std::string& path);

}  // namespace fase::cli
