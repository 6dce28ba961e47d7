/// Tests atlases: every pixel of a sprite is where its frame says, and the JSON has the published format.
#include "fase/atlas/atlas.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <filesystem>
#include <fstream>
#include <set>

#include "fase/atlas/png.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase::atlas {
namespace {

Image uniform(int width, int height, std::uint8_t shade, std::uint8_t alpha = 255) {
    Image image(Size{width, height});
    for (std::size_t i = 0; i < image.pixels.size(); ++i) image.pixels[i] = i % 4 == 3 ? alpha : shade;
    return image;
}
/// Returns an image whose pixels all have different colours.
Image speckled(int width, int height, std::uint8_t seed) {
    Image image(Size{width, height});
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            std::uint8_t* p = image.at(x, y);
            p[0] = static_cast<std::uint8_t>(x);
            p[1] = static_cast<std::uint8_t>(y);
            p[2] = seed;
            p[3] = static_cast<std::uint8_t>(200 + (x + y) % 50);
        }
    return image;
}
/// Draws a sprite as a reader of the frame would: untrimmed and unrotated.
Image restored(const Atlas& atlas, const Frame& frame) {
    Image image(frame.source_size);
    for (int y = 0; y < frame.part.height; ++y)
        for (int x = 0; x < frame.part.width; ++x) {
            const int page_x = frame.part.x + (frame.rotated ? frame.part.height - 1 - y : x);
            const int page_y = frame.part.y + (frame.rotated ? x : y);
            const std::uint8_t* from = atlas.pages[frame.page].at(page_x, page_y);
            std::copy(from, from + 4, image.at(frame.source.x + x, frame.source.y + y));
        }
    return image;
}
std::string text_of(const NamedBytes& file) {
    return {reinterpret_cast<const char*>(file.bytes.data()), file.bytes.size()};
}

RC_GTEST_PROP(Atlas, FramesRestoreEverySpriteExactly, ()) {
    std::vector<Sprite> sprites;
    for (int n = *rc::gen::inRange(0, 25); n > 0; --n) {
        Image image(Size{*rc::gen::inRange(1, 20), *rc::gen::inRange(1, 20)});
        const Image part =
            speckled(*rc::gen::inRange(1, image.size.width + 1), *rc::gen::inRange(1, image.size.height + 1),
                     static_cast<std::uint8_t>(*rc::gen::inRange(0, 2)));
        paste(image, part, *rc::gen::inRange(0, 5), *rc::gen::inRange(0, 5), false, 0);
        sprites.push_back({"s" + std::to_string(n), image});
    }
    AtlasOptions options;
    options.trim = *rc::gen::arbitrary<bool>();
    options.pack.max_side = *rc::gen::element(32, 64, 4096);
    options.pack.padding = *rc::gen::inRange(0, 3);
    options.pack.extrude = *rc::gen::inRange(0, 3);
    options.pack.rotate = *rc::gen::arbitrary<bool>();
    options.pack.power_of_two = *rc::gen::arbitrary<bool>();
    options.pack.tries = 5;
    const Result<Atlas> atlas = make_atlas(sprites, options);
    RC_ASSERT(atlas.has_value());
    RC_ASSERT(atlas->frames.size() == sprites.size());
    for (std::size_t i = 0; i < sprites.size(); ++i) {
        RC_ASSERT(atlas->frames[i].name == sprites[i].name);
        RC_ASSERT(restored(*atlas, atlas->frames[i]) == sprites[i].image);
    }
}

