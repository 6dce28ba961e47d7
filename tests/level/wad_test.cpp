/// Reads and writes WAD files, and reads maps from them.
#include "fase/level/wad.hpp"

#include <gtest/gtest.h>

#include <filesystem>

#include "fase/core/detail/files.hpp"
#include "fase/core/random.hpp"
#include "fase/level/detail/little_endian.hpp"
#include "fase/level/map.hpp"

namespace fase::level {
namespace {

std::vector<std::filesystem::path> freedoom() {
    std::vector<std::filesystem::path> files;
    const auto folder = std::filesystem::path(FASE_SHARED_DATA) / "freedoom";
    if (!std::filesystem::exists(folder)) return files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".wad") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

/// A square room of four lines, as lumps.
Wad room() {
    Wad wad;
    std::vector<std::byte> vertices, lines, sides, sector;
    for (const auto& [x, y] : {std::pair{0, 0}, {0, 64}, {64, 64}, {64, 0}}) {
        append_i16(vertices, static_cast<std::int16_t>(x));
        append_i16(vertices, static_cast<std::int16_t>(y));
    }
    for (std::uint16_t i = 0; i < 4; ++i)
        for (const int value : {int{i}, (i + 1) % 4, 1, 0, 0, 0, 0xffff})
            append_u16(lines, static_cast<std::uint16_t>(value));
    append_u32(sides, 0);
    for (int i = 0; i < 3; ++i) append_name(sides, "-");
    append_u16(sides, 0);
    append_i16(sector, 0);
    append_i16(sector, 128);
    append_name(sector, "FLOOR");
    append_name(sector, "CEIL");
    for (int i = 0; i < 3; ++i) append_u16(sector, 0);
    wad.lumps = {{"MAP01", {}},       {"THINGS", {}},         {"LINEDEFS", lines},
                 {"SIDEDEFS", sides}, {"VERTEXES", vertices}, {"SECTORS", sector}};
    return wad;
}

TEST(Wad, RoundTripsThroughBytes) {
    const Wad wad = room();
    const auto bytes = wad.to_bytes();
    ASSERT_TRUE(bytes);
    const auto again = Wad::parse("room", *bytes);
    ASSERT_TRUE(again) << again.error().text();
    ASSERT_EQ(again->lumps.size(), wad.lumps.size());
    for (std::size_t i = 0; i < wad.lumps.size(); ++i) {
        EXPECT_EQ(again->lumps[i].name, wad.lumps[i].name);
        EXPECT_EQ(again->lumps[i].bytes, wad.lumps[i].bytes);
    }
    EXPECT_EQ(*again->to_bytes(), *bytes);
}

TEST(Wad, ReadsAllGivenFreedoomMaps) {
    const auto files = freedoom();
    if (files.empty()) GTEST_SKIP() << "skipped: no levels in " << FASE_SHARED_DATA;
    for (const auto& file : files) {
        const auto wad = Wad::read(file.string());
        ASSERT_TRUE(wad) << wad.error().text();
        const auto markers = wad->map_markers();
        ASSERT_EQ(markers.size(), 1u) << file;
        const auto map = read_map(file.string(), *wad, wad->lumps[markers[0]].name);
        ASSERT_TRUE(map) << map.error().text();
        EXPECT_GT(map->lines.size(), 100u);
        EXPECT_GT(map->sectors.size(), 10u);
    }
}

TEST(Wad, ReadsASquareRoom) {
    const auto map = read_map("room", room(), "map01");
    ASSERT_TRUE(map) << map.error().text();
    EXPECT_EQ(map->lines.size(), 4u);
    EXPECT_EQ(map->sectors[0].ceiling, 128);
    EXPECT_EQ(map->sides[0].middle, "-");
    const auto none = read_map("room", room(), "E1M1");
    ASSERT_FALSE(none);
    EXPECT_NE(none.error().text().find("MAP01"), std::string::npos);
}

TEST(Wad, LeavesOutWhatCannotBeUsedAndNamesIt) {
    const auto read = [](std::string_view lump, std::size_t byte, int value) {
        Wad wad = room();
        auto& bytes = wad.lumps[*wad.find_in_map(0, lump)].bytes;
        bytes[byte] = static_cast<std::byte>(value & 0xff);
        bytes[byte + 1] = static_cast<std::byte>(value >> 8 & 0xff);
        const auto map = read_map("room", wad, "MAP01");
        EXPECT_TRUE(map) << map.error().text();
        EXPECT_EQ(map->lines.size(), 4u) << "the numbers of lines do not change";
        EXPECT_EQ(map->left_out.size(), 1u);
        return map->left_out.empty() ? std::string() : map->left_out[0];
    };
    EXPECT_EQ(read("LINEDEFS", 14, 9), "a line with a vertex that does not exist, LINEDEFS[1]");
    EXPECT_EQ(read("LINEDEFS", 14, 2), "a line of zero length, LINEDEFS[1]");
    EXPECT_EQ(read("LINEDEFS", 24, 1), "a line with a side that does not exist, LINEDEFS[1]");
    EXPECT_EQ(read("LINEDEFS", 24, 0xffff), "a line without a side, LINEDEFS[1]");
}

TEST(Wad, KeepsALineWithOneGoodSide) {
    Wad wad = room();
    auto& lines = wad.lumps[*wad.find_in_map(0, "LINEDEFS")].bytes;
    lines[14 + 12] = std::byte{9};  // a left side that does not exist
    lines[14 + 13] = std::byte{0};
    const auto map = read_map("room", wad, "MAP01");
    ASSERT_TRUE(map);
    EXPECT_EQ(map->lines[1].right, 0);
    EXPECT_EQ(map->lines[1].left, no_side);
    EXPECT_EQ(map->left_out.size(), 1u);
}

TEST(Wad, IgnoresASideThatNoLineUses) {
    Wad wad = room();
    append_u32(wad.lumps[*wad.find_in_map(0, "SIDEDEFS")].bytes, 0);
    for (int i = 0; i < 3; ++i) append_name(wad.lumps[*wad.find_in_map(0, "SIDEDEFS")].bytes, "-");
    append_u16(wad.lumps[*wad.find_in_map(0, "SIDEDEFS")].bytes, 0xffff);
    const auto map = read_map("room", wad, "MAP01");
    ASSERT_TRUE(map) << map.error().text();
    EXPECT_TRUE(map->left_out.empty());
}

TEST(Wad, RejectsAMapOfWhichNoLineCanBeUsed) {
    Wad wad = room();
    auto& sides = wad.lumps[*wad.find_in_map(0, "SIDEDEFS")].bytes;
    sides[28] = std::byte{7};
    const auto map = read_map("room", wad, "MAP01");
    ASSERT_FALSE(map);
    EXPECT_EQ(
        map.error().text(),
        "room: MAP01: found 4 lines with a side whose sector does not exist, the first is LINEDEFS[0]; expected a "
        "line that can be used");
}

TEST(Wad, RejectsEveryTruncation) {
    const auto bytes = *room().to_bytes();
    for (std::size_t size = 0; size < bytes.size(); ++size)
        EXPECT_FALSE(Wad::parse("room", std::span(bytes).first(size))) << size;
}

TEST(Wad, SurvivesEveryFlippedBit) {
    const auto bytes = *room().to_bytes();
    for (std::size_t bit = 0; bit < bytes.size() * 8; ++bit) {
        auto flipped = bytes;
        flipped[bit / 8] ^= static_cast<std::byte>(1 << bit % 8);
        const auto wad = Wad::parse("room", flipped);
        if (!wad) continue;
        if (const auto map = read_map("room", *wad, "MAP01"); !map) {
            EXPECT_FALSE(map.error().problem.empty());
        }
    }
}

TEST(Wad, ReportsADirectoryOrLumpOutsideTheFile) {
    auto bytes = *room().to_bytes();
    const auto with = [&](std::size_t at, std::uint32_t value) {
        auto changed = bytes;
        for (std::size_t i = 0; i < 4; ++i) changed[at + i] = static_cast<std::byte>(value >> 8 * i & 0xff);
        const auto wad = Wad::parse("room", changed);
        return wad ? std::string() : wad.error().text();
    };
    EXPECT_NE(with(4, 0xffffffff).find("room: byte 4: found -1 lumps"), std::string::npos);
    EXPECT_NE(with(4, 0x7fffffff).find("expected it inside the file"), std::string::npos);
    EXPECT_NE(with(8, 0x7ffffff0).find("room: byte 8: found a directory"), std::string::npos);
    const std::size_t directory = read_u32(bytes, 8);
    EXPECT_NE(with(directory + 2 * 16 + 4, 0xffffffff).find("of -1 bytes"), std::string::npos);
    EXPECT_NE(with(directory + 2 * 16, 0x7fffffff).find("found lump 2"), std::string::npos);
}

}  // namespace
}  // namespace fase::level
