#pragma once
/// Files as scenes need them: only regular ones are read, only whole ones are written.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fase/core/result.hpp"

namespace fase::scene {

/// All bytes of a regular file. Io when it cannot be opened or read, Format when it is a folder, a pipe or a device (it
/// is not waited for) or larger than `most` bytes. `where` of the error is the path.
Result<std::vector<std::byte>> read_file(const std::string& path, std::size_t most);

/// The first bytes of a regular file, and its size.
struct FileStart {
    std::vector<std::byte> bytes;  ///< as many as asked for, or the whole of a shorter file
    std::uint64_t size = 0;
};
/// Reads at most `count` bytes; errors as of read_file().
Result<FileStart> read_start(const std::string& path, std::size_t count);

/// The path that a file of `folder` means by a glTF uri (RFC 3986 reference, percent-decoded). Only relative paths
/// whose real place, links followed, lies under the folder; Format for absolute ones, schemes, drive letters,
/// backslashes, NUL, "..", and for files that do not exist. Never goes to the network.
Result<std::string> resolve_uri(const std::string& folder, std::string_view uri);

/// The bytes of a "data:" uri in base64 (RFC 4648, padding required). Format otherwise.
Result<std::vector<std::byte>> decode_data_uri(std::string_view uri);
/// Base64 with padding.
[[nodiscard]] std::string encode_base64(std::span<const std::byte> bytes);

/// Writes a file so that its name holds the old bytes or all of the new, never a part: into a new file beside it,
/// renamed at the end. A device or pipe is written to directly. Io with the path on any failure; then nothing of the
/// new file is left.
Result<void> write_file(const std::string& path, std::span<const std::byte> bytes);

/// The folder of a path: "a/b.gltf" -> "a", "b.gltf" -> ".".
[[nodiscard]] std::string folder_of(const std::string& path);

}  // namespace fase::scene
