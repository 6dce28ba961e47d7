#pragma once
/// Reads and writes numbers and names of WAD files: little-endian, two's complement.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace fase::level {

/// Precondition of all read functions: the number, or name, at offset `at` is inside `bytes`.
[[nodiscard]] constexpr std::uint16_t read_u16(std::span<const std::byte> bytes, std::size_t at) {
    return static_cast<std::uint16_t>(std::to_integer<unsigned>(bytes[at]) | std::to_integer<unsigned>(bytes[at + 1])
                                                                                 << 8);
}
[[nodiscard]] constexpr std::int16_t read_i16(std::span<const std::byte> bytes, std::size_t at) {
    return static_cast<std::int16_t>(read_u16(bytes, at));
}
[[nodiscard]] constexpr std::uint32_t read_u32(std::span<const std::byte> bytes, std::size_t at) {
    return read_u16(bytes, at) | std::uint32_t{read_u16(bytes, at + 2)} << 16;
}
[[nodiscard]] constexpr std::int32_t read_i32(std::span<const std::byte> bytes, std::size_t at) {
    return static_cast<std::int32_t>(read_u32(bytes, at));
}
/// The name of at most eight bytes, up to the first zero.
[[nodiscard]] inline std::string read_name(std::span<const std::byte> bytes, std::size_t at) {
    std::string name;
    for (std::size_t i = at; i < at + 8 && bytes[i] != std::byte{0}; ++i) name += static_cast<char>(bytes[i]);
    return name;
}

inline void append_u16(std::vector<std::byte>& out, std::uint16_t value) {
    out.push_back(static_cast<std::byte>(value & 0xff));
    out.push_back(static_cast<std::byte>(value >> 8));
}
inline void append_i16(std::vector<std::byte>& out, std::int16_t value) {
    append_u16(out, static_cast<std::uint16_t>(value));
}
inline void append_u32(std::vector<std::byte>& out, std::uint32_t value) {
    append_u16(out, static_cast<std::uint16_t>(value & 0xffff));
    append_u16(out, static_cast<std::uint16_t>(value >> 16));
}
/// Appends eight bytes: the name, padded with zeros; longer names are truncated.
inline void append_name(std::vector<std::byte>& out, std::string_view name) {
    for (std::size_t i = 0; i < 8; ++i) out.push_back(i < name.size() ? static_cast<std::byte>(name[i]) : std::byte{0});
}

}  // namespace fase::level
