/// Encodes an atlas as files: pages as PNG, frames as JSON.
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <iterator>

#include "fase/atlas/atlas.hpp"
#include "fase/atlas/png.hpp"
#include "fase/core/detail/files.hpp"

namespace fase::atlas {
namespace {

/// Returns the text as a JSON string. Sprite names are UTF-8 (see problem_of_name()); file names are not checked.
std::string json_string(std::string_view text) {
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"' || c == '\\') {
            out += {'\\', c};
        } else if (static_cast<unsigned char>(c) < 0x20) {
            out += fmt::format("\\u{:04x}", static_cast<unsigned>(static_cast<unsigned char>(c)));
        } else {
            out += c;
        }
    }
    return out + "\"";
}

std::string text_of(const Area& area) {
    return fmt::format("{{\"x\":{},\"y\":{},\"w\":{},\"h\":{}}}", area.x, area.y, area.width, area.height);
}
std::string text_of(Size size) { return fmt::format("{{\"w\":{},\"h\":{}}}", size.width, size.height); }

std::string file_name_of(const std::string& path) { return path.substr(path.rfind('/') + 1); }

std::string json_of(const Atlas& atlas, std::uint32_t page, const std::string& name, bool array) {
    const auto page_name = [&](std::uint32_t i) {
        return atlas.pages.size() == 1 ? name : fmt::format("{}-{}", name, i);
    };
    std::string text = array ? "{\"frames\":[" : "{\"frames\":{";
    const char* separator = "\n";
    for (const Frame& frame : atlas.frames) {
        if (frame.page != page) continue;
        text += separator;
        separator = ",\n";
        text += array ? fmt::format("{{\"filename\":{},", json_string(frame.name)) : json_string(frame.name) + ":{";
        text += fmt::format("\"frame\":{},\"rotated\":{},\"trimmed\":{},\"spriteSourceSize\":{},\"sourceSize\":{}}}",
                            text_of(frame.part), frame.rotated, frame.trimmed, text_of(frame.source),
                            text_of(frame.source_size));
    }
    text += array ? "\n],\n" : "\n},\n";
    text += fmt::format(
        "\"meta\":{{\"app\":\"fase "
        "atlas\",\"version\":\"1.0\",\"image\":{},\"format\":\"RGBA8888\",\"size\":{},\"scale\":\"1\"",
        json_string(page_name(page) + ".png"), text_of(atlas.pages[page].size));
    if (atlas.pages.size() > 1) {
        text += ",\"related_multi_packs\":[";
        const char* comma = "";
        for (std::uint32_t i = 0; i < atlas.pages.size(); ++i) {
            if (i == page) continue;
            text += comma + json_string(page_name(i) + ".json");
            comma = ",";
        }
        text += "]";
    }
    return text + "}}\n";
}

}  // namespace

Result<std::vector<NamedBytes>> files_of(const Atlas& atlas, const std::string& name, const AtlasOptions& options) {
    if (file_name_of(name).empty()) return Error{Status::BadArgument, name, "found no file name; expected one", {}};
    std::vector<NamedBytes> files;
    for (std::uint32_t page = 0; page < atlas.pages.size(); ++page) {
        const std::string base = atlas.pages.size() == 1 ? name : fmt::format("{}-{}", name, page);
        Result<std::vector<std::byte>> png = write_png(atlas.pages[page]);
        if (!png) return png.error();
        files.push_back({base + ".png", *std::move(png)});
        const std::string json = json_of(atlas, page, file_name_of(name), options.array);
        const auto* bytes = reinterpret_cast<const std::byte*>(json.data());
        files.push_back({base + ".json", {bytes, bytes + json.size()}});
    }
    return files;
}

Result<void> write_files(std::span<const NamedBytes> files) {
    std::vector<std::string> staged;
    const auto remove_staged = [&] {
        for (const std::string& name : staged) ::unlink(name.c_str());
    };
    for (const NamedBytes& file : files) {
        const std::string name = fmt::format("{}.new{}", file.name, ::getpid());
        if (auto written = write_file(name, file.bytes); !written) {
            remove_staged();
            Error error = written.error();
            error.where = file.name;
            return error;
        }
        staged.push_back(name);
    }
    // In a folder that was just written to, only an existing folder of the same name can prevent a rename.
    for (const NamedBytes& file : files) {
        struct stat info = {};
        if (::stat(file.name.c_str(), &info) != 0 || !S_ISDIR(info.st_mode)) continue;
        remove_staged();
        return Error{Status::Io, file.name, "found a folder; expected a file name", {}};
    }
    for (std::size_t i = 0; i < files.size(); ++i) {
        if (std::rename(staged[i].c_str(), files[i].name.c_str()) == 0) continue;
        const Error error{Status::Io, files[i].name, fmt::format("cannot write: {}", std::strerror(errno)), {}};
        remove_staged();
        return error;
    }
    return {};
}

}  // namespace fase::atlas
