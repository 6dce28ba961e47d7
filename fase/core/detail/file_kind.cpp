/// Compares the first bytes of files with the magic bytes of each kind.
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
    Magic{"\x28\xb5\x2f\xfd", FileKind::Zstd},
    Magic{"\x1f\x8b", FileKind::Gzip},
};

}  // namespace

FileKind kind_of(std::span<const std::byte> start) {
    if (start.empty()) return FileKind::Empty;
    const std::string_view text(reinterpret_cast<const char*>(start.data()), start.size());
    for (const Magic& magic : magics)
        if (text.starts_with(magic.bytes)) return magic.kind;
    const std::size_t first = text.find_first_not_of(" \t\r\n");
    const bool is_json = first != std::string_view::npos && (text[first] == '{' || text[first] == '[');
    return is_json ? FileKind::Json : FileKind::Other;
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
        case FileKind::Glb: return "a glTF scene";
        case FileKind::Json: return "a JSON file";
        case FileKind::Wad: return "a WAD file";
        case FileKind::Png: return "a PNG image";
        case FileKind::Zstd: return "a zstd archive";
        case FileKind::Gzip: return "a gzip archive";
    }
    return "another kind of file";
}

Error wrong_kind(const std::string& path, FileKind found, std::string_view expected) {
    return {Status::Format, path, detail::format("found {}; expected {}", name_of(found), expected), {}};
}

}  // namespace fase
