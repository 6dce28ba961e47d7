/// Tests `fase atlas`: pages of images, measured rectangles, refusals.
#include <filesystem>
#include <fstream>

#include "fase/atlas/png.hpp"
#include "tests/cli/fase_program.hpp"

namespace fase::cli {
namespace {

namespace fs = std::filesystem;

void write_image(const std::string& path, int width, int height, std::uint8_t shade) {
    atlas::Image image(atlas::Size{width, height});
    for (std::uint8_t& value : image.pixels) value = shade;
    const Result<std::vector<std::byte>> bytes = atlas::write_png(image);
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes->data()), static_cast<std::streamsize>(bytes->size()));
}
/// A folder with five images: two are identical, one is in a sub-folder.
std::string make_sprites(const TemporaryFolder& folder) {
    const std::string sprites = folder / "sprites";
    fs::create_directories(sprites + "/below");
    write_image(sprites + "/a.png", 10, 20, 50);
    write_image(sprites + "/b.PNG", 30, 8, 60);
    write_image(sprites + "/c.png", 16, 16, 70);
    write_image(sprites + "/twin.png", 16, 16, 70);
    write_image(sprites + "/below/d.png", 5, 5, 80);
    std::ofstream(sprites + "/notes.txt") << "no image";
    return sprites;
}
std::size_t files_in(const std::string& folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(AtlasCommand, PacksAFolder) {
    const TemporaryFolder folder;
    const Outcome made = run_fase({"atlas", make_sprites(folder), "-o", folder / "sheet", "--tries", "20", "--json"});
    ASSERT_EQ(made.code, 0) << made.err;
    const auto json = scene::parse_json(made.out);
    ASSERT_TRUE(json) << made.out;
    expect_keys(json->root(), {"count", "pages", "width", "height", "occupancy", "ms"});
    EXPECT_EQ(number_at(json->root(), "count"), 5);
    EXPECT_EQ(number_at(json->root(), "different"), 4);
    EXPECT_EQ(number_at(json->root(), "pages"), 1);
    const Result<atlas::Image> page = atlas::read_png_file(folder / "sheet.png");
    ASSERT_TRUE(page) << page.error().text();
    EXPECT_EQ(page->size.width, number_at(json->root(), "width"));
    EXPECT_EQ(page->size.height, number_at(json->root(), "height"));
    const std::string text = read_file(folder / "sheet.json");
    const auto sheet = scene::parse_json(text);
    ASSERT_TRUE(sheet);
    EXPECT_EQ(keys_of(*sheet->root().find("frames")),
              (std::set<std::string>{"a.png", "b.PNG", "below/d.png", "c.png", "twin.png"}));
}

TEST(AtlasCommand, GivesTheSameFilesForTheSameTries) {
    const TemporaryFolder folder;
    const std::string sprites = make_sprites(folder);
    for (const char* name : {"one", "two"}) {
        fs::create_directory(folder / name);
        ASSERT_EQ(run_fase({"atlas", sprites, "-o", std::string(folder / name) + "/sheet", "--tries", "30"}).code, 0);
    }
    for (const char* file : {"/sheet.png", "/sheet.json"})
        EXPECT_EQ(read_file(std::string(folder / "one") + file), read_file(std::string(folder / "two") + file));
}

TEST(AtlasCommand, CreatesSeveralPagesIfOneIsTooSmall) {
    const TemporaryFolder folder;
    const std::string sprites = make_sprites(folder);
    write_image(sprites + "/large.png", 28, 28, 90);
    const Outcome made = run_fase({"atlas", sprites, "-o", folder / "sheet", "--max", "32", "--json"});
    ASSERT_EQ(made.code, 0) << made.err;
    const auto json = scene::parse_json(made.out);
    ASSERT_TRUE(json);
    const auto pages = static_cast<std::size_t>(number_at(json->root(), "pages"));
    EXPECT_GE(pages, 2u);
    EXPECT_EQ(files_in(folder / ""), 1 + 2 * pages);
    EXPECT_TRUE(fs::exists(folder / "sheet-1.json"));
}

TEST(AtlasCommand, MeasuresRectangles) {
    const TemporaryFolder folder;
    write_file(folder / "sizes.txt", "8 8\n8\t8 \r\n\n  8 8\n8 8");
    const Outcome measured = run_fase({"atlas", "--rects", folder / "sizes.txt", "--budget-ms", "3", "--json"});
    ASSERT_EQ(measured.code, 0) << measured.err;
    const auto json = scene::parse_json(measured.out);
    ASSERT_TRUE(json) << measured.out;
    EXPECT_EQ(number_at(json->root(), "count"), 4);
    EXPECT_EQ(number_at(json->root(), "width"), 16);
    EXPECT_EQ(number_at(json->root(), "occupancy"), 1);
    EXPECT_EQ(run_fase({"atlas", "--rects", folder / "sizes.txt", "--method", "kd_tree", "--tries", "3"}).code, 0);
}

TEST(AtlasCommand, RefusesBadRectangles) {
    const TemporaryFolder folder;
    for (const auto& [text, words] :
         {std::pair("4 4\n5\n", "sizes.txt:2: found \"5\""), std::pair("4 4 4\n", ":1:"), std::pair("4 x\n", ":1:"),
          std::pair("0 4\n", ":1:"), std::pair("-1 4\n", ":1:"), std::pair("4 99999999999\n", ":1:"),
          std::pair("4 70000\n", ":1:"), std::pair("", "found no rectangles")}) {
        write_file(folder / "sizes.txt", text);
        expect_error_line(run_fase({"atlas", "--rects", folder / "sizes.txt"}), 2, words);
    }
    write_file(folder / "sizes.txt", "40 4\n");
    expect_error_line(run_fase({"atlas", "--rects", folder / "sizes.txt", "--max", "39"}), 2,
                      "rectangle 0: found 40 x 4");
    expect_error_line(run_fase({"atlas", "--rects", folder / "none.txt"}), 3, "none.txt");
}

TEST(AtlasCommand, WritesNothingWhenItRefuses) {
    const TemporaryFolder folder;
    const std::string sprites = make_sprites(folder), out = folder / "out";
    fs::create_directory(out);
    const std::string name = out + "/sheet";
    expect_error_line(run_fase({"atlas", sprites, "-o", name, "--max", "29"}), 2, "b.PNG: found 30 x 8");
    write_file(sprites + "/torn.png", read_file(sprites + "/a.png").substr(0, 40));
    expect_error_line(run_fase({"atlas", sprites, "-o", name}), 2, "torn.png:");
    fs::remove(sprites + "/torn.png");
    fs::create_directory(out + "/sheet.json");
    expect_error_line(run_fase({"atlas", sprites, "-o", name}), 3, "sheet.json");
    fs::remove(out + "/sheet.json");
    expect_error_line(run_fase({"atlas", sprites, "-o", sprites + "/a.png/sheet"}), 3, "expected a folder");
    expect_error_line(run_fase({"atlas", sprites + "/a.png", sprites + "/none.png", "-o", name}), 3, "none.png");
    expect_error_line(run_fase({"atlas", sprites + "/a.png", sprites + "/a.png", "-o", name}), 2, "a.png");
    expect_error_line(run_fase({"atlas", sprites + "/a.png", "-o", sprites + "/a"}), 3, "found an input file");
    expect_error_line(run_fase({"atlas", out, "-o", name}), 2, "found no .png file");
    EXPECT_EQ(files_in(out), 0u);
}

TEST(AtlasCommand, ListsAllBadImagesAtOnce) {
    const TemporaryFolder folder;
    const std::string sprites = make_sprites(folder), name = folder / "sheet";
    write_file(sprites + "/torn.png", read_file(sprites + "/a.png").substr(0, 40));
    expect_error_line(run_fase({"atlas", sprites, "-o", name}), 2, "--skip-bad leaves it out");
    write_file(sprites + "/photo.png", "\xff\xd8\xff\xe0 JFIF");
    write_file(sprites + "/empty.png", "");
    const Outcome refused = run_fase({"atlas", sprites, "-o", name});
    EXPECT_EQ(refused.code, 2);
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 4) << refused.err;
    for (const char* words : {"/empty.png: found an empty file", "/photo.png: found a JPEG image", "/torn.png: byte ",
                              "found that 3 of 8 images cannot be read; --skip-bad leaves them out\n"})
        EXPECT_NE(refused.err.find(words), std::string::npos) << words << " is not in\n" << refused.err;
    EXPECT_FALSE(fs::exists(name + ".png"));
}

