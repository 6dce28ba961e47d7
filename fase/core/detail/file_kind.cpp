/// Compares the first bytes of files with the magic bytes of each kind, and text with the words of its formats.
#include "fase/core/detail/file_kind.hpp"

#include <algorithm>
#include <array>

#include "fase/core/detail/files.hpp"
#include "fase/core/detail/text.hpp"

namespace fase {
namespace {

struct Magic {
    std::string_view bytes;
    FileKind kind;
};

constexpr std::array magics{
    Magic{"FASEREC", FileKind::Recording},
    Magic{"FASESNAP", FileKind::Snapshot},
    Magic{"AABT", FileKind::Trace},
    Magic{"glTF", FileKind::Glb},
    Magic{"IWAD", FileKind::Wad},
    Magic{"PWAD", FileKind::Wad},
    Magic{"\x89PNG\r\n\x1a\n", FileKind::Png},
    Magic{"\xff\xd8\xff", FileKind::Jpeg},
    Magic{"\x28\xb5\x2f\xfd", FileKind::Zstd},
    Magic{"\x1f\x8b", FileKind::Gzip},
};

/// The first keywords of OBJ files, and the keys of a glTF file.
constexpr std::array<std::string_view, 12> obj_words{"v", "vn", "vt", "vp", "f",      "l",
                                                     "p", "o",  "g",  "s",  "mtllib", "usemtl"};
constexpr std::array<std::string_view, 17> gltf_keys{
    "accessors",      "animations",         "asset",      "buffers", "bufferViews", "cameras",
    "extensionsUsed", "extensionsRequired", "extensions", "images",  "meshes",      "materials",
    "nodes",          "samplers",           "scene",      "scenes",  "textures"};

bool contains(std::string_view text, std::string_view word) { return text.find(word) != std::string_view::npos; }

/// Whether JSON text is an object whose first key is one of glTF, or that has an "asset" near its start.
bool begins_like_gltf(std::string_view text) {
    if (text[0] != '{') return false;
    if (contains(text, "\"asset\"")) return true;
    const std::size_t quote = text.find_first_not_of(" \t\r\n", 1);
    if (quote == std::string_view::npos || text[quote] != '"') return false;
    const std::string_view key = text.substr(quote + 1, text.find('"', quote + 1) - quote - 1);
    return std::find(gltf_keys.begin(), gltf_keys.end(), key) != gltf_keys.end();
}

/// Whether the first line that is neither empty nor a comment begins with a keyword of OBJ and a blank.
bool begins_like_obj(std::string_view text) {
    while (!text.empty()) {
        const std::string_view line = text.substr(0, text.find_first_of("\r\n"));
        text.remove_prefix(std::min(line.size() + 1, text.size()));
        const std::size_t first = line.find_first_not_of(" \t");
        if (first == std::string_view::npos || line[first] == '#') continue;
        const std::size_t end = line.find_first_of(" \t", first);
        if (end == std::string_view::npos) return false;
        return std::find(obj_words.begin(), obj_words.end(), line.substr(first, end - first)) != obj_words.end();
    }
    return false;
}

FileKind kind_of_text(std::string_view text) {
    if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);  // a byte order mark
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    if (first == std::string_view::npos) return FileKind::Other;
    if (text[first] == '{' || text[first] == '[')
        return begins_like_gltf(text.substr(first)) ? FileKind::Gltf : FileKind::Json;
    if (text[first] == '<') return contains(text, "<mujoco") ? FileKind::Mjcf : FileKind::Other;
    return begins_like_obj(text) ? FileKind::Obj : FileKind::Other;
}

}  // namespace

FileKind kind_of(std::span<const std::byte> start) {
    if (start.empty()) return FileKind::Empty;
    const std::string_view text(reinterpret_cast<const char*>(start.data()), start.size());
    for (const Magic& magic : magics)
        if (text.starts_with(magic.bytes)) return magic.kind;
    return kind_of_text(text.substr(0, file_kind_bytes));
}

Result<FileKind> kind_of_file(const std::string& path) {
    const Result<FileStart> start = read_start(path, file_kind_bytes);
    if (!start) return start.error();
    return kind_of(start->bytes);
}

std::string_view name_of(FileKind kind) {
    switch (kind) {
        case FileKind::Other: break;
        case FileKind::Empty: return "an empty file";
        case FileKind::Recording: return "a recording";
        case FileKind::Trace: return "a trace";
        case FileKind::Snapshot: return "a snapshot of a world";
        case FileKind::Glb:
        case FileKind::Gltf: return "a glTF scene";
        case FileKind::Json: return "a JSON file";
        case FileKind::Wad: return "a WAD file";
        case FileKind::Obj: return "an OBJ mesh";
        case FileKind::Mjcf: return "a MuJoCo model (MJCF)";
        case FileKind::Png: return "a PNG image";
        case FileKind::Jpeg: return "a JPEG image";
        case FileKind::Zstd: return "a zstd archive";
        case FileKind::Gzip: return "a gzip archive";
    }
    return "another kind of file";
}

Error wrong_kind(const std::string& path, FileKind found, std::string_view expected) {
    return {Status::Format, path, detail::format("found {}; expected {}", name_of(found), expected), {}};
}

}  // namespace fase
