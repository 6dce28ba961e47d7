/// Writes files on a POSIX system.
#include "fase/record/recording/output_file.hpp"

#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <system_error>
#include <utility>

#include "fase/core/detail/check.hpp"

namespace fase::record {
namespace {

/// Blocks SIGXFSZ and SIGPIPE in this thread. The destructor consumes those that our own writes raised, then unblocks.
class WriteSignals {
public:
    WriteSignals() {
        sigemptyset(&blocked_);
        sigaddset(&blocked_, SIGXFSZ);
        sigaddset(&blocked_, SIGPIPE);
        sigset_t pending;
        sigpending(&pending);
        for (const int signal : {SIGXFSZ, SIGPIPE}) {
            if (sigismember(&pending, signal) == 1) sigdelset(&blocked_, signal);  // raised by other code
        }
        pthread_sigmask(SIG_BLOCK, &blocked_, &before_);
    }
    ~WriteSignals() {
        const int code = errno;
        const timespec at_once{0, 0};
        while (sigtimedwait(&blocked_, nullptr, &at_once) > 0 || errno == EINTR) {
        }
        pthread_sigmask(SIG_SETMASK, &before_, nullptr);
        errno = code;
    }
    WriteSignals(const WriteSignals&) = delete;
    WriteSignals& operator=(const WriteSignals&) = delete;

private:
    sigset_t blocked_, before_;
};

int open_retrying(const char* path, int flags, mode_t mode = 0) {
    int handle;
    do {
        handle = ::open(path, flags | O_CLOEXEC, mode);
    } while (handle < 0 && errno == EINTR);
    return handle;
}
bool try_lock(int handle) {
    int result;
    do {
        result = ::flock(handle, LOCK_EX | LOCK_NB);
    } while (result != 0 && errno == EINTR);
    return result == 0 || (errno != EWOULDBLOCK && errno != EAGAIN);  // a file system without locks counts as locked
}
bool is_same_file(int handle, const char* path) {
    struct stat opened {
    }, named{};
    return ::fstat(handle, &opened) == 0 && ::stat(path, &named) == 0 && opened.st_dev == named.st_dev &&
           opened.st_ino == named.st_ino;
}

/// Renames an abandoned file to an unused name. Returns whether that succeeded.
bool move_aside(const std::string& part, const std::string& name) {
    for (int i = 1; i < 10000; ++i) {
        const std::string aside = name + ".lost" + (i == 1 ? "" : std::to_string(i));
        if (::link(part.c_str(), aside.c_str()) == 0) return ::unlink(part.c_str()) == 0;
        if (errno != EEXIST) {  // no hard links on this file system
            struct stat info {};
            if (::lstat(aside.c_str(), &info) != 0) return ::rename(part.c_str(), aside.c_str()) == 0;
        }
    }
    return false;
}

Error busy(const std::string& part) {
    return {Status::Busy, part, "another program is recording to it",
            "choose another name, or wait until it has finished"};
}

}  // namespace

Error system_error(const std::string& file, const std::string& what, int code, std::string remedy) {
    std::string reason = std::system_category().message(code);
    if (code == ENOSPC || code == EDQUOT) reason = "disk full";
    if (code == EFBIG) reason = "file too large: the file size limit is reached";
    return {code == ENOMEM ? Status::NoMemory : Status::Io, file, what + ": " + reason, std::move(remedy)};
}

Result<OutputFile> OutputFile::create(const std::string& name) {
    OutputFile file;
    file.name_ = name;
    struct stat info {};
    if (name.empty() || name.find('\0') != std::string::npos) {
        return Error{Status::Io, name, "found an invalid file name", {}};
    }
    if (::stat(name.c_str(), &info) == 0) {
        if (S_ISDIR(info.st_mode)) return system_error(name, "cannot write", EISDIR, "name a file in it");
        file.direct_ = !S_ISREG(info.st_mode);
    }
    if (file.direct_) {
        file.path_ = name;
        file.handle_ = open_retrying(name.c_str(), O_WRONLY | O_NOCTTY | O_NONBLOCK);
        if (file.handle_ < 0) return system_error(name, "cannot write", errno);
        ::fcntl(file.handle_, F_SETFL, ::fcntl(file.handle_, F_GETFL) & ~O_NONBLOCK);
        return file;
    }
    file.path_ = name + ".part";
    for (int attempt = 0; attempt < 100; ++attempt) {
        file.handle_ = open_retrying(file.path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW, 0666);
        if (file.handle_ >= 0) {
            if (try_lock(file.handle_) && is_same_file(file.handle_, file.path_.c_str())) return file;
            return busy(file.path_);
        }
        if (errno != EEXIST) return system_error(file.path_, "cannot create it", errno);
        const int old = open_retrying(file.path_.c_str(), O_RDONLY | O_NONBLOCK | O_NOFOLLOW);
        if (old < 0) {
            if (errno == ENOENT) continue;
            return system_error(file.path_, "an existing file cannot be opened", errno, "move it away");
        }
        const bool abandoned = try_lock(old);
        const bool moved = abandoned && is_same_file(old, file.path_.c_str()) && move_aside(file.path_, name);
        const bool removed = !moved && !is_same_file(old, file.path_.c_str());
        ::close(old);
        if (!abandoned) return busy(file.path_);
        if (!moved && !removed) {
            return Error{Status::Io, file.path_, "an existing file cannot be renamed", "move it away"};
        }
    }
    return busy(file.path_);
}

OutputFile::OutputFile(OutputFile&& other) noexcept
    : handle_(std::exchange(other.handle_, -1)),
      direct_(other.direct_),
      bytes_(other.bytes_),
      name_(std::move(other.name_)),
      path_(std::move(other.path_)) {}

OutputFile& OutputFile::operator=(OutputFile&& other) noexcept {
    if (this == &other) return *this;
    close();
    handle_ = std::exchange(other.handle_, -1);
    direct_ = other.direct_;
    bytes_ = other.bytes_;
    name_ = std::move(other.name_);
    path_ = std::move(other.path_);
    return *this;
}

OutputFile::~OutputFile() {
    if (bytes_ == 0) discard();
    close();
}

void OutputFile::discard() {
    if (handle_ >= 0 && !direct_ && is_same_file(handle_, path_.c_str())) ::unlink(path_.c_str());
    close();
}

void OutputFile::close() {
    if (handle_ >= 0) ::close(handle_);
    handle_ = -1;
}

Result<void> OutputFile::append(std::span<const std::byte> bytes) {
    if (handle_ < 0) return Error{Status::Io, path_, "cannot write: the file is closed", {}};
    const WriteSignals signals;
    std::size_t written = 0;
    while (written < bytes.size()) {
        const std::size_t part = std::min(bytes.size() - written, std::size_t(1) << 30);
        const ssize_t result = ::write(handle_, bytes.data() + written, part);
        if (result > 0) {
            written += static_cast<std::size_t>(result);
        } else if (result == 0 || errno != EINTR) {
            const int code = result == 0 ? ENOSPC : errno;
            if (!direct_ && written != 0 && ::ftruncate(handle_, static_cast<off_t>(bytes_)) == 0) {
                ::lseek(handle_, static_cast<off_t>(bytes_), SEEK_SET);
            }
            return system_error(path_, "cannot write", code);
        }
    }
    bytes_ += written;
    return {};
}

Result<void> OutputFile::overwrite(std::uint64_t offset, std::span<const std::byte> bytes) {
    if (handle_ < 0) return Error{Status::Io, path_, "cannot write: the file is closed", {}};
    if (direct_) return Error{Status::Io, path_, "cannot overwrite bytes of a device or a pipe", {}};
    FASE_ASSERT(offset + bytes.size() <= bytes_);
    const WriteSignals signals;
    std::size_t written = 0;
    while (written < bytes.size()) {
        const ssize_t result =
            ::pwrite(handle_, bytes.data() + written, bytes.size() - written, static_cast<off_t>(offset + written));
        if (result > 0) {
            written += static_cast<std::size_t>(result);
        } else if (result == 0 || errno != EINTR) {
            return system_error(path_, "cannot write", result == 0 ? ENOSPC : errno);
        }
    }
    return {};
}

Result<void> OutputFile::sync() {
    if (direct_ || handle_ < 0) return {};
    int result;
    do {
        result = ::fdatasync(handle_);
    } while (result != 0 && errno == EINTR);
    if (result != 0) return system_error(path_, "cannot flush it to the disk", errno);
    return {};
}

Result<void> OutputFile::complete(bool durable) {
    if (handle_ < 0) return Error{Status::Io, path_, "cannot complete: the file is closed", {}};
    if (durable) {
        if (Result<void> synced = sync(); !synced) return synced;
    }
    if (!direct_) {
        if (!is_same_file(handle_, path_.c_str())) {
            return Error{Status::Io, path_, "the file was moved or removed while it was written", {}};
        }
        if (::rename(path_.c_str(), name_.c_str()) != 0) return system_error(name_, "cannot rename the file", errno);
        path_ = name_;
        if (durable) {
            const auto folder = std::filesystem::path(name_).parent_path().string();
            const int handle = open_retrying(folder.empty() ? "." : folder.c_str(), O_RDONLY | O_DIRECTORY);
            if (handle >= 0) {
                ::fsync(handle);
                ::close(handle);
            }
        }
    }
    const int closed = ::close(std::exchange(handle_, -1));
    if (closed != 0 && errno != EINTR) return system_error(path_, "cannot close", errno);
    return {};
}

}  // namespace fase::record