TEST(AtlasCommand, LeavesOutBadImagesOnRequest) {
    const TemporaryFolder folder;
    const std::string sprites = make_sprites(folder), name = folder / "sheet";
    write_file(sprites + "/photo.png", "\xff\xd8\xff\xe0 JFIF");
    write_file(sprites + "/torn.png", read_file(sprites + "/a.png").substr(0, 40));
    const Outcome made = run_fase({"atlas", sprites, "-o", name, "--skip-bad", "--json"});
    EXPECT_EQ(made.code, 0) << made.err;
    EXPECT_TRUE(made.err.starts_with("fase: warning: ")) << made.err;
    EXPECT_TRUE(made.err.ends_with("fase: warning: 2 of 7 images cannot be read and are left out\n")) << made.err;
    const auto json = scene::parse_json(made.out);
    ASSERT_TRUE(json) << made.out;
    EXPECT_EQ(number_at(json->root(), "count"), 5);
    EXPECT_EQ(number_at(json->root(), "skipped"), 2);
    const Outcome none = run_fase({"atlas", sprites + "/torn.png", "-o", folder / "other", "--skip-bad"});
    EXPECT_EQ(none.code, 2);
    EXPECT_NE(none.err.find("1 of 1 images cannot be read; expected at least one good one"), std::string::npos);
    EXPECT_FALSE(fs::exists(folder / "other.png"));
    expect_error_line(run_fase({"atlas", "--rects", sprites + "/notes.txt", "--skip-bad"}), 2,
                      "--skip-bad: found --rects");
}

