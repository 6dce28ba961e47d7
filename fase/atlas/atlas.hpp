#pragma once
/// Sprites to pages: images packed into larger ones, and the JSON that PixiJS and Phaser read beside them.
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

/// One image that is to go onto a page.
struct Sprite {
    std::string name;  ///< its key in the JSON: relative, with '/', e.g. "hero/run_1.png"
    Image image;
};

struct AtlasOptions {
    PackOptions pack;    ///< pages are cut to what they hold (PackOptions.crop) unless they are powers of two
    bool trim = false;   ///< transparent rows and columns at the edges do not go onto the page
    bool array = false;  ///< frames as a JSON array with file names, not as an object by name
};

/// Where a sprite is.
struct Frame {
    std::string name;
    std::uint32_t page = 0;
    Area part;             ///< of the page; width and height are those of the sprite before it was turned
    bool rotated = false;  ///< it lies turned by 90° clockwise and takes height × width pixels
    bool trimmed = false;
    Area source;       ///< what is on the page, as a part of the sprite
    Size source_size;  ///< the sprite, untrimmed
};

/// Pages and what lies on them.
struct Atlas {
    std::vector<Image> pages;
    std::vector<Frame> frames;  ///< in the order of the sprites
    std::size_t different = 0;  ///< pictures on the pages: sprites that look the same share one
    double occupancy = 0;       ///< share of the pages that these cover
    double pack_ms = 0;         ///< time of packing alone
    std::string rule;           ///< see Packing.rule
};

/// Refused: a name that is empty, not UTF-8, absolute, holds a control character, a backslash, a part "." or ".." or an
/// empty one (such names would lead out of the folder that is unpacked to), BadArgument; one that is given twice; a
/// sprite that is larger than a page; pages of more than 2^28 pixels together (1 GiB), Capacity. `where` is the name.
[[nodiscard]] Result<Atlas> make_atlas(std::span<const Sprite> sprites, const AtlasOptions& options = {});

/// Why a sprite's name is refused; "" when it is not.
[[nodiscard]] std::string_view problem_of_name(std::string_view name);

/// A file to be written.
struct NamedBytes {
    std::string name;
    std::vector<std::byte> bytes;
};

/// The files of an atlas: NAME.png and NAME.json, or, for several pages, NAME-0.png, NAME-0.json, NAME-1.png … whose
/// JSON names the others (meta.related_multi_packs: PixiJS loads them with the first). `name` may have a folder before
/// it. Source of the format: the "JSON (Hash)" and "JSON (Array)" of TexturePacker, as PixiJS 8 and Phaser 3 read them.
[[nodiscard]] Result<std::vector<NamedBytes>> files_of(const Atlas& atlas, const std::string& name,
                                                       const AtlasOptions& options = {});

/// Writes files so that all are there or none is new: each under another name first, renamed when all are written.
/// Io when one cannot be written; then those that were there before are as they were (unless a rename itself fails).
[[nodiscard]] Result<void> write_files(std::span<const NamedBytes> files);

}  // namespace fase::atlas
