#pragma once
/// Whole files: only regular ones are read, only whole ones are written.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fase/core/result.hpp"

namespace fase {

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

/// Writes a file so that its name holds the old bytes or all of the new, never a part: into a new file beside it,
/// renamed at the end. A device or pipe is written to directly. Io with the path on any failure; then nothing of the
/// new file is left.
Result<void> write_file(const std::string& path, std::span<const std::byte> bytes);

/// The folder of a path: "a/b.gltf" -> "a", "b.gltf" -> ".".
[[nodiscard]] std::string folder_of(const std::string& path);

}  // namespace fase
