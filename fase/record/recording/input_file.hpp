#pragma once
/// Random-access reading of a regular file.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>

#include "fase/core/result.hpp"

namespace fase::record {

/// An open regular file. It is not memory-mapped: if the file shrinks meanwhile, read() returns an Error instead of a
/// crash.
class InputFile {
public:
    /// Opens a file. Error Io if it cannot be opened or is not a regular file.
    static Result<InputFile> open(const std::string& name);
    InputFile(InputFile&& other) noexcept;
    InputFile& operator=(InputFile&& other) noexcept;
    ~InputFile();

    /// Fills `bytes` from `offset` on. Error Io if the file ends before.
    Result<void> read(std::uint64_t offset, std::span<std::byte> bytes) const;
    /// Returns the size in bytes when the file was opened.
    [[nodiscard]] std::uint64_t size() const { return size_; }
    [[nodiscard]] const std::string& path() const { return path_; }

private:
    InputFile() = default;
    int handle_ = -1;
    std::uint64_t size_ = 0;
    std::string path_;
};

}  // namespace fase::record
