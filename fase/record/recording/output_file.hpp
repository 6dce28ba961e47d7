#pragma once
/// A file that is only appended to and stands under its own name no sooner than it is complete.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "fase/core/result.hpp"

namespace fase::record {

/// Writes to `NAME.part` and renames it to `NAME` when done. Survives short writes and interrupts; after an error the
/// file is cut back to the last whole append. A `NAME` that is a device or a pipe is written directly. Source of the
/// signal handling around write(): POSIX.1-2008, write(), EFBIG and EPIPE.
class OutputFile {
public:
    /// Io when it cannot be made there, Busy when another program is writing it. A `NAME.part` that no program holds is
    /// moved aside to `NAME.lost`, `NAME.lost2` …
    static Result<OutputFile> create(const std::string& name);
    OutputFile(OutputFile&& other) noexcept;
    OutputFile& operator=(OutputFile&& other) noexcept;
    /// Closes; a file that was not completed stays as `NAME.part`, unless it is empty.
    ~OutputFile();

    /// All of `bytes`, or Io ("disk full") and none of them. Never raises SIGXFSZ or SIGPIPE.
    Result<void> append(std::span<const std::byte> bytes);
    /// Puts other bytes in the place of some that were appended; Io on a device or a pipe.
    Result<void> overwrite(std::uint64_t offset, std::span<const std::byte> bytes);
    /// Forces what was appended to the disk.
    Result<void> sync();
    /// Gives the file its name, in place of any file that had it.
    /// @param durable also forces file and folder to the disk.
    Result<void> complete(bool durable);
    /// Closes and takes the file away, unless it is complete, a device or a pipe.
    void discard();
    /// Bytes appended.
    [[nodiscard]] std::uint64_t bytes() const { return bytes_; }
    /// A device or a pipe: written directly, never again.
    [[nodiscard]] bool is_stream() const { return direct_; }
    /// Where the bytes are now: `NAME.part`, or `NAME` once complete (or when it is a device).
    [[nodiscard]] const std::string& path() const { return path_; }

private:
    OutputFile() = default;
    void close();
    int handle_ = -1;
    bool direct_ = false;  ///< a device or pipe
    std::uint64_t bytes_ = 0;
    std::string name_, path_;
};

/// What failed with the errno `code`, in words: "cannot write: disk full".
[[nodiscard]] Error system_error(const std::string& file, const std::string& what, int code, std::string remedy = {});

}  // namespace fase::record