TEST(Atlas, EqualSpritesShareOnePlace) {
    Image framed(Size{9, 9});
    paste(framed, uniform(4, 6, 80), 2, 1, false, 0);
    const std::vector<Sprite> sprites{
        {"a", uniform(4, 6, 80)}, {"b", uniform(4, 6, 80)}, {"c", framed}, {"d", uniform(6, 4, 80)}};
    AtlasOptions options;
    EXPECT_EQ(make_atlas(sprites, options)->different, 3u);
    options.trim = true;
    const Result<Atlas> trimmed = make_atlas(sprites, options);
    ASSERT_TRUE(trimmed);
    EXPECT_EQ(trimmed->different, 2u) << "trimmed, the third equals the first";
    EXPECT_EQ(trimmed->frames[2].part, trimmed->frames[0].part);
    EXPECT_TRUE(trimmed->frames[2].trimmed);
    EXPECT_FALSE(trimmed->frames[0].trimmed);
    EXPECT_EQ(trimmed->frames[2].source, (Area{2, 1, 4, 6}));
    EXPECT_EQ(trimmed->frames[2].source_size, (Size{9, 9}));
}

TEST(Atlas, RepeatsEdgesAroundSprites) {
    AtlasOptions options;
    options.pack.extrude = 2;
    const Result<Atlas> atlas = make_atlas(std::vector<Sprite>{{"one", speckled(3, 5, 7)}}, options);
    ASSERT_TRUE(atlas);
    const Image& page = atlas->pages.at(0);
    const Frame& frame = atlas->frames.at(0);
    const int width = frame.rotated ? 5 : 3, height = frame.rotated ? 3 : 5;
    EXPECT_EQ(page.size, Size(width + 4, height + 4));
    for (int y = 0; y < page.size.height; ++y)
        for (int x = 0; x < page.size.width; ++x) {
            const int inner_x = std::clamp(x, 2, 1 + width), inner_y = std::clamp(y, 2, 1 + height);
            EXPECT_TRUE(std::equal(page.at(x, y), page.at(x, y) + 4, page.at(inner_x, inner_y))) << x << ", " << y;
        }
}

TEST(Atlas, RefusesNamesThatLeaveTheFolder) {
    for (const char* bad : {"", "../a.png", "a/../../b.png", "/etc/a.png", "C:/a.png", "a\\b.png", "a//b.png",
                            "./a.png", "a/", "..", "a\nb.png", "\x80.png", "\xc0\xaf.png", "\xed\xa0\x80"}) {
        const Result<Atlas> atlas = make_atlas(std::vector<Sprite>{{bad, uniform(1, 1, 0)}});
        ASSERT_FALSE(atlas) << bad;
        EXPECT_EQ(atlas.status(), Status::BadArgument);
    }
    for (const char* good : {"a.png", "a/b c.png", "...png", "\xc3\xa4/\xf0\x9f\x98\x80.png", "a..b"})
        EXPECT_EQ(problem_of_name(good), "") << good;
    EXPECT_EQ(make_atlas(std::vector<Sprite>{{"a", uniform(1, 1, 0)}, {"a", uniform(2, 1, 0)}}).status(),
              Status::BadArgument);
}

TEST(Atlas, ErrorNamesTheSpriteThatIsLargerThanAPage) {
    AtlasOptions options;
    options.pack.max_side = 16;
    const Result<Atlas> atlas =
        make_atlas(std::vector<Sprite>{{"small", uniform(8, 8, 0)}, {"wide", uniform(17, 2, 0)}}, options);
    ASSERT_FALSE(atlas);
    EXPECT_EQ(atlas.error().where, "wide");
    EXPECT_NE(atlas.error().problem.find("17 x 2"), std::string::npos) << atlas.error().text();
}

