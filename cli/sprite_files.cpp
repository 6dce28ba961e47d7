/// Finds and reads the images of an atlas.
#include "cli/sprite_files.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <string_view>

#include "cli/common/input.hpp"
#include "fase/atlas/png.hpp"
#include "fase/core/detail/files.hpp"
#include "fase/core/detail/text.hpp"

namespace fase::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t max_total_pixels = std::int64_t{1} << 28;
constexpr std::size_t max_text = std::size_t{1} << 28;

bool is_png(const fs::path& path) {
    std::string ending = path.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + ('a' - 'A')) : c; });
    return ending == ".png";
}

Error io_error(const fs::path& path, const std::error_code& why) {
    return {Status::Io, path.string(), "cannot read: " + why.message(), {}};
}

/// Whether `path` is below `folder`. Both must be free of links.
bool is_below(const fs::path& path, const fs::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

Result<void> find_in_folder(const std::string& folder, std::vector<SpriteFile>& found) {
    std::error_code why;
    const fs::path root = fs::canonical(folder, why);
    if (why) return io_error(folder, why);
    fs::recursive_directory_iterator at(folder, why), end;
    while (!why && at != end) {
        const fs::path path = at->path();
        std::error_code ignored;
        if (is_png(path) && !at->is_directory(ignored)) {
            // A link that leads nowhere stays in the list: reading it fails like that of any other bad image.
            const fs::path real = fs::canonical(path, ignored);
            if (!ignored && !is_below(real, root))
                return Error{
                    Status::Format, path.string(), "found a link that leaves the folder; expected a file in it", {}};
            found.push_back({path.string(), path.lexically_relative(folder).generic_string()});
        }
        at.increment(why);
    }
    if (why) return io_error(folder, why);
    return {};
}

Result<atlas::Image> read_image(const std::string& path) {
    static constexpr FileKind kinds[]{FileKind::Png};
    if (auto checked = check_input(path, {"atlas", "PNG images", kinds}); !checked) return checked.error();
    return atlas::read_png_file(path);
}

/// Removes leading blanks and an integer from a line; false if there is none.
bool take_number(std::string_view& line, int& number) {
    line.remove_prefix(std::min(line.find_first_not_of(" \t"), line.size()));
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), number);
    if (error != std::errc()) return false;
    line.remove_prefix(static_cast<std::size_t>(end - line.data()));
    return line.empty() || line.front() == ' ' || line.front() == '\t';
}

}  // namespace

Result<std::vector<SpriteFile>> find_sprites(std::span<const std::string> inputs) {
    std::vector<SpriteFile> found;
    for (const std::string& input : inputs) {
        std::error_code ignored;
        if (fs::is_directory(input, ignored)) {
            const std::size_t before = found.size();
            if (auto searched = find_in_folder(input, found); !searched) return searched.error();
            if (found.size() == before)
                return Error{Status::Format, input, "found no .png file in the folder; expected at least one", {}};
        } else {
            found.push_back({input, fs::path(input).filename().string()});
        }
    }
    std::sort(found.begin(), found.end(), [](const SpriteFile& a, const SpriteFile& b) {
        return a.name != b.name ? a.name < b.name : a.path < b.path;
    });
    for (std::size_t i = 0; i < found.size(); ++i) {
        if (i > 0 && found[i].name == found[i - 1].name)
            return Error{Status::BadArgument, found[i].path,
                         "found the same name as " + found[i - 1].path + "; expected different names",
                         "pass the folder that contains both"};
        if (const std::string_view problem = atlas::problem_of_name(found[i].name); !problem.empty())
            return Error{Status::BadArgument, found[i].path, std::string(problem), {}};
    }
    return found;
}

Result<SpriteImages> read_sprites(std::span<const SpriteFile> files) {
    SpriteImages images;
    std::int64_t pixels = 0;
    for (const SpriteFile& file : files) {
        Result<atlas::Image> image = read_image(file.path);
        if (!image && image.status() == Status::NoMemory) return image.error();
        if (!image) {
            images.bad.push_back(image.error());
            continue;
        }
        pixels += area_of(image->size);
        if (pixels > max_total_pixels)
            return Error{
                Status::Capacity, file.path,
                fmt::format("found {} pixels in the images up to here; expected at most {}", pixels, max_total_pixels),
                "create several atlases"};
        images.sprites.push_back({file.name, *std::move(image)});
    }
    return images;
}

Result<std::vector<atlas::Size>> read_rectangles(const std::string& path) {
    static constexpr FileKind kinds[]{FileKind::Other, FileKind::Empty};
    if (auto checked = check_input(path, {"atlas --rects", "a text with a width and a height per line", kinds});
        !checked)
        return checked.error();
    const Result<std::vector<std::byte>> bytes = read_file(path, max_text);
    if (!bytes) return bytes.error();
    std::string_view text(reinterpret_cast<const char*>(bytes->data()), bytes->size());
    std::vector<atlas::Size> sizes;
    for (std::size_t number = 1; !text.empty(); ++number) {
        const std::size_t end = std::min(text.find('\n'), text.size());
        std::string_view line = text.substr(0, end);
        text.remove_prefix(std::min(end + 1, text.size()));
        const std::string_view whole = line;
        while (!line.empty() && (line.back() == '\r' || line.back() == ' ' || line.back() == '\t'))
            line.remove_suffix(1);
        if (line.empty()) continue;
        atlas::Size size;
        const bool good = take_number(line, size.width) && take_number(line, size.height) && line.empty();
        if (!good || size.width < 1 || size.height < 1 || size.width > atlas::max_page_side ||
            size.height > atlas::max_page_side)
            return Error{Status::Format,
                         detail::at_line(path, number),
                         fmt::format("found \"{}\"; expected a width and a height of 1 to {}", whole.substr(0, 60),
                                     atlas::max_page_side),
                         {}};
        sizes.push_back(size);
    }
    if (sizes.empty()) return Error{Status::Format, path, "found no rectangles; expected at least one", {}};
    return sizes;
}

}  // namespace fase::cli
