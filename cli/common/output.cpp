/// Output that all commands share: exit codes, error lines, text that is safe to print, checks of output files.
#include "cli/common/output.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "fase/core/detail/files.hpp"

namespace fase::cli {
namespace {

/// Byte length of the printable character at the start of `text`; 0: none, or invalid UTF-8 (RFC 3629).
std::size_t printable_length(std::string_view text) {
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
    const unsigned char first = byte(0);
    if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
    const std::size_t length = first < 0xc2 ? 0 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : first < 0xf5 ? 4 : 0;
    if (length == 0 || text.size() < length) return 0;
    std::uint32_t code = first & (0xffu >> (length + 1));
    for (std::size_t i = 1; i < length; ++i) {
        if ((byte(i) & 0xc0) != 0x80) return 0;
        code = code << 6 | (byte(i) & 0x3fu);
    }
    const bool overlong = code < (length == 2 ? 0x80u : length == 3 ? 0x800u : 0x10000u);
    const bool control = code < 0xa0 || code == 0x2028 || code == 0x2029;
    const bool changes_direction = (code >= 0x202a && code <= 0x202e) || (code >= 0x2066 && code <= 0x2069);
    const bool invalid = code > 0x10ffff || (code >= 0xd800 && code < 0xe000);
    return overlong || control || changes_direction || invalid ? 0 : length;
}

Error cannot_write(const std::string& path, std::string problem) { return {Status::Io, path, std::move(problem), {}}; }

/// Checks that a file can be created in the folder of `path`, or in the nearest folder above it that exists: those
/// between are created before the file is written.
Result<void> check_folder(const std::string& path) {
    std::string folder = folder_of(path);
    struct stat info {};
    while (::stat(folder.c_str(), &info) != 0) {
        if (errno != ENOENT)
            return cannot_write(path, "cannot use the folder \"" + folder + "\": " + std::strerror(errno));
        struct stat link {};
        if (::lstat(folder.c_str(), &link) == 0)
            return cannot_write(path, "found a link \"" + folder + "\" that leads nowhere; expected a folder");
        folder = folder_of(folder);
    }
    if (!S_ISDIR(info.st_mode)) return cannot_write(path, "found the file \"" + folder + "\"; expected a folder");
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        return cannot_write(path, "found the read-only folder \"" + folder + "\"; expected a writable one");
    return {};
}

/// Checks that a regular file can be created or replaced. `info`: of the existing file, or nullptr.
Result<void> check_writable(const std::string& path, const struct stat* info, const std::string& input) {
    if (info != nullptr) {
        if (S_ISDIR(info->st_mode)) return cannot_write(path, "found a folder; expected a file to write");
        struct stat source {};
        if (!input.empty() && ::stat(input.c_str(), &source) == 0 && source.st_dev == info->st_dev &&
            source.st_ino == info->st_ino) {
            return cannot_write(path, "found the input file; expected another file to write");
        }
        if (::access(path.c_str(), W_OK) != 0)
            return cannot_write(path, "found a read-only file; expected a writable one");
        if (!S_ISREG(info->st_mode)) return {};
    } else if (errno == ENAMETOOLONG || errno == ELOOP) {
        return cannot_write(printable(path, 60), std::string("cannot write: ") + std::strerror(errno));
    }
    if (path.back() == '/') return cannot_write(path, "found a folder's name; expected a file's");
    return check_folder(path);
}

Result<void> check_extension(const std::string& path, std::initializer_list<OutputKind> kinds) {
    std::string expected;
    for (const OutputKind& kind : kinds) {
        if (has_extension(path, kind)) return {};
        expected += fmt::format("{}{}{}{} for {}", expected.empty() ? "" : ", ", kind.extension,
                                kind.other_extension.empty() ? "" : " or ", kind.other_extension, kind.name);
    }
    const std::string name = path.substr(path.rfind('/') + 1);
    const std::size_t dot = name.rfind('.');
    const bool has_none = dot == std::string::npos || dot == 0;
    return Error{Status::BadArgument,
                 path,
                 fmt::format("found {}; expected {}",
                             has_none ? std::string("no extension")
                                      : fmt::format("the extension \"{}\"", printable(name.substr(dot), 20)),
                             expected),
                 {}};
}

}  // namespace

int exit_code(Status status) {
    switch (status) {
        case Status::Ok: return exit_ok;
        case Status::BadArgument:
        case Status::BadHandle:
        case Status::OutOfRange:
        case Status::Format:
        case Status::Unsupported: return exit_bad_input;
        case Status::Io:
        case Status::Busy: return exit_io;
        case Status::Capacity:
        case Status::NoMemory: return exit_limit;
    }
    return exit_bug;
}

std::string printable(std::string_view text, std::size_t max_bytes) {
    std::string out;
    std::size_t i = 0;
    while (i < text.size() && i < max_bytes) {
        const std::size_t length = printable_length(text.substr(i));
        if (length > 0) {
            out += text.substr(i, length);
        } else if (text[i] == '\n') {
            out += "\\n";
        } else if (text[i] == '\t') {
            out += "\\t";
        } else {
            out += fmt::format("\\x{:02x}", static_cast<unsigned char>(text[i]));
        }
        i += std::max<std::size_t>(length, 1);
    }
    if (i < text.size()) out += "…";
    return out;
}

void print_line(std::string_view sort, std::string_view text) {
    const std::string line = fmt::format("fase: {}: {}\n", sort, printable(text));
    std::fwrite(line.data(), 1, line.size(), stderr);
}

int refuse(const Error& error) {
    print_line("error", error.text());
    return exit_code(error.status);
}

void guard_standard_streams() {
    for (const int stream : {0, 1, 2}) {
        // open() returns the lowest free descriptor, so the gaps fill in order.
        if (::fcntl(stream, F_GETFD) < 0 && errno == EBADF)
            (void)::open("/dev/null", stream == 0 ? O_RDONLY : O_WRONLY);
    }
    ::signal(SIGPIPE, SIG_IGN);
    ::signal(SIGXFSZ, SIG_IGN);
}

int finish_output(int code) {
    errno = 0;
    const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
    if (!failed) return code;
    const int cause = errno;
    pollfd out{1, POLLOUT, 0};
    const bool reader_closed = cause == EPIPE || (::poll(&out, 1, 0) == 1 && (out.revents & POLLERR) != 0);
    if (reader_closed) return 128 + SIGPIPE;
    const int io_code = refuse({Status::Io,
                                "standard output",
                                std::string("cannot write: ") + (cause != 0 ? std::strerror(cause) : "unknown error"),
                                {}});
    return code == exit_ok ? io_code : code;
}

bool has_extension(const std::string& path, const OutputKind& kind) {
    return path.ends_with(kind.extension) || (!kind.other_extension.empty() && path.ends_with(kind.other_extension));
}

Result<void> check_output(const std::string& path, std::initializer_list<OutputKind> kinds, const std::string& input) {
    if (path.empty()) return Error{Status::BadArgument, "output", "found an empty name; expected a file", {}};
    struct stat info {};
    const bool exists = ::stat(path.c_str(), &info) == 0;
    if (Result<void> writable = check_writable(path, exists ? &info : nullptr, input); !writable) return writable;
    const bool is_device = exists && !S_ISREG(info.st_mode);
    return is_device ? Result<void>{} : check_extension(path, kinds);
}

Result<void> make_folder_of(const std::string& path) {
    std::error_code why;
    std::filesystem::create_directories(folder_of(path), why);
    if (why) return cannot_write(path, "cannot create its folder: " + why.message());
    return {};
}

}  // namespace fase::cli
