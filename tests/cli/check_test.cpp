/// Tests `fase check`: its JSON keys, its table, the choice of cases, its refusals.
#include "tests/cli/fase_program.hpp"

namespace fase::cli {
namespace {

class Check : public testing::Test {
protected:
    void SetUp() override {
        if (run_fase({"check", "--help"}).code != 0) GTEST_SKIP() << "skipped: built without benchmarks";
    }
};

TEST_F(Check, PrintsTheKeysThatScriptsRelyOn) {
    const Outcome outcome = run_fase({"check", "all", "--case", "bounce/drop_sphere_on_half_space$", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err << outcome.out;
    EXPECT_EQ(outcome.err, "");
    const auto document = scene::parse_json(outcome.out);
    ASSERT_TRUE(document) << outcome.out;
    int rows = 0;
    document->root().for_each_element([&](const scene::JsonValue& row) {
        expect_keys(row, {"suite", "case", "unit", "expected", "measured", "limit", "ok", "note"});
        EXPECT_EQ(text_at(row, "suite"), "bounce");
        EXPECT_TRUE(text_at(row, "case").starts_with("drop_sphere_on_half_space/"));
        EXPECT_TRUE(row.find("ok")->is(scene::JsonKind::True));
        ++rows;
    });
    EXPECT_EQ(rows, 5);
}

TEST_F(Check, ListsCasesWithoutRunningThem) {
    const Outcome text = run_fase({"check", "all", "--list"});
    ASSERT_EQ(text.code, 0) << text.err;
    for (const char* suite : {"stacks/", "bounce/", "rest/", "determinism/"})
        EXPECT_NE(text.out.find(suite), std::string::npos) << suite;
    const Outcome quick = run_fase({"check", "all", "--list", "--quick"});
    EXPECT_NE(text.out.find("wall_100"), std::string::npos);
    EXPECT_EQ(quick.out.find("wall_100"), std::string::npos);
    const Outcome json = run_fase({"check", "stacks", "--list", "--json"});
    const auto document = scene::parse_json(json.out);
    ASSERT_TRUE(document) << json.out;
    document->root().for_each_element([](const scene::JsonValue& row) {
        expect_keys(row, {"suite", "case", "unit", "expected", "limit", "slow"});
    });
}

TEST_F(Check, TheTableEndsWithACount) {
    const Outcome outcome = run_fase({"check", "bounce", "--case", "drop_sphere", "--quick"});
    EXPECT_EQ(outcome.code, 0) << outcome.out;
    EXPECT_NE(outcome.out.find("15 of 15 figures are within their limits\n"), std::string::npos) << outcome.out;
}

TEST_F(Check, ASignalIsNamedWithTheCasesBeforeIt) {
    for (const bool json : {false, true}) {
        std::vector<std::string> arguments{"check", "all", "--runs", "100000"};
        if (json) arguments.emplace_back("--json");
        Outcome outcome{-SIGINT, {}, {}};
        // Again with a longer wait if the signal came before the command was ready for it.
        for (int wait = 300; outcome.code == -SIGINT && wait < 10000; wait *= 2) {
            RunningFase running(arguments);
            std::this_thread::sleep_for(std::chrono::milliseconds(wait));
            running.send(SIGINT);
            outcome = running.wait();
        }
        EXPECT_EQ(outcome.code, 130);
        EXPECT_NE((json ? outcome.err : outcome.out).find("interrupted after "), std::string::npos)
            << outcome.out << outcome.err;
    }
}

TEST_F(Check, RefusesWhatItDoesNotKnow) {
    expect_error_line(run_fase({"check", "nothing"}), 2, "expected one of stacks, bounce");
    expect_error_line(run_fase({"check", "stacks", "--case", "("}), 2, "expected a regular expression");
    expect_error_line(run_fase({"check", "stacks", "--case", "nothing"}), 2, "found no case");
    EXPECT_EQ(run_fase({"check"}).code, 2);
    EXPECT_EQ(run_fase({"check", "stacks", "--runs", "0"}).code, 2);
}

}  // namespace
}  // namespace fase::cli