TEST(AtlasCommand, LinksThatLeadNowhereAreBadImages) {
    const TemporaryFolder folder;
    const std::string sprites = make_sprites(folder), name = folder / "sheet";
    fs::create_symlink("nothing.png", sprites + "/lost.png");
    expect_error_line(run_fase({"atlas", sprites, "-o", name}), 3, "/lost.png: cannot open: ");
    fs::create_symlink("circle.png", sprites + "/circle.png");
    const Outcome made = run_fase({"atlas", sprites, "-o", name, "--skip-bad"});
    EXPECT_EQ(made.code, 0) << made.err;
    for (const char* words : {"/lost.png: cannot open: ", "/circle.png: cannot open: ", "2 of 7 images cannot be read"})
        EXPECT_NE(made.err.find(words), std::string::npos) << made.err;
    EXPECT_TRUE(fs::exists(name + ".png"));
}

TEST(AtlasCommand, RefusesALinkThatLeavesTheFolder) {
    const TemporaryFolder folder;
    const std::string sprites = make_sprites(folder);
    write_image(folder / "outside.png", 4, 4, 9);
    fs::create_symlink(folder / "outside.png", sprites + "/inside.png");
    expect_error_line(run_fase({"atlas", sprites, "-o", folder / "sheet"}), 2, "leaves the folder");
    EXPECT_FALSE(fs::exists(folder / "sheet.png"));
}

TEST(AtlasCommand, RefusesInvalidOptions) {
    expect_error_line(run_fase({"atlas"}), 2, "found none; expected PNG files");
    expect_error_line(run_fase({"atlas", "a.png"}), 2, "--output");
    expect_error_line(run_fase({"atlas", "a.png", "--rects", "x", "-o", "y"}), 2, "--rects");
    expect_error_line(run_fase({"atlas", "--rects", "x", "--method", "best_of_all"}), 2, "--method");
    expect_error_line(run_fase({"atlas", "--rects", "x", "--max", "0"}), 2, "--max");
    expect_error_line(run_fase({"atlas", "--rects", "x", "--budget-ms", "-1"}), 2, "--budget-ms");
}

TEST(AtlasCommand, RefusesEachBrokenImage) {
    const std::string suite = std::string(FASE_SHARED_DATA) + "/png/pngsuite";
    if (!fs::exists(suite)) GTEST_SKIP() << "skipped: no " << suite;
    const TemporaryFolder folder;
    std::size_t broken = 0;
    for (const auto& entry : fs::directory_iterator(suite)) {
        const std::string name = entry.path().filename();
        if (name[0] != 'x' || entry.path().extension() != ".png") continue;
        ++broken;
        expect_error_line(run_fase({"atlas", entry.path(), "-o", folder / "sheet"}), 2, name);
    }
    EXPECT_EQ(broken, 14u);
    EXPECT_EQ(files_in(folder / ""), 0u);
}

}  // namespace
}  // namespace fase::cli
