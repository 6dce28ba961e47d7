/// Parses the header, the directory and the lumps; validates each against the size of the file.
#include "fase/level/wad.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>

#include "fase/core/detail/file_kind.hpp"
#include "fase/core/detail/files.hpp"
#include "fase/core/detail/text.hpp"
#include "fase/level/detail/little_endian.hpp"

namespace fase::level {
namespace {

constexpr std::size_t header_bytes = 12, entry_bytes = 16;

Error at_byte(const std::string& name, std::size_t byte, std::string problem) {
    return {Status::Format, detail::at_byte(name, byte), std::move(problem), {}};
}

bool same_name(std::string_view a, std::string_view b) {
    const auto upper = [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; };
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), [&](char x, char y) { return upper(x) == upper(y); });
}

bool is_map_lump(std::string_view name) {
    return std::any_of(map_lump_names.begin(), map_lump_names.end(),
                       [&](std::string_view known) { return same_name(name, known); });
}

}  // namespace

Result<Wad> Wad::parse(const std::string& name, std::span<const std::byte> bytes) {
    if (const FileKind found = kind_of(bytes); found != FileKind::Wad)
        return wrong_kind(name, found, "a WAD file, which begins with IWAD or PWAD");
    if (bytes.size() < header_bytes)
        return at_byte(name, 0, fmt::format("found {} bytes; expected a WAD header of {}", bytes.size(), header_bytes));
    const std::string magic(reinterpret_cast<const char*>(bytes.data()), 4);
    const std::int64_t count = read_i32(bytes, 4), directory = read_i32(bytes, 8);
    const auto size = static_cast<std::int64_t>(bytes.size());
    if (count < 0) return at_byte(name, 4, fmt::format("found {} lumps; expected 0 or more", count));
    if (directory < 0 || directory > size || count > (size - directory) / static_cast<std::int64_t>(entry_bytes)) {
        return at_byte(
            name, 8,
            fmt::format("found a directory of {} entries at byte {}; expected it inside the file of {} bytes", count,
                        directory, size));
    }
    Wad wad;
    wad.kind = magic == "IWAD" ? Kind::Whole : Kind::Patch;
    std::int64_t sum = 0;
    for (std::int64_t i = 0; i < count; ++i) {
        const auto entry = static_cast<std::size_t>(directory) + static_cast<std::size_t>(i) * entry_bytes;
        const std::int64_t at = read_i32(bytes, entry), length = read_i32(bytes, entry + 4);
        const std::string lump = read_name(bytes, entry + 8);
        if (length < 0)
            return at_byte(name, entry + 4, fmt::format("found lump {} of {} bytes; expected 0 or more", i, length));
        if (length > 0 && (at < 0 || at > size || length > size - at)) {
            return at_byte(name, entry,
                           fmt::format("found lump {} of {} bytes at byte {}; expected it inside the file of {} bytes",
                                       i, length, at, size));
        }
        sum += length;
        if (sum > 4 * size + (1 << 20))
            return at_byte(name, entry, "found lumps that overlap many times; expected separate lumps");
        const auto first = bytes.begin() + (length > 0 ? at : 0);
        wad.lumps.push_back({lump, std::vector<std::byte>(first, first + length)});
    }
    return wad;
}

Result<Wad> Wad::read(const std::string& path) {
    const Result<std::vector<std::byte>> bytes = read_file(path, max_bytes);
    if (!bytes) return bytes.error();
    return parse(path, *bytes);
}

Result<std::vector<std::byte>> Wad::to_bytes() const {
    std::uint64_t total = header_bytes + entry_bytes * std::uint64_t{lumps.size()};
    for (const Lump& lump : lumps) total += lump.bytes.size();
    if (total > 0x7fffffff)
        return Error{Status::OutOfRange, "WAD", fmt::format("found {} bytes; expected less than 2^31", total), {}};
    std::vector<std::byte> out;
    out.reserve(total);
    for (const char c : std::string_view(kind == Kind::Whole ? "IWAD" : "PWAD")) out.push_back(std::byte(c));
    append_u32(out, static_cast<std::uint32_t>(lumps.size()));
    append_u32(out, static_cast<std::uint32_t>(total - entry_bytes * lumps.size()));
    std::vector<std::uint32_t> offsets;
    for (const Lump& lump : lumps) {
        offsets.push_back(static_cast<std::uint32_t>(out.size()));
        out.insert(out.end(), lump.bytes.begin(), lump.bytes.end());
    }
    for (std::size_t i = 0; i < lumps.size(); ++i) {
        append_u32(out, offsets[i]);
        append_u32(out, static_cast<std::uint32_t>(lumps[i].bytes.size()));
        append_name(out, lumps[i].name);
    }
    return out;
}

std::vector<std::size_t> Wad::map_markers() const {
    std::vector<std::size_t> markers;
    for (std::size_t i = 0; i + 1 < lumps.size(); ++i) {
        const bool text = same_name(lumps[i + 1].name, "TEXTMAP");
        const bool binary =
            i + 2 < lumps.size() && same_name(lumps[i + 1].name, "THINGS") && same_name(lumps[i + 2].name, "LINEDEFS");
        if (text || binary) markers.push_back(i);
    }
    return markers;
}

std::optional<std::size_t> Wad::find_map(std::string_view map) const {
    std::optional<std::size_t> found;
    for (const std::size_t marker : map_markers())
        if (same_name(lumps[marker].name, map)) found = marker;
    return found;
}

std::size_t Wad::lumps_of_map(std::size_t marker) const {
    std::size_t count = 0;
    if (marker + 1 < lumps.size() && same_name(lumps[marker + 1].name, "TEXTMAP")) {
        while (marker + 1 + count < lumps.size() && !same_name(lumps[marker + 1 + count].name, "ENDMAP")) ++count;
        return std::min(count + 1, lumps.size() - marker - 1);
    }
    while (marker + 1 + count < lumps.size() && is_map_lump(lumps[marker + 1 + count].name)) ++count;
    return count;
}

std::optional<std::size_t> Wad::find_in_map(std::size_t marker, std::string_view lump) const {
    for (std::size_t i = marker + 1; i <= marker + lumps_of_map(marker); ++i)
        if (same_name(lumps[i].name, lump)) return i;
    return std::nullopt;
}

void Wad::set_in_map(std::size_t marker, std::string_view lump, std::vector<std::byte> bytes) {
    if (const std::optional<std::size_t> place = find_in_map(marker, lump)) {
        lumps[*place].bytes = std::move(bytes);
        return;
    }
    const auto end = static_cast<std::ptrdiff_t>(marker + 1 + lumps_of_map(marker));
    lumps.insert(lumps.begin() + end, Lump{std::string(lump), std::move(bytes)});
}

}  // namespace fase::level
