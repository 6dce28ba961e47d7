/// Tests `fase pairs`: its output, its checks, its refusals.
#include "fase/broad/any_structure.hpp"
#include "fase/broad/registry.hpp"
#include "tests/cli/made_traces.hpp"

namespace fase::cli {
namespace {

const std::vector<std::string> row_keys{"structure",   "threads",    "frames",    "build_ms", "ms",      "hash",
                                        "pairs_first", "pairs_last", "pairs_sum", "bytes",    "checked", "chosen"};

/// Four cubes in a row; the last one approaches. 0 and 1 are static and overlap; 2 sleeps on 1 until it is woken.
class Pairs : public ::testing::Test {
protected:
    void SetUp() override {
        const auto frame = [](float two, float three) {
            return std::vector<Aabb>{cube_at(0), cube_at(0.5f), cube_at(two), cube_at(three)};
        };
        write_trace(trace, {frame(1.5f, 9), frame(1.5f, 2.5f), frame(1.25f, 1)},
                    {record::trace_static, record::trace_static, record::trace_asleep, 0});
    }
    TemporaryFolder folder;
    std::string trace = folder / "t.aabt";
};

TEST_F(Pairs, PrintsTheKeysThatScriptsRelyOn) {
    const Outcome outcome = run_fase({"pairs", trace, "--json", "--check"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    const Rows rows(outcome.out);
    ASSERT_EQ(rows.size(), 1u);
    expect_keys(rows[0], row_keys);
    EXPECT_EQ(text_at(rows[0], "structure"), "auto");
    EXPECT_EQ(text_at(rows[0], "chosen"), "brute_force") << "of four boxes";
    EXPECT_NE(text_at(rows[0], "reason").find("few boxes"), std::string::npos);
    EXPECT_EQ(number_at(rows[0], "threads"), 1);
    EXPECT_EQ(number_at(rows[0], "frames"), 3);
    // {1, 2}; then also {2, 3}, which touch; then also {0, 3}, {1, 3}.
    EXPECT_EQ(number_at(rows[0], "pairs_first"), 1);
    EXPECT_EQ(number_at(rows[0], "pairs_last"), 4);
    EXPECT_EQ(number_at(rows[0], "pairs_sum"), 7);
    EXPECT_TRUE(is_true(rows[0], "checked"));
    EXPECT_EQ(text_at(rows[0], "hash").size(), 16u);
    expect_keys(*rows[0].find("ms"), {"mean", "median", "worst"});
    EXPECT_GT(number_at(rows[0], "bytes"), 0);
}

TEST_F(Pairs, ReportsBegunAndEndedPairs) {
    for (const char* structure : {"auto", "all"}) {
        const Outcome outcome = run_fase({"pairs", trace, "--changes", "--check", "--json", "--structure", structure});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        const Rows rows(outcome.out);
        for (std::size_t i = 0; i < rows.size(); ++i) {
            EXPECT_TRUE(is_true(rows[i], "checked"));
            EXPECT_EQ(number_at(rows[i], "begun_sum"), 3);
            EXPECT_EQ(number_at(rows[i], "ended_sum"), 0);
            EXPECT_EQ(number_at(rows[i], "pairs_sum"), 7);
        }
    }
    const Outcome table = run_fase({"pairs", trace, "--changes"});
    EXPECT_NE(table.out.find("3 pairs began, 0 ended"), std::string::npos) << table.out;
}

TEST_F(Pairs, AllStructuresAgreeForAnyNumberOfThreads) {
    std::string hash;
    for (const char* threads : {"1", "3"}) {
        const Outcome outcome =
            run_fase({"pairs", trace, "--structure", "all", "--check", "--json", "--threads", threads});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        const Rows rows(outcome.out);
        std::size_t i = 0;
        broad::for_each_structure([&]<broad::Structure S>() {
            ASSERT_LT(i, rows.size());
            EXPECT_EQ(text_at(rows[i], "structure"), S::info.name);
            EXPECT_EQ(text_at(rows[i], "chosen"), S::info.name);
            EXPECT_EQ(number_at(rows[i], "threads"), std::stoi(threads));
            EXPECT_EQ(kind_at(rows[i], "skipped"), scene::JsonKind::Null);
            EXPECT_TRUE(is_true(rows[i], "checked")) << S::info.name;
            if (hash.empty()) hash = text_at(rows[i], "hash");
            EXPECT_EQ(text_at(rows[i], "hash"), hash) << S::info.name;
            ++i;
        });
        EXPECT_EQ(rows.size(), i);
    }
}

TEST_F(Pairs, TheHashDependsOnPairsAndFrames) {
    const auto hash = [&](const std::vector<std::string>& more) {
        std::vector<std::string> all{"pairs", trace, "--json"};
        all.insert(all.end(), more.begin(), more.end());
        const Rows rows(run_fase(all).out);
        return text_at(rows[0], "hash");
    };
    EXPECT_EQ(hash({}), hash({"--frames", "100"}));
    EXPECT_NE(hash({}), hash({"--frames", "2"}));
    const std::string before = hash({});
    write_trace(trace, {{cube_at(0), cube_at(0.5f), cube_at(9)}}, {0, 0, 0});
    const std::string one = hash({});
    EXPECT_NE(one, before);
    write_trace(trace, {{cube_at(0), cube_at(9), cube_at(0.5f)}}, {0, 0, 0});
    EXPECT_NE(hash({}), one) << "one pair again, of other boxes";
}

TEST_F(Pairs, WithoutCheckTheResultIsNull) {
    const Rows rows(run_fase({"pairs", trace, "--json", "--frames", "1"}).out);
    EXPECT_EQ(kind_at(rows[0], "checked"), scene::JsonKind::Null);
    EXPECT_EQ(number_at(rows[0], "frames"), 1);
}

TEST_F(Pairs, PrintsAnAlignedTable) {
    const Outcome outcome = run_fase({"pairs", trace, "--structure", "all", "--check"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(outcome.out.find("4 boxes, 2 static, 1 asleep; 3 of 3 frames; 1 thread"), std::string::npos)
        << outcome.out;
    EXPECT_NE(outcome.out.find("\nbrute_force "), std::string::npos) << outcome.out;
    EXPECT_EQ(outcome.out.find("WRONG"), std::string::npos);
    std::size_t length = 0;
    for (std::size_t begin = outcome.out.find('\n') + 1; begin < outcome.out.size();) {
        const std::size_t end = outcome.out.find('\n', begin);
        if (length == 0) length = end - begin;
        EXPECT_EQ(end - begin, length) << "the columns are aligned";
        begin = end + 1;
    }
}

TEST_F(Pairs, WithAllStructuresSlowOnesAreSkippedAndMarked) {
    ASSERT_EQ(run_fase({"generate", "uniform", "--count", "20000", "--frames", "50", "-o", trace}).code, 0);
    const Outcome outcome = run_fase({"pairs", trace, "--structure", "all", "--limit", "0.0005", "--json"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const Rows rows(outcome.out);
    expect_keys(rows[0], row_keys);
    EXPECT_EQ(text_at(rows[0], "structure"), "brute_force");
    EXPECT_NE(text_at(rows[0], "skipped").find("would take about"), std::string::npos);
    for (const char* key : {"frames", "build_ms", "ms", "pairs_sum", "hash", "bytes", "checked"})
        EXPECT_EQ(kind_at(rows[0], key), scene::JsonKind::Null) << key;
    EXPECT_NE(text_at(rows[rows.size() - 1], "skipped").find("took more than"), std::string::npos);
    const Outcome table = run_fase({"pairs", trace, "--structure", "all", "--limit", "0.0005"});
    EXPECT_NE(table.out.find("skipped: would take"), std::string::npos) << table.out;
    const Outcome named = run_fase({"pairs", trace, "--structure", "brute_force", "--frames", "1", "--json"});
    EXPECT_EQ(kind_at(Rows(named.out)[0], "skipped"), scene::JsonKind::Null)
        << "a structure that is named is never skipped";
}

TEST_F(Pairs, RefusesFilesThatAreNotTraces) {
    expect_error_line(run_fase({"pairs", folder / "none.aabt"}), 3, "none.aabt: cannot open");
    const std::string good = read_file(trace);
    std::string bytes = good;
    for (std::size_t i = 0; i < 4; ++i) bytes[20 + (4 + 2) * 24 + i] = '\xff';  // frame 1, body 2: lower x
    write_file(trace, bytes);
    expect_error_line(run_fase({"pairs", trace, "--json"}), 2, ": byte 164: frame 1, body 2: found NaN as lower x");
    write_file(trace, good.substr(0, 100));
    expect_error_line(run_fase({"pairs", trace}), 2, ": byte 100: frame 0, body 3: found the end of the file");
    write_file(trace, "{}");
    expect_error_line(run_fase({"pairs", trace}), 2, ": found a JSON file; `fase pairs` reads traces (.aabt)");
    expect_error_line(run_fase({"info", folder / "t.aabt"}), 2, "t.aabt");
}

TEST_F(Pairs, RefusesInvalidOptionsByName) {
    expect_error_line(run_fase({"pairs", trace, "--structure", "magic"}), 2,
                      "--structure: found \"magic\"; expected auto, all or one of brute_force");
    expect_error_line(run_fase({"pairs", trace, "--frames", "0"}), 2, "--frames: found \"0\"");
    expect_error_line(run_fase({"pairs"}), 2, "TRACE");
}

TEST_F(Pairs, RecommendsAStructureForAMix) {
    ASSERT_EQ(run_fase({"generate", "mixed", "--count", "500", "--frames", "6", "-o", trace}).code, 0);
    const std::vector<std::string> mix{"pairs", trace, "--mix", "1 pairs, 20 rays, 5 boxes"};
    std::vector<std::string> with_json = mix;
    with_json.push_back("--json");
    const Outcome outcome = run_fase(with_json);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const auto document = scene::parse_json(outcome.out);
    ASSERT_TRUE(document) << outcome.out;
    const scene::JsonValue root = document->root();
    expect_keys(root, {"mix", "frames", "best", "agree", "all"});
    EXPECT_EQ(number_at(*root.find("mix"), "rays"), 20);
    EXPECT_TRUE(is_true(root, "agree"));
    double before = 0;
    std::size_t rows = 0;
    root.find("all")->for_each_element([&](const scene::JsonValue& row) {
        if (rows == 0) {
            EXPECT_EQ(text_at(row, "structure"), text_at(root, "best"));
        }
        ++rows;
        const double sum = number_at(row, "update_ms") + number_at(row, "pairs_ms") + number_at(row, "rays_ms") +
                           number_at(row, "boxes_ms");
        EXPECT_NEAR(number_at(row, "total_ms"), sum, 1e-4 * sum);
        EXPECT_GE(number_at(row, "total_ms"), before);
        before = number_at(row, "total_ms");
    });
    std::size_t structures = 0;
    broad::for_each_structure([&]<broad::Structure S>() { ++structures; });
    EXPECT_EQ(rows, structures);
    const Outcome table = run_fase(mix);
    EXPECT_NE(table.out.find("\nrecommended for 1 pairs, 20 rays, 5 boxes per frame: "), std::string::npos)
        << table.out;
}

TEST_F(Pairs, AMixOfOneKindCostsNothingElse) {
    const Outcome outcome = run_fase({"pairs", trace, "--mix", "3 rays", "--json"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const auto document = scene::parse_json(outcome.out);
    ASSERT_TRUE(document) << outcome.out;
    document->root().find("all")->for_each_element([](const scene::JsonValue& row) {
        EXPECT_EQ(number_at(row, "pairs_ms"), 0);
        EXPECT_EQ(number_at(row, "boxes_ms"), 0);
    });
}

TEST_F(Pairs, RefusesInvalidMixes) {
    for (const char* mix : {"", " ", "1", "pairs", "1 cats", "1 pairs 2 rays", "1 pairs, 2 pairs", "-1 rays", "0 rays",
                            "1.5 rays", "1 pairs,", "1001 pairs", "1000001 rays"})
        expect_error_line(run_fase({"pairs", trace, "--mix", mix}), 2, "--mix: found \"");
    for (const std::vector<std::string>& options :
         {std::vector<std::string>{"--check"}, {"--changes"}, {"--structure", "all"}}) {
        std::vector<std::string> all{"pairs", trace, "--mix", "1 pairs"};
        all.insert(all.end(), options.begin(), options.end());
        expect_error_line(run_fase(all), 2, "expected one of the two");
    }
}

TEST_F(Pairs, TooManyPairsAreRefusedBeforeTheSearch) {
    write_trace(trace, {std::vector<Aabb>(60000, cube_at(0))}, std::vector<std::uint8_t>(60000, 0));
    expect_error_line(run_fase({"pairs", trace}), 4, "frame 0: found about 1.8e+09 pairs; expected at most 268435456");
}

TEST_F(Pairs, ASignalEndsItWithTheFinishedRows) {
    ASSERT_EQ(run_fase({"generate", "uniform", "--count", "6000", "--frames", "400", "-o", trace}).code, 0);
    RunningFase running({"pairs", trace, "--structure", "brute_force", "--json"});
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    running.send(SIGINT);
    const Outcome outcome = running.wait();
    EXPECT_EQ(outcome.code, 130);
    EXPECT_EQ(Rows(outcome.out).size(), 0u);
}

TEST_F(Pairs, PairsOfAPublishedTraceAreCorrect) {
    const std::string name = std::string(FASE_SHARED_DATA) + "/traces/cloth-funnel.aabt";
    if (!std::filesystem::exists(name)) GTEST_SKIP() << "skipped: " << name << " is missing";
    const Outcome outcome = run_fase({"pairs", name, "--check", "--json"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(number_at(Rows(outcome.out)[0], "pairs_first"), 805888);
}

}  // namespace
}  // namespace fase::cli
