/// Tests `fase query`: its output, its checks, its refusals.
#include "fase/broad/any_structure.hpp"
#include "fase/broad/registry.hpp"
#include "tests/cli/made_traces.hpp"

namespace fase::cli {
namespace {

const std::vector<std::string> query_keys{"structure",         "build_ms", "rays_per_second", "boxes_per_second",
                                          "frusta_per_second", "hits",     "checked"};
const std::vector<std::string> few{"--rays", "200", "--boxes", "200", "--frusta", "20"};

Outcome query(const std::string& file, std::vector<std::string> more) {
    std::vector<std::string> all{"query", file};
    all.insert(all.end(), few.begin(), few.end());
    all.insert(all.end(), more.begin(), more.end());
    return run_fase(all);
}

TEST(Query, PrintsTheKeysThatScriptsRelyOn) {
    const Outcome outcome = query("stack", {"--json", "--check"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const Rows rows(outcome.out);
    ASSERT_EQ(rows.size(), 1u);
    expect_keys(rows[0], query_keys);
    EXPECT_EQ(text_at(rows[0], "structure"), "auto");
    EXPECT_TRUE(is_true(rows[0], "checked"));
    EXPECT_GT(number_at(rows[0], "hits"), 0);
    EXPECT_GT(number_at(rows[0], "rays_per_second"), 0);
    EXPECT_EQ(number_at(rows[0], "hits"),
              number_at(rows[0], "ray_hits") + number_at(rows[0], "box_hits") + number_at(rows[0], "frustum_hits"));
}

TEST(Query, AllStructuresGiveTheSameAnswersOnScenesAndTraces) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_fase({"generate", "castle", "--count", "300", "-o", folder / "c.glb"}).code, 0);
    ASSERT_EQ(run_fase({"generate", "mixed", "--count", "800", "--frames", "1", "-o", folder / "m.aabt"}).code, 0);
    for (const std::string& file : {folder / "c.glb", folder / "m.aabt", std::string("pile")}) {
        const Outcome outcome = query(file, {"--structure", "all", "--check", "--json"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        const Rows rows(outcome.out);
        std::size_t i = 0;
        broad::for_each_structure([&]<broad::Structure S>() {
            ASSERT_LT(i, rows.size());
            EXPECT_EQ(text_at(rows[i], "structure"), S::info.name);
            EXPECT_TRUE(is_true(rows[i], "checked")) << S::info.name << " " << file;
            for (const char* key : {"hits", "ray_hits", "box_hits", "frustum_hits"})
                EXPECT_EQ(number_at(rows[i], key), number_at(rows[0], key)) << S::info.name << " " << file;
            ++i;
        });
        EXPECT_EQ(rows.size(), i);
        EXPECT_GT(number_at(rows[0], "hits"), 0);
    }
}

TEST(Query, FindsTheBoxThatEachQueryHits) {
    const TemporaryFolder folder;
    // One large box: each ray starts inside it, each box and frustum overlaps it.
    write_trace(folder / "t.aabt", {{{{-5, -5, -5}, {5, 5, 5}}}}, {0});
    const Rows rows(query(folder / "t.aabt", {"--json", "--check"}).out);
    EXPECT_EQ(number_at(rows[0], "ray_hits"), 200);
    EXPECT_EQ(number_at(rows[0], "box_hits"), 200);
    EXPECT_EQ(number_at(rows[0], "frustum_hits"), 20);
    EXPECT_TRUE(is_true(rows[0], "checked"));
}

TEST(Query, OmittedKindsHaveNoRate) {
    const Rows rows(run_fase({"query", "stack", "--rays", "50", "--boxes", "0", "--frusta", "0", "--json"}).out);
    EXPECT_GT(number_at(rows[0], "rays_per_second"), 0);
    EXPECT_EQ(kind_at(rows[0], "boxes_per_second"), scene::JsonKind::Null);
    EXPECT_EQ(kind_at(rows[0], "frusta_per_second"), scene::JsonKind::Null);
    EXPECT_EQ(kind_at(rows[0], "checked"), scene::JsonKind::Null);
    EXPECT_EQ(number_at(rows[0], "hits"), number_at(rows[0], "ray_hits"));
}

TEST(Query, InfiniteBoxesAreQueriedToo) {
    const TemporaryFolder folder;
    constexpr float infinity = Aabb::infinity;
    std::vector<Aabb> boxes{{{-infinity, -infinity, -infinity}, {infinity, 0, infinity}}};
    for (int i = 0; i < 30; ++i) boxes.push_back(cube_at(static_cast<float>(i % 6) * 2, 1, static_cast<float>(i)));
    write_trace(folder / "t.aabt", {boxes}, std::vector<std::uint8_t>(boxes.size(), 0));
    const Outcome outcome = query(folder / "t.aabt", {"--structure", "all", "--check", "--json"});
    EXPECT_EQ(outcome.code, 0) << outcome.out;
    write_trace(folder / "t.aabt", {{boxes[0]}}, {0});
    EXPECT_EQ(query(folder / "t.aabt", {"--structure", "all", "--check"}).code, 0) << "nothing else";
}

TEST(Query, AStructureAtItsTimeLimitReportsItsProgress) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_fase({"generate", "uniform", "--count", "20000", "--frames", "1", "-o", folder / "u.aabt"}).code, 0);
    const std::vector<std::string> limited{"query",   folder / "u.aabt", "--structure", "brute_force",
                                           "--limit", "0.0001",          "--frusta",    "0"};
    std::vector<std::string> with_json = limited;
    with_json.push_back("--json");
    const Rows rows(run_fase(with_json).out);
    EXPECT_EQ(kind_at(rows[0], "hits"), scene::JsonKind::Null);
    EXPECT_LT(number_at(rows[0], "rays"), 10000);
    EXPECT_NE(run_fase(limited).out.find("stopped at its time limit"), std::string::npos);
}

TEST(Query, PrintsATable) {
    const Outcome outcome = query("stack", {"--check"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_NE(outcome.out.find("200 rays, 200 boxes, 20 frusta"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("rays/s"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find(" ok\n"), std::string::npos) << outcome.out;
}

TEST(Query, RefusesInvalidFilesAndOptionsByName) {
    expect_error_line(run_fase({"query", "nothing.glb"}), 3, "nothing.glb: no such file");
    expect_error_line(run_fase({"query", "stack", "--structure", "magic"}), 2, "--structure: found \"magic\"");
    expect_error_line(run_fase({"query", "stack", "--rays", "-1"}), 2, "--rays: found \"-1\"");
    const TemporaryFolder folder;
    write_file(folder / "t.aabt", "AABT");
    expect_error_line(run_fase({"query", folder / "t.aabt"}), 2, "t.aabt: byte 4: found 4 bytes");
}

}  // namespace
}  // namespace fase::cli
