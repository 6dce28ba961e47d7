/// Tests `fase bench queries`: its JSON keys, its CSV file, its refusals.
#include "tests/cli/fase_program.hpp"

namespace fase::cli {
namespace {

class BenchQueries : public testing::Test {
protected:
    void SetUp() override {
        if (run_fase({"bench", "queries", "--help"}).code != 0) GTEST_SKIP() << "skipped: built without benchmarks";
    }
    static Outcome bench(std::vector<std::string> more) {
        more.insert(more.begin(), {"bench", "queries", "--count", "2000", "--rays", "100", "--boxes", "100", "--frusta",
                                   "20", "--rounds", "1"});
        return run_fase(more);
    }
};

TEST_F(BenchQueries, TheContendersOfTheHelpExist) {
    const std::string help = run_fase({"bench", "queries", "--help"}).out;
    const std::string mark = "--scene static --contender ";
    const std::size_t begin = help.find(mark);
    ASSERT_NE(begin, std::string::npos) << help;
    const std::string names = help.substr(begin + mark.size(), help.find('\n', begin) - begin - mark.size());
    EXPECT_EQ(bench({"--scene", "static", "--contender", names}).code, 0) << names;
}

TEST_F(BenchQueries, TheTraceOfTheHelpOfPairsCanBeGenerated) {
    const std::string help = run_fase({"bench", "pairs", "--help"}).out, mark = "fase generate ";
    const std::size_t begin = help.find(mark);
    ASSERT_NE(begin, std::string::npos) << help;
    const std::string kind =
        help.substr(begin + mark.size(), help.find(' ', begin + mark.size()) - begin - mark.size());
    const TemporaryFolder folder;
    EXPECT_EQ(run_fase({"generate", kind, "--count", "20", "--frames", "2", "-o", folder / "t.aabt"}).code, 0) << kind;
}

TEST_F(BenchQueries, PrintsARowForEachKind) {
    const Outcome outcome = bench({"--scene", "static", "--contender", "wide_bvh,dynamic_bvh", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    const auto document = scene::parse_json(outcome.out);
    ASSERT_TRUE(document) << outcome.out;
    std::multiset<std::string> rows;
    document->root().for_each_element([&](const scene::JsonValue& row) {
        expect_keys(row, {"scene", "contender", "kind", "things", "asked", "per_second", "hits", "compared", "differ",
                          "build_ms", "bytes"});
        rows.insert(text_at(row, "contender") + " " + text_at(row, "kind"));
        EXPECT_EQ(number_at(row, "differ"), 0);
        EXPECT_GT(number_at(row, "hits"), 0);
    });
    EXPECT_EQ(rows, (std::multiset<std::string>{"dynamic_bvh boxes", "dynamic_bvh frusta", "dynamic_bvh rays",
                                                "wide_bvh boxes", "wide_bvh frusta", "wide_bvh rays"}));
}

TEST_F(BenchQueries, AppendsARowPerKindToTheCsvFile) {
    const TemporaryFolder folder;
    const std::string table = folder / "q.csv";
    ASSERT_EQ(bench({"--scene", "pile", "--contender", "wide_bvh", "--csv", table}).code, 0);
    const std::string text = read_file(table);
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 4);
    EXPECT_EQ(text.substr(0, 20), "date,commit,machine,");
}

TEST_F(BenchQueries, RefusesInvalidOptions) {
    EXPECT_EQ(bench({"--contender", "fastest"}).code, 2);
    EXPECT_EQ(bench({"--scene", "moon"}).code, 2);
    expect_error_line(bench({"--scene", "level"}), 2, "--count: found --scene level with it");
    expect_error_line(bench({"--scene", "pile", "--mesh", "x.obj"}), 2, "--mesh: found another --scene with it");
    EXPECT_EQ(run_fase({"bench", "queries", "--scene", "level", "--mesh", "/no/such/file.obj"}).code, 3);
    const Outcome outcome = bench({"--contender", "wide_bvh,fastest"});
    EXPECT_NE(outcome.err.find("\"fastest\""), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace fase::cli
