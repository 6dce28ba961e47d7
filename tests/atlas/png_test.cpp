/// Tests PNG reading and writing: the published suite, broken files, and a round trip.
#include "fase/atlas/png.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "fase/core/detail/files.hpp"

namespace fase::atlas {
namespace {

namespace fs = std::filesystem;

const std::string suite = std::string(FASE_SHARED_DATA) + "/png/pngsuite";

std::vector<fs::path> files_of_suite(bool broken) {
    std::vector<fs::path> files;
    if (!fs::exists(suite)) return files;
    for (const auto& entry : fs::directory_iterator(suite)) {
        const std::string name = entry.path().filename().string();
        if (entry.path().extension() == ".png" && name != "PngSuite.png" && (name[0] == 'x') == broken)
            files.push_back(entry.path());
    }
    std::sort(files.begin(), files.end());
    return files;
}
std::vector<std::byte> bytes_of(const fs::path& path) { return *read_file(path.string(), 1 << 20); }

Image any_image(int max_side) {
    Image image(Size{*rc::gen::inRange(1, max_side), *rc::gen::inRange(1, max_side)});
    for (std::uint8_t& value : image.pixels) value = *rc::gen::arbitrary<std::uint8_t>();
    return image;
}
std::uint32_t crc_of(std::span<const std::byte> bytes) {
    std::uint32_t crc = 0xffffffff;
    for (const std::byte b : bytes) {
        crc ^= static_cast<std::uint32_t>(b);
        for (int i = 0; i < 8; ++i) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320 : 0);
    }
    return ~crc;
}
void put(std::vector<std::byte>& bytes, std::size_t at, std::uint32_t value) {
    for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::byte>(value >> (24 - 8 * i));
}
/// Changes width and height in a file's header and updates its checksum.
void set_size(std::vector<std::byte>& bytes, std::uint32_t width, std::uint32_t height) {
    put(bytes, 16, width);
    put(bytes, 20, height);
    put(bytes, 29, crc_of(std::span(bytes).subspan(12, 17)));
}

TEST(Png, ReadsTheWholeSuite) {
    const std::vector<fs::path> files = files_of_suite(false);
    if (files.empty()) GTEST_SKIP() << "skipped: no " << suite;
    EXPECT_GT(files.size(), 150u);
    for (const fs::path& path : files) {
        const Result<Image> image = read_png_file(path.string());
        ASSERT_TRUE(image) << image.error().text();
        // Most images are 32 x 32. The names s01 to s40 contain the size; those of cd have non-square pixels.
        const std::string name = path.filename().string();
        const int side = name[0] == 's' && name[1] != 't' ? std::stoi(name.substr(1, 2)) : 0;
        if (side != 0) {
            EXPECT_EQ(image->size, Size(side, side)) << name;
        }
    }
}

TEST(Png, InterlacedAndPlainVersionsAreEqual) {
    std::size_t twins = 0;
    for (const fs::path& path : files_of_suite(false)) {
        const std::string name = path.filename().string();
        if (!name.starts_with("basi") && !(name[0] == 's' && name[3] == 'i')) continue;
        std::string twin = name;
        twin[3] = 'n';
        const Result<Image> a = read_png_file(path.string()), b = read_png_file((path.parent_path() / twin).string());
        ASSERT_TRUE(a) << name;
        ASSERT_TRUE(b) << twin;
        EXPECT_EQ(*a, *b) << name;
        ++twins;
    }
    if (twins == 0) GTEST_SKIP() << "skipped: no " << suite;
    EXPECT_EQ(twins, 33u);
}

TEST(Png, ReadsTransparency) {
    if (!fs::exists(suite)) GTEST_SKIP() << "skipped: no " << suite;
    for (const char* name : {"tbbn0g04", "tbbn2c16", "tbbn3p08", "tm3n3p02", "basn4a08", "basn6a16"}) {
        const Result<Image> image = read_png_file(suite + "/" + name + ".png");
        ASSERT_TRUE(image) << name;
        std::size_t clear = 0, other = 0;
        for (std::size_t i = 3; i < image->pixels.size(); i += 4) (image->pixels[i] < 128 ? clear : other) += 1;
        EXPECT_GT(clear, 0u) << name;
        EXPECT_GT(other, 0u) << name;
    }
}

TEST(Png, RejectsEveryBrokenFileOfTheSuite) {
    const std::vector<fs::path> files = files_of_suite(true);
    if (files.empty()) GTEST_SKIP() << "skipped: no " << suite;
    EXPECT_EQ(files.size(), 14u);
    for (const fs::path& path : files) {
        const Result<Image> image = read_png_file(path.string());
        ASSERT_FALSE(image) << path;
        EXPECT_EQ(image.status(), Status::Format) << path;
        EXPECT_TRUE(image.error().where.starts_with(path.string() + ":")) << image.error().text();
        EXPECT_EQ(image.error().text().find('\n'), std::string::npos);
    }
}

TEST(Png, RejectsAFileTruncatedAtAnyByte) {
    std::vector<fs::path> files = files_of_suite(false);
    if (files.empty()) GTEST_SKIP() << "skipped: no " << suite;
    for (std::size_t f = 0; f < files.size(); f += 5) {
        const std::vector<std::byte> bytes = bytes_of(files[f]);
        for (std::size_t size = 0; size < bytes.size(); ++size) {
            const std::vector<std::byte> cut(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
            ASSERT_FALSE(read_png(cut, "cut")) << files[f] << " of " << size << " bytes";
        }
    }
}

TEST(Png, RejectsAFlippedBitInAnyByte) {
    if (!fs::exists(suite)) GTEST_SKIP() << "skipped: no " << suite;
    for (const char* name : {"basn3p08", "basi6a16", "tbbn3p08", "basn0g01"}) {
        const std::vector<std::byte> bytes = bytes_of(suite + "/" + name + ".png");
        for (std::size_t i = 0; i < bytes.size(); ++i) {
            std::vector<std::byte> wrong = bytes;
            wrong[i] ^= std::byte{static_cast<unsigned char>(1u << i % 8)};
            ASSERT_FALSE(read_png(wrong, "wrong"))
                << name << ": byte " << i << ", although a checksum covers every byte";
        }
    }
}

TEST(Png, RejectsImpossibleSizes) {
    const std::vector<std::byte> good = *write_png(Image(Size{3, 2}));
    ASSERT_TRUE(read_png(good, "good"));
    for (const auto& [width, height, text] :
         {std::tuple(0x7fffffffu, 0x7fffffffu, "image expands to"), std::tuple(0x80000000u, 1u, "broken"),
          std::tuple(0u, 5u, "broken"), std::tuple(8193u, 8192u, "image expands to"),
          std::tuple(8192u, 8192u, "expected at least"), std::tuple(4u, 2u, "broken"), std::tuple(3u, 3u, "broken")}) {
        std::vector<std::byte> bytes = good;
        set_size(bytes, width, height);
        const Result<Image> image = read_png(bytes, "file.png");
        ASSERT_FALSE(image) << width << " x " << height;
        EXPECT_NE(image.error().problem.find(text), std::string::npos) << image.error().text();
    }
}

TEST(Png, RejectsAPaletteIndexWithoutAColour) {
    if (!fs::exists(suite)) GTEST_SKIP() << "skipped: no " << suite;
    std::vector<std::byte> bytes = bytes_of(suite + "/basn3p08.png");
    const char word[] = "PLTE";
    const auto at = std::search(bytes.begin(), bytes.end(), word, word + 4,
                                [](std::byte a, char b) { return a == static_cast<std::byte>(b); });
    ASSERT_NE(at, bytes.end());
    const auto start = static_cast<std::size_t>(at - bytes.begin());
    // Remove all but two colours from the palette.
    const std::size_t old = 3 * 256;
    bytes.erase(at + 4 + 6, at + 4 + static_cast<std::ptrdiff_t>(old));
    put(bytes, start - 4, 6);
    put(bytes, start + 4 + 6, crc_of(std::span(bytes).subspan(start, 4 + 6)));
    const Result<Image> image = read_png(bytes, "file.png");
    ASSERT_FALSE(image);
    EXPECT_NE(image.error().problem.find("palette index"), std::string::npos) << image.error().text();
}

/// Puts a chunk after the header.
std::vector<std::byte> with_chunk(std::vector<std::byte> bytes, std::string_view name, std::uint32_t length,
                                  std::span<const std::byte> content) {
    std::vector<std::byte> chunk(8);
    put(chunk, 0, length);
    for (std::size_t i = 0; i < 4; ++i) chunk[4 + i] = static_cast<std::byte>(name[i]);
    chunk.insert(chunk.end(), content.begin(), content.end());
    chunk.resize(chunk.size() + 4);
    put(chunk, chunk.size() - 4, crc_of(std::span(chunk).subspan(4, chunk.size() - 8)));
    bytes.insert(bytes.begin() + 33, chunk.begin(), chunk.end());
    return bytes;
}

TEST(Png, BelievesNoChunkLength) {
    const std::vector<std::byte> good = *write_png(Image(Size{3, 2}));
    for (const char* name : {"zTXt", "iTXt", "tEXt", "iCCP", "IDAT", "PLTE", "eXIf", "abCd"}) {
        for (const std::uint32_t length : {0xffffffffu, 0x7fffffffu, 0x3fffffffu, 1000u}) {
            const Result<Image> image = read_png(with_chunk(good, name, length, {}), "file.png");
            ASSERT_FALSE(image) << name;
            EXPECT_EQ(image.error().where, "file.png: byte 33");
        }
    }
    std::vector<std::byte> cut = good;
    cut.resize(cut.size() - 12);
    EXPECT_FALSE(read_png(cut, "without an end"));
}

/// Nine kilobytes of text that expand to nine megabytes: not read at all.
TEST(Png, PassesOverTextsAndProfiles) {
    const Image picture(Size{3, 2});
    std::vector<std::byte> content;
    for (const char c : std::string_view("text\0\0", 6)) content.push_back(static_cast<std::byte>(c));
    const std::vector<unsigned char> text(9'000'000, 'a');
    uLongf size = compressBound(text.size());
    std::vector<unsigned char> packed(size);
    ASSERT_EQ(compress2(packed.data(), &size, text.data(), text.size(), 9), Z_OK);
    for (uLongf i = 0; i < size; ++i) content.push_back(static_cast<std::byte>(packed[i]));
    const auto length = static_cast<std::uint32_t>(content.size());
    for (const char* name : {"zTXt", "iCCP"}) {
        const Result<Image> image = read_png(with_chunk(*write_png(picture), name, length, content), "file.png");
        ASSERT_TRUE(image) << image.error().text();
        EXPECT_EQ(*image, picture);
    }
}

TEST(Png, RejectsInputThatIsNotAPngFile) {
    EXPECT_EQ(read_png_file("/nowhere/at/all.png").status(), Status::Io);
    EXPECT_EQ(read_png_file("/").status(), Status::Format);
    EXPECT_EQ(write_png(Image()).status(), Status::BadArgument);
    EXPECT_EQ(read_png({}, "empty").status(), Status::Format);
}

RC_GTEST_PROP(Png, RoundTripIsExact, ()) {
    const Image image = any_image(12);
    const Result<std::vector<std::byte>> bytes = write_png(image);
    RC_ASSERT(bytes.has_value());
    const Result<Image> back = read_png(*bytes, "back");
    RC_ASSERT(back.has_value());
    RC_ASSERT(*back == image);
}

RC_GTEST_PROP(Image, VisiblePartIsTheSmallestAreaWithAllVisiblePixels, ()) {
    Image image(Size{*rc::gen::inRange(1, 12), *rc::gen::inRange(1, 12)});
    for (int n = *rc::gen::inRange(0, 4); n > 0; --n)
        image.at(*rc::gen::inRange(0, image.size.width), *rc::gen::inRange(0, image.size.height))[3] = 9;
    const Area part = visible_part(image);
    Area least{image.size.width, image.size.height, 0, 0};
    int right = 0, bottom = 0;
    for (int y = 0; y < image.size.height; ++y)
        for (int x = 0; x < image.size.width; ++x)
            if (image.at(x, y)[3] != 0) {
                least.x = std::min(least.x, x);
                least.y = std::min(least.y, y);
                right = std::max(right, x + 1);
                bottom = std::max(bottom, y + 1);
            }
    if (right == 0) {
        RC_ASSERT(part == (Area{0, 0, 1, 1}));
    } else {
        RC_ASSERT(part == (Area{least.x, least.y, right - least.x, bottom - least.y}));
    }
    RC_ASSERT(cut_out(image, part).size == (Size{part.width, part.height}));
}

}  // namespace
}  // namespace fase::atlas
