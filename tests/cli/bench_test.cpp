/// Tests `fase bench step`: its JSON keys, its CSV file, its refusals.
#include "tests/cli/fase_program.hpp"

namespace fase::cli {
namespace {

class BenchStep : public testing::Test {
protected:
    void SetUp() override {
        if (run_fase({"bench", "step", "--help"}).code != 0) GTEST_SKIP() << "skipped: built without benchmarks";
    }
    static Outcome bench(std::vector<std::string> more) {
        more.insert(more.begin(), {"bench", "step", "--count", "60", "--steps", "25", "--rounds", "2"});
        return run_fase(more);
    }
};

TEST_F(BenchStep, PrintsTheKeysThatScriptsRelyOn) {
    const Outcome outcome = bench({"--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    const auto document = scene::parse_json(outcome.out);
    ASSERT_TRUE(document) << outcome.out;
    std::multiset<std::string> scenes;
    document->root().for_each_element([&](const scene::JsonValue& row) {
        expect_keys(row, {"scene", "engine", "threads", "steps", "ms_per_step", "bodies", "contacts", "hash",
                          "top_height", "drift"});
        expect_keys(*row.find("ms_per_step"), {"mean", "median", "worst"});
        EXPECT_EQ(number_at(row, "steps"), 25);
        EXPECT_GE(number_at(row, "bodies"), 50);
        EXPECT_GT(number_at(*row.find("ms_per_step"), "median"), 0);
        if (text_at(row, "engine") == "fase") {
            scenes.insert(text_at(row, "scene"));
            EXPECT_EQ(text_at(row, "hash").size(), 16u);
        }
    });
    EXPECT_EQ(scenes, (std::multiset<std::string>{"hills", "hull_pile", "large_pyramid", "many_pyramids", "washer"}));
}

TEST_F(BenchStep, EnginesBuildTheSameWall) {
    const Outcome outcome = bench({"--scene", "large_pyramid", "--json"});
    const auto document = scene::parse_json(outcome.out);
    ASSERT_TRUE(document) << outcome.out << outcome.err;
    document->root().for_each_element([](const scene::JsonValue& row) {
        EXPECT_EQ(number_at(row, "bodies"), 55) << text_at(row, "engine");
        EXPECT_NEAR(number_at(row, "top_height"), 9.5, 0.02) << text_at(row, "engine");
        EXPECT_LT(number_at(row, "drift"), 0.02) << text_at(row, "engine");
    });
}

TEST_F(BenchStep, AppendsARowPerEngineToTheCsvFile) {
    const TemporaryFolder folder;
    const std::string table = folder / "t.csv";
    const auto lines = [&] {
        const std::string text = read_file(table);
        return std::count(text.begin(), text.end(), '\n');
    };
    const std::vector<std::string> one{"--scene", "large_pyramid", "--engine", "fase", "--csv", table};
    ASSERT_EQ(bench(one).code, 0);
    EXPECT_EQ(lines(), 2);
    EXPECT_TRUE(read_file(table).starts_with("date,commit,machine,scene,engine,"));
    ASSERT_EQ(bench(one).code, 0);
    EXPECT_EQ(lines(), 3);
    write_file(table, "a,b\n1,2\n");
    expect_error_line(bench(one), 2, "t.csv:1: found other columns");
    EXPECT_EQ(read_file(table), "a,b\n1,2\n");
    std::vector<std::string> elsewhere = one;
    elsewhere.back() = folder / "new/t.csv";
    EXPECT_EQ(bench(elsewhere).code, 0);
    EXPECT_TRUE(std::filesystem::exists(folder / "new/t.csv"));
}

TEST_F(BenchStep, RefusesUnknownScenesAndEngines) {
    expect_error_line(bench({"--scene", "moon"}), 2, "--scene: found \"moon\"; expected one of large_pyramid");
    expect_error_line(bench({"--engine", "steam"}), 2, "--engine: found \"steam\"; expected one of all, fase");
    expect_error_line(bench({"--engine", "fase,"}), 2, "--engine: found \"\"");
    expect_error_line(bench({"--threads", "0"}), 2, "--threads: found \"0\"");
}

}  // namespace
}  // namespace fase::cli
