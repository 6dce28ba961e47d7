#pragma once
/// Error texts with values and places in files, for the layers that depend on no formatting library.
#include <charconv>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>

namespace fase::detail {

/// The shortest decimal text that reads back to the same number; "nan", "inf".
template <std::floating_point T> [[nodiscard]] std::string text_of(T value) {
    char buffer[64];
    const T size = std::fabs(value);
    const bool is_fixed = size == 0 || (size >= T(1e-4) && size < T(1e16));
    const auto end = std::to_chars(buffer, buffer + sizeof buffer, value,
                                   is_fixed ? std::chars_format::fixed : std::chars_format::scientific);
    return {buffer, end.ptr};
}
template <std::integral T> [[nodiscard]] std::string text_of(T value) { return std::to_string(value); }
[[nodiscard]] inline std::string text_of(std::string_view value) { return std::string(value); }
[[nodiscard]] inline std::string text_of(const char* value) { return value; }

/// What an error says of a number: its text_of(); "nan, not a finite number" for those that are not finite.
template <std::floating_point T> [[nodiscard]] std::string found_text(T value) {
    if (std::isnan(value)) return "nan, not a finite number";  // without the sign, which differs between machines
    return std::isfinite(value) ? text_of(value) : text_of(value) + ", not a finite number";
}

/// `value` with two significant digits.
[[nodiscard]] inline std::string rounded_text_of(double value) {
    char buffer[64];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value, std::chars_format::general, 2).ptr};
}

[[nodiscard]] inline std::string fill(std::string_view pattern, std::initializer_list<std::string> values) {
    std::string text;
    for (const std::string& value : values) {
        const std::size_t at = pattern.find("{}");
        text += pattern.substr(0, at);
        text += value;
        pattern.remove_prefix(at == std::string_view::npos ? pattern.size() : at + 2);
    }
    return text += pattern;
}

/// `pattern` with each "{}" replaced by the next value: format("found {} points", 3).
template <class... Values> [[nodiscard]] std::string format(std::string_view pattern, const Values&... values) {
    return fill(pattern, {text_of(values)...});
}

// Where in a file an error is. All readers use these, so that bytes and lines cannot be confused.

/// "byte 123", counted from 0.
[[nodiscard]] inline std::string byte_text(std::uint64_t byte) { return "byte " + std::to_string(byte); }
/// A place in a file of bytes: "castle.glb: byte 123".
[[nodiscard]] inline std::string at_byte(std::string_view file, std::uint64_t byte) {
    return std::string(file) + ": " + byte_text(byte);
}
/// A place in a text file, counted from 1: "sizes.txt:12".
[[nodiscard]] inline std::string at_line(std::string_view file, std::uint64_t line) {
    return std::string(file) + ":" + std::to_string(line);
}

}  // namespace fase::detail
