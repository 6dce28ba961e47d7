/// Packs sprites onto pages; equal sprites share one place.
#include "fase/atlas/atlas.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <set>

namespace fase::atlas {
namespace {

constexpr std::int64_t max_page_pixels = std::int64_t{1} << 28;

/// Returns whether the text is well-formed UTF-8 (RFC 3629).
bool is_utf8(std::string_view text) {
    for (std::size_t i = 0; i < text.size();) {
        const auto byte = [&](std::size_t k) { return static_cast<unsigned char>(text[k]); };
        const unsigned char first = byte(i);
        const std::size_t length = first < 0x80   ? 1
                                   : first < 0xc2 ? 0
                                   : first < 0xe0 ? 2
                                   : first < 0xf0 ? 3
                                   : first < 0xf5 ? 4
                                                  : 0;
        if (length == 0 || i + length > text.size()) return false;
        for (std::size_t k = 1; k < length; ++k)
            if ((byte(i + k) & 0xc0) != 0x80) return false;
        if (length > 2) {
            const unsigned char second = byte(i + 1);
            if ((first == 0xe0 && second < 0xa0) || (first == 0xed && second > 0x9f) ||
                (first == 0xf0 && second < 0x90) || (first == 0xf4 && second > 0x8f))
                return false;
        }
        i += length;
    }
    return true;
}

/// The part of a sprite to put onto a page.
struct Picture {
    Area part;
    Image cropped;  ///< empty if the part is the whole sprite
};

}  // namespace

std::string_view problem_of_name(std::string_view name) {
    if (name.empty()) return "found an empty name; expected a name";
    if (!is_utf8(name)) return "found a name that is not UTF-8; expected UTF-8";
    for (const char c : name)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) return "found a control character; expected none";
    if (name.find('\\') != std::string_view::npos) return "found a backslash; expected '/' between folders";
    const bool drive = name.size() >= 2 && name[1] == ':';
    if (name.front() == '/' || drive) return "found an absolute path; expected a relative one";
    for (std::size_t begin = 0; begin <= name.size();) {
        const std::size_t end = std::min(name.find('/', begin), name.size());
        const std::string_view part = name.substr(begin, end - begin);
        if (part == ".." || part == "." || part.empty())
            return "found an empty, \".\" or \"..\" part; expected a normalized path inside the folder";
        begin = end + 1;
    }
    return {};
}

Result<Atlas> make_atlas(std::span<const Sprite> sprites, const AtlasOptions& options) {
    PackOptions pack_options = options.pack;
    pack_options.crop = !pack_options.power_of_two;
    std::set<std::string_view> names;
    for (const Sprite& sprite : sprites) {
        if (const std::string_view problem = problem_of_name(sprite.name); !problem.empty())
            return Error{Status::BadArgument, sprite.name, std::string(problem), {}};
        if (!names.insert(sprite.name).second)
            return Error{Status::BadArgument, sprite.name, "found the name twice; expected different names", {}};
        if (sprite.image.size.width < 1 || sprite.image.size.height < 1)
            return Error{Status::BadArgument, sprite.name, "found an image without pixels; expected at least one", {}};
    }
    std::vector<Picture> pictures(sprites.size());
    std::vector<std::size_t> picture_of(sprites.size());  // the first sprite with the same picture
    std::vector<std::uint32_t> rectangle_of(sprites.size());
    std::multimap<std::uint64_t, std::size_t> by_hash;
    std::vector<Size> sizes;
    std::vector<std::size_t> owners;
    const auto picture = [&](std::size_t i) -> const Image& {
        return pictures[i].cropped.pixels.empty() ? sprites[i].image : pictures[i].cropped;
    };
    for (std::size_t i = 0; i < sprites.size(); ++i) {
        const Image& image = sprites[i].image;
        const Area whole{0, 0, image.size.width, image.size.height};
        pictures[i].part = options.trim ? visible_part(image) : whole;
        if (pictures[i].part != whole) pictures[i].cropped = cut_out(image, pictures[i].part);
        const std::uint64_t hash = hash_of(picture(i));
        picture_of[i] = i;
        const auto [begin, end] = by_hash.equal_range(hash);
        for (auto other = begin; other != end && picture_of[i] == i; ++other)
            if (picture(other->second) == picture(i)) picture_of[i] = other->second;
        if (picture_of[i] != i) continue;
        by_hash.emplace(hash, i);
        rectangle_of[i] = static_cast<std::uint32_t>(sizes.size());
        sizes.push_back(picture(i).size);
        owners.push_back(i);
    }
    const auto start = std::chrono::steady_clock::now();
    Result<Packing> packing = pack(sizes, pack_options);
    Atlas atlas;
    atlas.pack_ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    if (!packing) {
        Error error = packing.error();
        // The caller knows sprites by name, not as "rectangle 17".
        const std::string_view word = "rectangle ";
        if (error.where.starts_with(word))
            error.where = sprites[owners[std::stoul(error.where.substr(word.size()))]].name;
        return error;
    }
    std::int64_t pixels = 0;
    for (const Size page : packing->pages) pixels += area_of(page);
    if (pixels > max_page_pixels)
        return Error{Status::Capacity, "atlas",
                     fmt::format("found {} pages of {} pixels; expected at most {} pixels", packing->pages.size(),
                                 pixels, max_page_pixels),
                     "make several atlases"};
    for (const Size page : packing->pages) atlas.pages.emplace_back(page);
    for (std::size_t i = 0; i < sprites.size(); ++i) {
        const Place& place = packing->places[rectangle_of[picture_of[i]]];
        const Area part = pictures[i].part;
        const Size source = sprites[i].image.size;
        atlas.frames.push_back({sprites[i].name,
                                place.page,
                                {place.x, place.y, part.width, part.height},
                                place.rotated,
                                Size{part.width, part.height} != source,
                                part,
                                source});
        if (picture_of[i] == i)
            paste(atlas.pages[place.page], picture(i), place.x, place.y, place.rotated, pack_options.extrude);
    }
    atlas.different = sizes.size();
    atlas.occupancy = packing->occupancy(sizes);
    atlas.rule = packing->rule;
    return atlas;
}

}  // namespace fase::atlas
