/// Decodes uris and restricts them to the folder.
#include "fase/scene/detail/uri.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <memory>
#include <optional>

namespace fase::scene {
namespace {

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

/// Decodes %XX. nullopt if two hexadecimal digits are missing after a %.
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

/// Returns what is not allowed in a decoded uri; "" for a plain relative path.
std::string_view objection_to(std::string_view path) {
    if (path.empty()) return "an empty name";
    if (path.find('\0') != path.npos) return "a NUL byte";
    if (path.find('\\') != path.npos) return "a backslash";
    if (path.front() == '/') return "an absolute path";
    const std::size_t colon = path.find(':');
    if (colon != path.npos && path.substr(0, colon).find('/') == path.npos) return "a scheme or a drive";
    for (std::size_t begin = 0; begin <= path.size();) {
        const std::size_t end = std::min(path.find('/', begin), path.size());
        if (path.substr(begin, end - begin) == "..") return "a step out of the folder (\"..\")";
        begin = end + 1;
    }
    return "";
}

}  // namespace

Result<std::string> resolve_uri(const std::string& folder, std::string_view uri) {
    const auto refused = [](std::string problem) { return Error{Status::Format, {}, std::move(problem), {}}; };
    const std::optional<std::string> path = percent_decoded(uri);
    if (!path) return refused("found a % without two hexadecimal digits; expected a valid uri");
    if (const std::string_view objection = objection_to(*path); !objection.empty()) {
        return refused(
            fmt::format("found {} in the uri; expected a relative path that stays in the model's folder", objection));
    }
    const std::optional<std::string> root = real_path(folder), real = real_path(folder + "/" + *path);
    if (!root || !real)
        return refused("found the name of a missing file; expected an existing file in the model's folder");
    const std::string inside = *root == "/" ? *root : *root + "/";
    if (!real->starts_with(inside)) return refused("found a link out of the model's folder; expected a file in it");
    return *real;
}

Result<std::vector<std::byte>> decode_data_uri(std::string_view uri) {
    const auto refused = [](std::string problem) { return Error{Status::Format, {}, std::move(problem), {}}; };
    const std::size_t comma = uri.find(',');
    if (comma == uri.npos || !uri.substr(0, comma).ends_with(";base64"))
        return refused("found another form of data uri; expected \"data:…;base64,…\"");
    const std::string_view text = uri.substr(comma + 1);
    if (text.size() % 4 != 0)
        return refused(fmt::format("found base64 of {} characters; expected a multiple of 4", text.size()));
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
            return refused(fmt::format("found the byte {:#04x} at {} of the base64 text; expected A-Z, a-z, 0-9, +, /",
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

}  // namespace fase::scene
