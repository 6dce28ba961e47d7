#pragma once
/// Reads and writes complete files: reads regular files only, writes atomically.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fase/core/result.hpp"

namespace fase {

/// Reads all bytes of a regular file. Io when it cannot be opened or read; Format when it is a folder, a pipe or a
/// device (never blocks on those) or larger than `max_bytes`. `where` of the error is the path.
Result<std::vector<std::byte>> read_file(const std::string& path, std::size_t max_bytes);

/// The first bytes of a regular file, and its size.
struct FileStart {
    std::vector<std::byte> bytes;  ///< the requested count, or all bytes of a shorter file
    std::uint64_t size = 0;
};
/// Reads at most `count` bytes; same errors as read_file().
Result<FileStart> read_start(const std::string& path, std::size_t count);

/// Writes a file atomically: readers see the old bytes or all new ones, never a part. Writes a temporary file in the
/// same folder and renames it at the end. Writes to a device or pipe directly. Io with the path on any failure; the
/// temporary file is removed then.
Result<void> write_file(const std::string& path, std::span<const std::byte> bytes);

/// Called with the name of each temporary file before write_file() creates it, and with "" when it is gone. For a
/// program whose signal handlers remove it; calls come from the threads that write.
using PartObserver = void (*)(const char* part);
/// Replaces the observer of this process; null: none, as at first.
void observe_parts(PartObserver observer);

/// Returns the folder of a path: "a/b.gltf" -> "a", "b.gltf" -> ".".
[[nodiscard]] std::string folder_of(const std::string& path);

}  // namespace fase
