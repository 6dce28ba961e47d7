#pragma once
/// A regular file that is read at any place.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "fase/core/result.hpp"

namespace fase::record {

/// Reads without mapping: a file that shrinks meanwhile is an Error, not a crash.
class InputFile {
public:
    /// Io when it cannot be opened or is no regular file.
    static Result<InputFile> open(const std::string& name);
    InputFile(InputFile&& other) noexcept;
    InputFile& operator=(InputFile&& other) noexcept;
    ~InputFile();

    /// Fills `bytes` from `offset` on; Io when the file ends before.
    Result<void> read(std::uint64_t offset, std::span<std::byte> bytes) const;
    /// Bytes it had when it was opened.
    [[nodiscard]] std::uint64_t size() const { return size_; }
    [[nodiscard]] const std::string& path() const { return path_; }

private:
    InputFile() = default;
    int handle_ = -1;
    std::uint64_t size_ = 0;
    std::string path_;
};

}  // namespace fase::record
