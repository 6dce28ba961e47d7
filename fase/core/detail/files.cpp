/// Reads and writes files through POSIX calls.
#include "fase/core/detail/files.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>

#include "fase/core/detail/text.hpp"

namespace fase {
namespace {

/// A file descriptor that closes itself.
class Descriptor {
public:
    explicit Descriptor(int number) : number_(number) {}
    Descriptor(const Descriptor&) = delete;
    Descriptor& operator=(const Descriptor&) = delete;
    ~Descriptor() {
        if (number_ >= 0) ::close(number_);
    }
    [[nodiscard]] int number() const { return number_; }
    [[nodiscard]] bool good() const { return number_ >= 0; }
    /// Closes now; returns false when the last bytes could not be written.
    bool close() {
        const int number = number_;
        number_ = -1;
        return ::close(number) == 0;
    }

private:
    int number_;
};

Error io_error(const std::string& path, std::string_view verb) {
    return {Status::Io, path, detail::format("cannot {}: {}", verb, std::strerror(errno)), {}};
}

std::string_view file_type_name(mode_t mode) {
    if (S_ISDIR(mode)) return "a folder";
    if (S_ISFIFO(mode)) return "a pipe";
    if (S_ISSOCK(mode)) return "a socket";
    return "a device";
}

/// Resolves all symbolic links of a path; returns the path itself when that fails.
std::string real_path(const std::string& path) {
    const std::unique_ptr<char, void (*)(void*)> real(::realpath(path.c_str(), nullptr), std::free);
    return real ? real.get() : path;
}

std::atomic<PartObserver> part_observer = nullptr;

void tell_part(const std::string& part) {
    if (const PartObserver observer = part_observer.load()) observer(part.c_str());
}

bool write_all(int descriptor, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), bytes.size());
        if (written < 0 && errno == EINTR) continue;
        if (written < 0) return false;
        bytes = bytes.subspan(static_cast<std::size_t>(written));
    }
    return true;
}

}  // namespace

std::string folder_of(const std::string& path) {
    const std::size_t slash = path.rfind('/');
    if (slash == std::string::npos) return ".";
    return slash == 0 ? "/" : path.substr(0, slash);
}

Result<FileStart> read_start(const std::string& path, std::size_t count) {
    const Descriptor file(::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK | O_NOCTTY));
    if (!file.good()) return io_error(path, "open");
    struct stat about = {};
    if (::fstat(file.number(), &about) != 0) return io_error(path, "open");
    if (!S_ISREG(about.st_mode))
        return Error{Status::Format,
                     path,
                     detail::format("found {}; expected a regular file", file_type_name(about.st_mode)),
                     {}};
    FileStart start;
    start.size = static_cast<std::uint64_t>(about.st_size);
    start.bytes.resize(static_cast<std::size_t>(std::min<std::uint64_t>(start.size, count)));
    std::size_t filled = 0;
    while (filled < start.bytes.size()) {
        const ssize_t got = ::read(file.number(), start.bytes.data() + filled, start.bytes.size() - filled);
        if (got < 0 && errno == EINTR) continue;
        if (got < 0) return io_error(path, "read");
        if (got == 0) break;
        filled += static_cast<std::size_t>(got);
    }
    start.bytes.resize(filled);
    return start;
}

Result<std::vector<std::byte>> read_file(const std::string& path, std::size_t max_bytes) {
    const Result<FileStart> head = read_start(path, 0);
    if (!head) return head.error();
    if (head->size > max_bytes)
        return Error{
            Status::Format, path, detail::format("found {} bytes; expected at most {}", head->size, max_bytes), {}};
    Result<FileStart> content = read_start(path, max_bytes);
    if (!content) return content.error();
    return std::move(content->bytes);
}

Result<void> write_file(const std::string& path, std::span<const std::byte> bytes) {
    struct stat about = {};
    const bool exists = ::stat(path.c_str(), &about) == 0;
    if (exists && S_ISDIR(about.st_mode)) return Error{Status::Io, path, "found a folder; expected a file name", {}};
    if (exists && !S_ISREG(about.st_mode)) {
        Descriptor device(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY));
        if (!device.good()) return io_error(path, "open");
        if (!write_all(device.number(), bytes) || !device.close()) return io_error(path, "write");
        return {};
    }
    // Keep a symbolic link and replace its target.
    const std::string target = exists ? real_path(path) : path;
    std::string part;
    int number = -1;
    for (int i = 0; i < 100 && number < 0; ++i) {
        part = detail::format("{}.part{}-{}", target, ::getpid(), i);
        tell_part(part);  // before it exists: a signal may come in between
        number = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (number < 0 && errno != EEXIST) break;
    }
    Descriptor file(number);
    Result<void> result;
    if (!file.good()) {
        result = io_error(path, "create");
    } else if (!write_all(file.number(), bytes) || !file.close() || ::rename(part.c_str(), target.c_str()) != 0) {
        result = io_error(path, "write");
        ::unlink(part.c_str());
    }
    tell_part({});
    return result;
}

void observe_parts(PartObserver observer) { part_observer.store(observer); }

}  // namespace fase
