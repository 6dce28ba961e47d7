#pragma once
/// Packs sprites onto pages and writes the pages with the JSON that PixiJS and Phaser read.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fase/atlas/image.hpp"
#include "fase/atlas/packer.hpp"
#include "fase/core/result.hpp"

namespace fase::atlas {

/// One image to pack.
struct Sprite {
    std::string name;  ///< its key in the JSON: a relative path with '/', e.g. "hero/run_1.png"
    Image image;
};

/// How an atlas is packed and written.
struct AtlasOptions {
    PackOptions pack;    ///< pages are cropped to their content (PackOptions.crop) unless they are powers of two
    bool trim = false;   ///< omits transparent rows and columns at the edges of sprites
    bool array = false;  ///< writes frames as a JSON array with file names instead of an object by name
};

/// The position of one sprite on its page.
struct Frame {
    std::string name;
    std::uint32_t page = 0;
    Area part;             ///< of the page; width and height are those before rotation
    bool rotated = false;  ///< rotated by 90° clockwise: covers height × width pixels
    bool trimmed = false;
    Area source;       ///< the part of the sprite that is on the page
    Size source_size;  ///< of the untrimmed sprite
};

/// Pages and the sprites on them.
struct Atlas {
    std::vector<Image> pages;
    std::vector<Frame> frames;  ///< in the order of the sprites
    std::size_t different = 0;  ///< number of distinct images on the pages: equal sprites share one
    double occupancy = 0;       ///< the fraction of the page pixels that these images cover
    double pack_ms = 0;         ///< time of packing only
    std::string rule;           ///< see Packing.rule
};

/// Packs sprites. Errors, with the sprite's name as `where`: BadArgument for a name that problem_of_name() rejects, a
/// duplicate name or an image without pixels; OutOfRange for a sprite larger than a page; Capacity for pages of more
/// than 2^28 pixels together (1 GiB). Also BadArgument for options out of range.
[[nodiscard]] Result<Atlas> make_atlas(std::span<const Sprite> sprites, const AtlasOptions& options = {});

/// Returns why a sprite's name is rejected, "" for a valid name. Rejected are names that are empty, not UTF-8 or
/// absolute, and names with a control character, a backslash, or a part that is empty, "." or "..": they could lead out
/// of the folder into which a program unpacks the atlas.
[[nodiscard]] std::string_view problem_of_name(std::string_view name);

/// A file to write.
struct NamedBytes {
    std::string name;
    std::vector<std::byte> bytes;
};

/// Returns the files of an atlas: NAME.png and NAME.json, or for several pages NAME-0.png, NAME-0.json, NAME-1.png …
/// The JSON of each page names the others (meta.related_multi_packs: PixiJS loads them with the first). `name` may
/// include a folder. Error BadArgument for a name without a file name; errors of write_png(). Source of the format: the
/// "JSON (Hash)" and "JSON (Array)" of TexturePacker, as PixiJS 8 and Phaser 3 read them.
[[nodiscard]] Result<std::vector<NamedBytes>> files_of(const Atlas& atlas, const std::string& name,
                                                       const AtlasOptions& options = {});

/// Writes all files or none: writes each under a temporary name, then renames all. Error Io when a file cannot be
/// written; existing files are then unchanged (unless a rename itself fails).
[[nodiscard]] Result<void> write_files(std::span<const NamedBytes> files);

}  // namespace fase::atlas
