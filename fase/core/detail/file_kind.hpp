#pragma once
/// Recognises the kinds of files that Fase reads, writes or is likely to be given, by their first bytes.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "fase/core/result.hpp"

namespace fase {

enum class FileKind : std::uint8_t {
    Other,  ///< none of these; text, for example
    Empty,
    Recording,  ///< of `fase run --record`
    Trace,      ///< boxes frame by frame (AABT)
    Snapshot,   ///< of World::snapshot()
    Glb,        ///< binary glTF
    Gltf,       ///< glTF in text form
    Json,       ///< other JSON
    Wad,        ///< IWAD or PWAD
    Obj,        ///< a Wavefront mesh
    Mjcf,       ///< a model of MuJoCo, XML
    Png,
    Jpeg,
    Zstd,
    Gzip,
};

/// Number of first bytes that kind_of() looks at.
inline constexpr std::size_t file_kind_bytes = 4096;

/// The kind of a file that begins with `start`: all of its bytes, or at least file_kind_bytes of them. Text has no
/// magic bytes: an OBJ file is known by the keyword of its first line that is no comment, glTF by its first key, or an
/// "asset" near its start. An OBJ file that begins with more comments than that is FileKind::Other.
[[nodiscard]] FileKind kind_of(std::span<const std::byte> start);
/// The kind of the file at `path`. Errors of read_start().
Result<FileKind> kind_of_file(const std::string& path);

/// "a recording", "a WAD file" … for messages; "another kind of file" for FileKind::Other.
[[nodiscard]] std::string_view name_of(FileKind kind);

/// The error for a file of the wrong kind: "found a WAD file; expected `expected`". Format, without an offset.
[[nodiscard]] Error wrong_kind(const std::string& path, FileKind found, std::string_view expected);

}  // namespace fase
