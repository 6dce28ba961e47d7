/// Tests `fase level`: trees of maps, plans, lumps, refusals.
#include <filesystem>
#include <fstream>

#include "fase/atlas/png.hpp"
#include "fase/level/bsp_lumps.hpp"
#include "tests/cli/fase_program.hpp"
#include "tests/level/drawn_maps.hpp"

namespace fase::cli {
namespace {

namespace fs = std::filesystem;

void write_wad(const std::string& path, const level::Wad& wad) {
    const auto bytes = wad.to_bytes();
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes->data()), static_cast<std::streamsize>(bytes->size()));
}
/// Write a WAD file with one map, and one with two.
std::string one_map(const TemporaryFolder& folder) {
    write_wad(folder / "one.wad", level::wad_of(level::pool_map()));
    return folder / "one.wad";
}
std::string two_maps(const TemporaryFolder& folder) {
    level::Wad wad = level::wad_of(level::pool_map());
    level::Map second = level::grid_map(5, 4, 1);
    second.name = "MAP02";
    const level::Wad more = level::wad_of(second);
    wad.lumps.insert(wad.lumps.end(), more.lumps.begin(), more.lumps.end());
    write_wad(folder / "two.wad", wad);
    return folder / "two.wad";
}

TEST(LevelCommand, PrintsTheFiguresOfATree) {
    const TemporaryFolder folder;
    const Outcome outcome = run_fase({"level", one_map(folder), "MAP01", "--json", "--check", "--point", "20,20"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto json = scene::parse_json(outcome.out);
    ASSERT_TRUE(json) << outcome.out;
    expect_keys(json->root(),
                {"map", "lines", "segs", "splits", "nodes", "subsectors", "mean_depth", "worst_depth", "ms"});
    EXPECT_EQ(number_at(json->root(), "lines"), 12);
    EXPECT_EQ(number_at(json->root(), "nodes") + 1, number_at(json->root(), "subsectors"));
    EXPECT_EQ(number_at(json->root(), "segs"), 16 + number_at(json->root(), "splits"));
    EXPECT_EQ(number_at(*json->root().find("point"), "sector"), 0);
    const Outcome words = run_fase({"level", one_map(folder), "--stats", "--point", "300,100"});
    EXPECT_EQ(words.code, 0) << words.err;
    EXPECT_NE(words.out.find("right: walls protrude"), std::string::npos) << words.out;
    EXPECT_NE(words.out.find("of sector 1, floor -32"), std::string::npos) << words.out;
}

TEST(LevelCommand, WritesTreesThatItReadsAgain) {
    const TemporaryFolder folder;
    const std::string two = two_maps(folder);
    for (const bool extended : {false, true}) {
        std::vector<std::string> arguments{"level", two, "--all", "-o", folder / "out.wad", "--gl", "--json"};
        if (extended) arguments.emplace_back("--extended");
        const Outcome made = run_fase(arguments);
        ASSERT_EQ(made.code, 0) << made.err;
        for (const char* lumps : {"nodes", "gl"}) {
            const Outcome read =
                run_fase({"level", folder / "out.wad", "--all", "--lumps", lumps, "--check", "--json"});
            ASSERT_EQ(read.code, 0) << read.err << read.out;
            const auto json = scene::parse_json(read.out);
            ASSERT_TRUE(json);
            std::vector<std::string> names;
            json->root().for_each_element([&](const scene::JsonValue& row) { names.push_back(text_at(row, "map")); });
            EXPECT_EQ(names, (std::vector<std::string>{"MAP01", "MAP02"}));
        }
    }
}

TEST(LevelCommand, KeepsTheOtherMapsOfTheFile) {
    const TemporaryFolder folder;
    const std::string two = two_maps(folder);
    ASSERT_EQ(run_fase({"level", two, "MAP02", "-o", folder / "out.wad"}).code, 0);
    const auto before = level::Wad::read(two), after = level::Wad::read(folder / "out.wad");
    ASSERT_TRUE(after);
    EXPECT_FALSE(after->find_in_map(*after->find_map("MAP01"), "NODES"));
    EXPECT_TRUE(after->find_in_map(*after->find_map("MAP02"), "NODES"));
    for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(after->lumps[i].bytes, before->lumps[i].bytes);
}

TEST(LevelCommand, DrawsPlans) {
    const TemporaryFolder folder;
    const Outcome drawn =
        run_fase({"level", one_map(folder), "--svg", folder / "plan.svg", "--png", folder / "plan.png"});
    ASSERT_EQ(drawn.code, 0) << drawn.err;
    EXPECT_EQ(read_file(folder / "plan.svg").substr(0, 4), "<svg");
    const auto image = atlas::read_png_file(folder / "plan.png");
    ASSERT_TRUE(image) << image.error().text();
    EXPECT_EQ(image->size.width, 2400);
}

TEST(LevelCommand, ShowsATableOfAllMaps) {
    const TemporaryFolder folder;
    const Outcome table =
        run_fase({"level", two_maps(folder), "--all", "--check", "--effort", "thorough", "--weight", "0"});
    ASSERT_EQ(table.code, 0) << table.err;
    EXPECT_NE(table.out.find("\nMAP02 "), std::string::npos) << table.out;
    EXPECT_NE(table.out.find("\nall "), std::string::npos) << table.out;
    EXPECT_NE(table.out.find("\n2 maps in "), std::string::npos) << table.out;
}

TEST(LevelCommand, RefusesInOneLineAndWritesNothing) {
    const TemporaryFolder folder;
    const std::string one = one_map(folder), two = two_maps(folder);
    const auto refused = [&](std::vector<std::string> arguments, int code, const std::string& words) {
        arguments.insert(arguments.begin(), "level");
        expect_error_line(run_fase(arguments), code, words);
    };
    refused({two}, 2, "found 2 maps; expected the name of one of MAP01, MAP02; or --all");
    refused({one, "E9M9"}, 2, "no map \"E9M9\"; expected one of MAP01");
    refused({folder / "none.wad"}, 3, "none.wad");
    refused({one, "--weight", "-1"}, 2, "--weight");
    refused({one, "--weight", "1e999"}, 2, "--weight: found \"1e999\"; expected a number from 0 to 1000");
    refused({one, "--effort", "some"}, 2, "expected quick, normal or thorough");
    refused({one, "--lumps", "NODES"}, 2, "expected nodes or gl");
    refused({one, "--point", "3;4"}, 2, "expected X,Y");
    refused({one, "--point", "nan,0"}, 2, "expected X,Y");
    refused({one, "--lumps", "nodes"}, 2, "no such lump; expected one");
    refused({two, "--all", "--svg", folder / "a.svg"}, 2, "expected a single MAP");
    refused({one, "-o", one}, 3, "one.wad");
    refused({one, "-o", one + "/such.wad"}, 3, "such.wad");
    refused({one, "MAP01", "--svg", folder / "x.svg", "-o", one}, 3, "one.wad");
    EXPECT_FALSE(fs::exists(folder / "x.svg"));

    level::Wad broken = level::wad_of(level::pool_map());
    broken.lumps[*broken.find_in_map(0, "LINEDEFS")].bytes.pop_back();
    write_wad(folder / "broken.wad", broken);
    refused({folder / "broken.wad", "-o", folder / "out.wad"}, 2, "LINEDEFS");
    EXPECT_FALSE(fs::exists(folder / "out.wad"));
}

TEST(LevelCommand, FailsTheCheckOfAWrongTree) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_fase({"level", one_map(folder), "-o", folder / "out.wad"}).code, 0);
    auto wad = *level::Wad::read(folder / "out.wad");
    auto& nodes = wad.lumps[*wad.find_in_map(0, "NODES")].bytes;
    nodes[nodes.size() - 28] ^= std::byte{0x80};  // moves the line of the root
    write_wad(folder / "wrong.wad", wad);
    const Outcome outcome = run_fase({"level", folder / "wrong.wad", "--lumps", "nodes", "--check"});
    EXPECT_EQ(outcome.code, 1) << outcome.out << outcome.err;
    EXPECT_NE(outcome.out.find("WRONG"), std::string::npos) << outcome.out;
}

}  // namespace
}  // namespace fase::cli
