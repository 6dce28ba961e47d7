/// Reads files on a POSIX system.
#include "fase/record/recording/input_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <utility>

#include "fase/core/detail/text.hpp"
#include "fase/record/recording/output_file.hpp"

namespace fase::record {

Result<InputFile> InputFile::open(const std::string& name) {
    InputFile file;
    file.path_ = name;
    if (name.empty() || name.find('\0') != std::string::npos) {
        return Error{Status::Io, name, "found an invalid file name", {}};
    }
    do {
        file.handle_ = ::open(name.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY);
    } while (file.handle_ < 0 && errno == EINTR);
    if (file.handle_ < 0) return system_error(name, "cannot open", errno);
    struct stat info {};
    if (::fstat(file.handle_, &info) != 0) return system_error(name, "cannot read", errno);
    if (!S_ISREG(info.st_mode)) {
        return Error{
            Status::Io,
            name,
            S_ISDIR(info.st_mode) ? "found a folder; expected a file" : "found a special file; expected a regular file",
            {}};
    }
    file.size_ = static_cast<std::uint64_t>(info.st_size);
    return file;
}

InputFile::InputFile(InputFile&& other) noexcept
    : handle_(std::exchange(other.handle_, -1)), size_(other.size_), path_(std::move(other.path_)) {}
InputFile& InputFile::operator=(InputFile&& other) noexcept {
    std::swap(handle_, other.handle_);
    std::swap(size_, other.size_);
    path_.swap(other.path_);
    return *this;
}
InputFile::~InputFile() {
    if (handle_ >= 0) ::close(handle_);
}

Result<void> InputFile::read(std::uint64_t offset, std::span<std::byte> bytes) const {
    std::size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t count =
            ::pread(handle_, bytes.data() + done, bytes.size() - done, static_cast<off_t>(offset + done));
        if (count > 0) {
            done += static_cast<std::size_t>(count);
        } else if (count == 0) {
            return Error{Status::Io,
                         detail::at_byte(path_, offset + done),
                         "found the end of the file: it was truncated while it was read",
                         {}};
        } else if (errno != EINTR) {
            return system_error(detail::at_byte(path_, offset + done), "cannot read", errno);
        }
    }
    return {};
}

}  // namespace fase::record
