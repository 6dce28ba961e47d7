#pragma once
/// An output file that gets its final name only when it is complete.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "fase/core/result.hpp"

namespace fase::record {

/// Writes to `NAME.part` and renames it to `NAME` in complete(). Handles short writes and interrupts; after an error it
/// truncates the file to the last complete append. If `NAME` is a device or a pipe, it is written directly. Source of
/// the signal handling around write(): POSIX.1-2008, write(), EFBIG and EPIPE.
class OutputFile {
public:
    /// Creates the file. Error Io if that fails, Busy if another program is writing it. Renames an existing `NAME.part`
    /// that no program has locked to `NAME.lost`, `NAME.lost2` …
    static Result<OutputFile> create(const std::string& name);
    OutputFile(OutputFile&& other) noexcept;
    OutputFile& operator=(OutputFile&& other) noexcept;
    /// Closes the file. An incomplete file stays as `NAME.part`; an empty one is removed.
    ~OutputFile();

    /// Appends all of `bytes`, or none of them with error Io ("disk full"). Never raises SIGXFSZ or SIGPIPE.
    Result<void> append(std::span<const std::byte> bytes);
    /// Overwrites bytes that were appended before. Error Io on a device or a pipe.
    Result<void> overwrite(std::uint64_t offset, std::span<const std::byte> bytes);
    /// Flushes the appended bytes to the disk.
    Result<void> sync();
    /// Renames the file to its final name; replaces an existing file of that name.
    /// @param durable also flushes the file and its folder to the disk
    Result<void> complete(bool durable);
    /// Closes the file and removes it, unless it is complete, a device or a pipe.
    void discard();
    /// Returns the number of bytes appended.
    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
    /// Returns whether it is a device or a pipe: written directly, without overwrite().
    [[nodiscard]] bool is_stream() const { return direct_; }
    /// Returns where the bytes are now: `NAME.part`, or `NAME` if complete or a device.
    [[nodiscard]] const std::string& path() const { return path_; }

private:
    OutputFile() = default;
    void close();
    int handle_ = -1;
    bool direct_ = false;  ///< a device or pipe
    std::uint64_t bytes_ = 0;
    std::string name_, path_;
};

/// Returns the error for the errno `code`, e.g. "cannot write: disk full".
[[nodiscard]] Error system_error(const std::string& file, const std::string& what, int code, std::string remedy = {});

}  // namespace fase::record
