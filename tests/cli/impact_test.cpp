/// Tests `fase impact`: its files, its output, and the known answers of others.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "tests/cli/fase_program.hpp"

namespace fase::cli {
namespace {

/// A vertex that falls onto a triangle, as rationals.
std::string falling_vertex(const std::string& last_height, const std::string& meets) {
    const auto row = [&](const std::string& x, const std::string& y, const std::string& z) {
        return x + ",1," + y + "," + z + ",1," + meets + "\n";
    };
    const std::string face = row("-1", "0,1", "-1") + row("3", "0,1", "-1") + row("-1", "0,1", "3");
    return row("0", "1,1", "0") + face + row("0", last_height, "0") + face;
}

TEST(ImpactCommand, answers_all_queries_of_a_folder) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder / "set/vertex-face");
    std::filesystem::create_directories(folder / "set/notes");
    write_file(folder / "set/notes/other.csv", "text");
    write_file(folder / "set/vertex-face/a.csv", falling_vertex("-1,2", "1") + falling_vertex("1,1024", "0"));
    const Outcome outcome = run_fase({"impact", folder / "set", "--json"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const auto document = scene::parse_json(outcome.out);
    ASSERT_TRUE(document) << outcome.out;
    const scene::JsonValue root = document->root();
    expect_keys(root, {"queries", "true_positives", "false_positives", "false_negatives", "us_per_query"});
    EXPECT_EQ(root.find("queries")->number(), 2);
    EXPECT_EQ(root.find("true_positives")->number(), 1);
    EXPECT_EQ(root.find("false_positives")->number(), 0);
    EXPECT_EQ(root.find("false_negatives")->number(), 0);
    const Outcome lines = run_fase({"impact", folder / "set"});
    EXPECT_EQ(lines.code, 0);
    EXPECT_NE(lines.out.find("vertex-face/a.csv"), std::string::npos) << lines.out;
}

TEST(ImpactCommand, a_missed_meeting_fails) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder / "vertex-face");
    write_file(folder / "vertex-face/a.csv", falling_vertex("1,2", "1"));
    EXPECT_EQ(run_fase({"impact", folder / "."}).code, 1);
}

TEST(ImpactCommand, bad_files_and_folders_are_refused) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder / "edge-edge");
    const std::string file = folder / "edge-edge/a.csv";
    expect_error_line(run_fase({"impact", folder / "none"}), 3, "none");
    expect_error_line(run_fase({"impact", folder / "."}), 2, "found no query");
    write_file(file, falling_vertex("-1,2", "1"));
    expect_error_line(run_fase({"impact", file}), 2, "expected a folder");
    for (const char* row : {"1,2,3\n", "1,0,0,1,0,1,0\n", "1.5,1,0,1,0,1,0\n", "1,1,0,1,0,1,2\n", "x\n", "\n",
                            "1,1,0,1,0,1,0,0\n", "1,1,nan,1,0,1,0\n", "1,-1,0,1,0,1,0\n"}) {
        write_file(file, row);
        expect_error_line(run_fase({"impact", folder / "."}), 2, "a.csv:1: found no row");
    }
    write_file(file, "1,1,0,1,0,1,0\n1,1,0,1,0,1,1\n");
    expect_error_line(run_fase({"impact", folder / "."}), 2, "a.csv:2: found another answer");
    write_file(file, "1,1,0,1,0,1,0\n1,1,0,1,0,1,0\n");
    expect_error_line(run_fase({"impact", folder / "."}), 2, "found the end after 2 rows");
}

TEST(ImpactCommand, misses_no_meeting_of_the_published_queries) {
    const auto data = std::filesystem::path(FASE_SHARED_DATA) / "ccd-queries";
    if (!std::filesystem::exists(data)) GTEST_SKIP() << "skipped: no queries in " << FASE_SHARED_DATA;
    const Outcome outcome = run_fase({"impact", data.string(), "--json"});
    EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
    const auto document = scene::parse_json(outcome.out);
    ASSERT_TRUE(document) << outcome.out;
    EXPECT_EQ(document->root().find("queries")->number(), 4779);
    EXPECT_EQ(document->root().find("false_negatives")->number(), 0);
    EXPECT_LE(document->root().find("false_positives")->number(), 172);  // decided by less than rounding
}

}  // namespace
}  // namespace fase::cli
