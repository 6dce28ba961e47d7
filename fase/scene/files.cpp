/// Reads and writes files through POSIX calls.
#include "fase/scene/files.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <optional>

namespace fase::scene {
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
    /// Closes now; false when the last bytes could not be written.
    bool close() {
        const int number = number_;
        number_ = -1;
        return ::close(number) == 0;
    }

private:
    int number_;
};

Error io_error(const std::string& path, std::string_view doing) {
    return {Status::Io, path, fmt::format("cannot {}: {}", doing, std::strerror(errno)), {}};
}

std::string_view kind_of(mode_t mode) {
    if (S_ISDIR(mode)) return "a folder";
    if (S_ISFIFO(mode)) return "a pipe";
    if (S_ISSOCK(mode)) return "a socket";
    return "a device";
}

std::optional<std::string> real_path(const std::string& path) {
    const std::unique_ptr<char, void (*)(void*)> real(::realpath(path.c_str(), nullptr), std::free);
    if (!real) return std::nullopt;
    return std::string(real.get());
}

int hex_digit(char c) {
    if (c >= '0' && c <= '9') return c - '0';
    if (c >= 'a' && c <= 'f') return c - 'a' + 10;
    if (c >= 'A' && c <= 'F') return c - 'A' + 10;
    return -1;
}

/// nullopt when a % is not followed by two hexadecimal digits.
std::optional<std::string> percent_decoded(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '%') {
            out += text[i];
            continue;
        }
        const int high = i + 2 < text.size() ? hex_digit(text[i + 1]) : -1,
                  low = i + 2 < text.size() ? hex_digit(text[i + 2]) : -1;
        if (high < 0 || low < 0) return std::nullopt;
        out += static_cast<char>(high * 16 + low);
        i += 2;
    }
    return out;
}

/// What a decoded uri may not be; "" when it is a relative path without tricks.
std::string_view objection_to(std::string_view path) {
    if (path.empty()) return "an empty name";
    if (path.find('\0') != path.npos) return "a NUL byte";
    if (path.find('\\') != path.npos) return "a backslash";
    if (path.front() == '/') return "an absolute path";
    const std::size_t colon = path.find(':');
    if (colon != path.npos && path.substr(0, colon).find('/') == path.npos) return "a scheme or a drive";
    for (std::size_t begin = 0; begin <= path.size();) {
        const std::size_t end = std::min(path.find('/', begin), path.size());
        if (path.substr(begin, end - begin) == "..") return "a way out of the folder (\"..\")";
        begin = end + 1;
    }
    return "";
}

bool write_all(int descriptor, std::span<const std::byte> bytes) {
    while (!bytes.empty()) {
        const ssize_t written = ::write(descriptor, bytes.data(), std::min<std::size_t>(bytes.size(), 1u << 30));
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
        return Error{Status::Format, path, fmt::format("found {}, need a regular file", kind_of(about.st_mode)), {}};
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

Result<std::vector<std::byte>> read_file(const std::string& path, std::size_t most) {
    const Result<FileStart> head = read_start(path, 0);
    if (!head) return head.error();
    if (head->size > most)
        return Error{Status::Format, path, fmt::format("found {} bytes, need at most {}", head->size, most), {}};
    Result<FileStart> whole = read_start(path, most);
    if (!whole) return whole.error();
    return std::move(whole->bytes);
}

Result<std::string> resolve_uri(const std::string& folder, std::string_view uri) {
    const auto refused = [](std::string problem) { return Error{Status::Format, {}, std::move(problem), {}}; };
    const std::optional<std::string> path = percent_decoded(uri);
    if (!path) return refused("found a % that no two hexadecimal digits follow, need a valid uri");
    if (const std::string_view objection = objection_to(*path); !objection.empty()) {
        return refused(
            fmt::format("found {} in the uri, need a relative path that stays in the model's folder", objection));
    }
    const std::optional<std::string> root = real_path(folder), real = real_path(folder + "/" + *path);
    if (!root || !real) return refused("found the name of a file that does not exist, need one in the model's folder");
    const std::string inside = *root == "/" ? *root : *root + "/";
    if (!real->starts_with(inside))
        return refused("found a link that leads out of the model's folder, need a file in it");
    return *real;
}

Result<std::vector<std::byte>> decode_data_uri(std::string_view uri) {
    const auto refused = [](std::string problem) { return Error{Status::Format, {}, std::move(problem), {}}; };
    const std::size_t comma = uri.find(',');
    if (comma == uri.npos || !uri.substr(0, comma).ends_with(";base64"))
        return refused("found a data uri of another form, need \"data:…;base64,…\"");
    const std::string_view text = uri.substr(comma + 1);
    if (text.size() % 4 != 0)
        return refused(fmt::format("found base64 of {} characters, need a multiple of 4", text.size()));
    const auto value_of = [](char c) {
        if (c >= 'A' && c <= 'Z') return c - 'A';
        if (c >= 'a' && c <= 'z') return c - 'a' + 26;
        if (c >= '0' && c <= '9') return c - '0' + 52;
        return c == '+' ? 62 : c == '/' ? 63 : -1;
    };
    std::size_t padding = 0;
    while (padding < 2 && padding < text.size() && text[text.size() - 1 - padding] == '=') ++padding;
    std::vector<std::byte> bytes;
    bytes.reserve(text.size() / 4 * 3);
    std::uint32_t group = 0;
    for (std::size_t i = 0; i < text.size(); ++i) {
        const int value = i < text.size() - padding ? value_of(text[i]) : 0;
        if (value < 0)
            return refused(fmt::format("found the byte {:#04x} at {} of the base64 text, need A-Z, a-z, 0-9, +, /",
                                       static_cast<unsigned char>(text[i]), i));
        group = group << 6 | static_cast<std::uint32_t>(value);
        if (i % 4 != 3) continue;
        for (const int shift : {16, 8, 0}) bytes.push_back(static_cast<std::byte>(group >> shift & 0xff));
        group = 0;
    }
    bytes.resize(bytes.size() - padding);
    return bytes;
}

std::string encode_base64(std::span<const std::byte> bytes) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
        for (std::size_t k = 0; k < 3; ++k)
            group = group << 8 | (k < count ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0);
        for (std::size_t k = 0; k < 4; ++k) text += k <= count ? digits[group >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

Result<void> write_file(const std::string& path, std::span<const std::byte> bytes) {
    struct stat about = {};
    const bool exists = ::stat(path.c_str(), &about) == 0;
    if (exists && S_ISDIR(about.st_mode)) return Error{Status::Io, path, "found a folder, need a file's name", {}};
    if (exists && !S_ISREG(about.st_mode)) {
        Descriptor device(::open(path.c_str(), O_WRONLY | O_CLOEXEC | O_NOCTTY));
        if (!device.good()) return io_error(path, "open");
        if (!write_all(device.number(), bytes) || !device.close()) return io_error(path, "write");
        return {};
    }
    // A link keeps pointing where it did: what it points at is replaced.
    const std::string target = exists ? real_path(path).value_or(path) : path;
    std::string part;
    int number = -1;
    for (int i = 0; i < 100 && number < 0; ++i) {
        part = fmt::format("{}.part{}-{}", target, ::getpid(), i);
        number = ::open(part.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
        if (number < 0 && errno != EEXIST) break;
    }
    Descriptor file(number);
    if (!file.good()) return io_error(path, "create");
    if (!write_all(file.number(), bytes) || !file.close() || ::rename(part.c_str(), target.c_str()) != 0) {
        const Error error = io_error(path, "write");
        ::unlink(part.c_str());
        return error;
    }
    return {};
}

}  // namespace fase::scene