TEST(Atlas, WritesThePublishedJsonFormat) {
    const std::vector<Sprite> sprites{{"quote\".png", speckled(10, 20, 1)}, {"b/c.png", speckled(30, 8, 2)}};
    for (const bool array : {false, true}) {
        AtlasOptions options;
        options.array = array;
        const Result<Atlas> atlas = make_atlas(sprites, options);
        const Result<std::vector<NamedBytes>> files = files_of(*atlas, "some/where/sheet", options);
        ASSERT_TRUE(files);
        ASSERT_EQ(files->size(), 2u);
        EXPECT_EQ(files->at(0).name, "some/where/sheet.png");
        EXPECT_EQ(files->at(1).name, "some/where/sheet.json");
        EXPECT_EQ(*read_png(files->at(0).bytes, ""), atlas->pages[0]);
        const std::string text = text_of(files->at(1));
        const Result<scene::JsonDocument> json = scene::parse_json(text);
        ASSERT_TRUE(json) << json.error().text() << text;
        const scene::JsonValue frames = *json->root().find("frames"), meta = *json->root().find("meta");
        EXPECT_EQ(frames.kind(), array ? scene::JsonKind::Array : scene::JsonKind::Object);
        EXPECT_EQ(frames.size(), 2u);
        std::set<std::string> names;
        if (array) {
            frames.for_each_element([&](const auto& frame) { names.emplace(frame.find("filename")->string()); });
        } else {
            frames.for_each_member([&](std::string_view name, const auto&) { names.emplace(name); });
            const scene::JsonValue frame = *frames.find("b/c.png");
            EXPECT_EQ(frame.find("frame")->find("w")->number(), 30);
            EXPECT_EQ(frame.find("frame")->find("h")->number(), 8);
            EXPECT_EQ(frame.find("rotated")->kind(),
                      atlas->frames[1].rotated ? scene::JsonKind::True : scene::JsonKind::False);
            EXPECT_EQ(frame.find("sourceSize")->find("w")->number(), 30);
            EXPECT_EQ(frame.find("spriteSourceSize")->find("h")->number(), 8);
        }
        EXPECT_EQ(names, (std::set<std::string>{"quote\".png", "b/c.png"}));
        EXPECT_EQ(meta.find("image")->string(), "sheet.png");
        EXPECT_EQ(meta.find("size")->find("w")->number(), atlas->pages[0].size.width);
        EXPECT_FALSE(meta.find("related_multi_packs"));
    }
}

TEST(Atlas, EachPageNamesTheOthers) {
    AtlasOptions options;
    options.pack.max_side = 16;
    std::vector<Sprite> sprites;
    for (int i = 0; i < 3; ++i) sprites.push_back({std::to_string(i), uniform(16, 16, static_cast<std::uint8_t>(i))});
    const Result<Atlas> atlas = make_atlas(sprites, options);
    ASSERT_TRUE(atlas);
    ASSERT_EQ(atlas->pages.size(), 3u);
    const Result<std::vector<NamedBytes>> files = files_of(*atlas, "sheet", options);
    ASSERT_EQ(files->size(), 6u);
    EXPECT_EQ(files->at(5).name, "sheet-2.json");
    EXPECT_NE(text_of(files->at(5)).find("\"related_multi_packs\":[\"sheet-0.json\",\"sheet-1.json\"]"),
              std::string::npos);
    EXPECT_NE(text_of(files->at(5)).find("\"image\":\"sheet-2.png\""), std::string::npos);
}

TEST(Atlas, WritesAllFilesOrNone) {
    namespace fs = std::filesystem;
    const fs::path folder =
        fs::temp_directory_path() / ("fase_atlas_" + std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
                                     "_" + std::to_string(reinterpret_cast<std::uintptr_t>(&folder)));
    fs::create_directories(folder / "blocked");
    const std::string first = folder / "first", blocked = folder / "blocked";
    std::ofstream(first) << "old";
    const std::vector<NamedBytes> files{{first, std::vector<std::byte>(3)}, {blocked, std::vector<std::byte>(3)}};
    EXPECT_EQ(write_files(files).status(), Status::Io);
    std::string content;
    std::ifstream(first) >> content;
    EXPECT_EQ(content, "old");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 2)
        << "no temporary file is left";
    EXPECT_TRUE(write_files(std::span(files).first(1)));
    EXPECT_EQ(fs::file_size(first), 3u);
    fs::remove_all(folder);
}

}  // namespace
}  // namespace fase::atlas
