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
    Json,       ///< begins like JSON; glTF in text form is JSON, too
    Wad,        ///< IWAD or PWAD
    Png,
    Zstd,
    Gzip,
};

/// Number of first bytes that kind_of() needs to know every kind.
inline constexpr std::size_t file_kind_bytes = 64;

/// The kind of a file that begins with `start`: all of its bytes, or at least file_kind_bytes of them.
[[nodiscard]] FileKind kind_of(std::span<const std::byte> start);
/// The kind of the file at `path`. Errors of read_start().
Result<FileKind> kind_of_file(const std::string& path);

/// "a recording", "a WAD file" … for messages; "another kind of file" for FileKind::Other.
[[nodiscard]] std::string_view name_of(FileKind kind);

/// The error for a file of the wrong kind: "found a WAD file; expected `expected`". Format, without an offset.
[[nodiscard]] Error wrong_kind(const std::string& path, FileKind found, std::string_view expected);

}  // namespace fase
