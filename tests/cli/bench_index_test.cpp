/// Tests `fase bench index`: its JSON keys, its CSV file, its refusals.
#include "tests/cli/fase_program.hpp"

namespace fase::cli {
namespace {

class BenchIndex : public testing::Test {
protected:
    void SetUp() override {
        if (run_fase({"bench", "index", "--help"}).code != 0) GTEST_SKIP() << "skipped: built without benchmarks";
    }
    static Outcome bench(std::vector<std::string> more) {
        more.insert(more.begin(), {"bench", "index", "--count", "2000", "--rounds", "1"});
        return run_fase(more);
    }
};

TEST_F(BenchIndex, PrintsARowForEachQuestion) {
    const Outcome outcome = bench({"--contender", "index,flat_grid", "--threads", "2", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    const auto document = scene::parse_json(outcome.out);
    ASSERT_TRUE(document) << outcome.out;
    std::set<std::string> rows;
    document->root().for_each_element([&](const scene::JsonValue& row) {
        expect_keys(row, {"question", "contender", "settings", "units", "threads", "rounds", "ms", "found", "compared",
                          "differ"});
        rows.insert(text_at(row, "contender") + " " + text_at(row, "question"));
        EXPECT_EQ(number_at(row, "differ"), 0);
        EXPECT_EQ(number_at(row, "threads"), text_at(row, "contender") == "index" ? 2 : 1);
    });
    EXPECT_TRUE(rows.contains("index neighbours_moved") && rows.contains("index rays")) << outcome.out;
    EXPECT_TRUE(rows.contains("flat_grid frame") && !rows.contains("flat_grid rays")) << outcome.out;
}

TEST_F(BenchIndex, PrintsATableAndAppendsToTheCsvFile) {
    const TemporaryFolder folder;
    const std::string table = folder / "i.csv";
    const Outcome outcome = bench({"--contender", "index,hash_grid", "--csv", table});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("nearest_eight"), std::string::npos) << outcome.out;
    const std::string text = read_file(table);
    EXPECT_EQ(text.substr(0, 20), "date,commit,machine,");
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1 + 10 + 6);
}

TEST_F(BenchIndex, RefusesInvalidOptions) {
    expect_error_line(bench({"--contender", "index,fastest"}), 2, "--contender: found \"fastest\"");
    EXPECT_EQ(bench({"--csv", "figures.txt"}).code, 2);
    EXPECT_EQ(run_fase({"bench", "index", "--count", "0"}).code, 2);
}

}  // namespace
}  // namespace fase::cli
