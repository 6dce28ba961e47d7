#pragma once
/// Finds and reads the images that go into an atlas.
#include <span>
#include <string>
#include <vector>

#include "fase/atlas/atlas.hpp"
#include "fase/core/result.hpp"

namespace fase::cli {

/// An image file, and what its sprite is called.
struct SpriteFile {
    std::string path, name;
};

/// The PNG files that are named, and those in named folders and their folders, in the order of the names. A sprite of a
/// folder is called by its way from there ("hero/run.png"), one that is named itself by its file's name. Refused: two
/// of one name; a link that leads out of its folder; no files at all.
[[nodiscard]] Result<std::vector<SpriteFile>> find_sprites(std::span<const std::string> inputs);

/// Reads them: at most 2^28 pixels together.
[[nodiscard]] Result<std::vector<atlas::Sprite>> read_sprites(std::span<const SpriteFile> files);

/// Rectangles of a text: width and height a line; empty lines do not count. `where` of an error is FILE:LINE.
[[nodiscard]] Result<std::vector<atlas::Size>> read_rectangles(const std::string& path);

}  // namespace fase::cli
