/// Tests generated traces and traces of runs through the command.
#include "fase/record/generate_trace.hpp"
#include "fase/record/trace.hpp"
#include "tests/cli/made_traces.hpp"

namespace fase::cli {
namespace {

TEST(GenerateTrace, GeneratesEveryKindAndItsPairsAreCorrect) {
    const TemporaryFolder folder;
    for (const record::TraceKind& kind : record::trace_kinds()) {
        const std::string name = folder / "t.aabt", word(kind.name);
        const Outcome made = run_fase({"generate", word, "--count", "2000", "--frames", "8", "-o", name});
        ASSERT_EQ(made.code, 0) << made.err;
        EXPECT_NE(made.out.find(": " + word + ", 2000 boxes"), std::string::npos) << made.out;
        EXPECT_NE(made.out.find(", 8 frames"), std::string::npos) << made.out;
        const Outcome pairs = run_fase({"pairs", name, "--check", "--json"});
        EXPECT_EQ(pairs.code, 0) << word << pairs.err;
        EXPECT_GT(number_at(Rows(pairs.out)[0], "pairs_sum"), 0) << word;
    }
}

TEST(GenerateTrace, HelpNamesEveryKind) {
    const std::string help = run_fase({"generate", "--help"}).out;
    for (const record::TraceKind& kind : record::trace_kinds())
        EXPECT_NE(help.find("\n  " + std::string(kind.name) + " "), std::string::npos) << kind.name;
}

TEST(GenerateTrace, TheExtensionSelectsSceneOrTrace) {
    const TemporaryFolder folder;
    EXPECT_EQ(run_fase({"generate", "pile", "--count", "20", "-o", folder / "p.glb"}).code, 0);
    EXPECT_EQ(run_fase({"generate", "pile", "--count", "20", "-o", folder / "p.aabt"}).code, 0);
    EXPECT_NE(run_fase({"info", folder / "p.glb"}).out.find("glTF scene"), std::string::npos);
    EXPECT_NE(run_fase({"info", folder / "p.aabt"}).out.find("box trace"), std::string::npos);
    expect_error_line(
        run_fase({"generate", "castle", "-o", folder / "c.aabt"}), 2,
        "c.aabt: found a trace's extension; castle is a scene, which needs .glb or .gltf; 'fase run castle");
    expect_error_line(run_fase({"generate", "rain", "-o", folder / "r.glb"}), 2,
                      "r.glb: found a scene's extension; rain is a trace, which needs .aabt");
    expect_error_line(run_fase({"generate", "pile", "-o", folder / "p"}), 2,
                      "p: found no extension; expected .glb or .gltf for a scene, .aabt for a trace");
    expect_error_line(run_fase({"generate", "pile", "--frames", "5", "-o", folder / "q.glb"}), 2, "--frames");
    EXPECT_FALSE(std::filesystem::exists(folder / "c.aabt"));
    EXPECT_FALSE(std::filesystem::exists(folder / "r.glb"));
}

TEST(GenerateTrace, AFullDiskIsReportedWithTheWrittenAmount) {
    const TemporaryFolder folder;
    const Outcome outcome =
        RunningFase::by_shell("ulimit -f 64; exec \"$0\" \"$@\"", {"generate", "rain", "-o", folder / "r.aabt"}).wait();
    expect_error_line(outcome, 3, "r.aabt: cannot write: ");
    EXPECT_NE(outcome.err.find("wrote 0 frames"), std::string::npos) << outcome.err;
    expect_error_line(RunningFase::by_shell("ulimit -f 64; exec \"$0\" \"$@\"",
                                            {"generate", "pile", "--count", "2000", "-o", folder / "p.glb"})
                          .wait(),
                      3, "p.glb: cannot write: File too large");
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(GenerateTrace, ASignalRemovesTheUnfinishedFile) {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
        const TemporaryFolder folder;
        RunningFase running({"generate", "rain", "--count", "10000", "--frames", "100000", "-o", folder / "r.aabt"});
        ASSERT_TRUE(wait_until([&] { return std::filesystem::exists(folder / "r.aabt.part"); }));
        running.send(signal);
        const Outcome outcome = running.wait();
        EXPECT_EQ(outcome.code, 128 + signal);
        EXPECT_EQ(outcome.err, "fase: interrupted: " + (folder / "r.aabt") + " is not written\n");
        EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
    }
}

/// A command without results to keep ends by the signal, and removes the file that it writes.
TEST(Signals, LeaveNoTemporaryFile) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_fase({"generate", "rain", "--count", "200000", "--frames", "1", "-o", folder / "rain.aabt"}).code, 0);
    const auto files = [&] { return std::distance(std::filesystem::directory_iterator(folder.path()), {}); };
    for (int i = 0; i < 10; ++i) {
        RunningFase running({"draw", folder / "rain.aabt", "-o", folder / "rain.svg"});
        ASSERT_TRUE(wait_until([&] { return files() > 1; }));  // the picture is being written, or is written
        running.send(i % 2 == 0 ? SIGTERM : SIGHUP);
        const int code = running.wait().code;
        EXPECT_TRUE(code == 0 || code == -SIGTERM || code == -SIGHUP) << code;
        for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
            EXPECT_EQ(entry.path().string().find(".part"), std::string::npos) << entry.path();
        std::filesystem::remove(folder / "rain.svg");
    }
}

TEST(Generate, ASignalLeavesNoPartOfAScene) {
    const TemporaryFolder folder;
    RunningFase running({"generate", "pile", "--count", "1000000", "-o", folder / "p.glb"});
    ASSERT_TRUE(wait_until([&] { return !std::filesystem::is_empty(folder.path()); }));
    running.send(SIGINT);
    EXPECT_EQ(running.wait().code, 130);
    // The signal may come too late to stop it.
    for (const auto& entry : std::filesystem::directory_iterator(folder.path()))
        EXPECT_EQ(entry.path().filename(), "p.glb");
}

TEST(InfoOfTraces, PrintsTheContentsAndValidatesTheWholeFile) {
    const TemporaryFolder folder;
    const std::string name = folder / "t.aabt";
    write_trace(name, {{cube_at(0), cube_at(2), cube_at(4)}, {cube_at(0), cube_at(2.5f), cube_at(4)}},
                {record::trace_static, record::trace_asleep, 0});
    const auto document = scene::parse_json(run_fase({"info", name, "--json"}).out);
    ASSERT_TRUE(document);
    const auto info = document->root();
    const std::vector<std::pair<std::string, double>> expected{
        {"boxes", 3}, {"frames", 2},        {"static", 1},   {"asleep", 1},    {"woken", 1},
        {"moved", 1}, {"moves_a_frame", 1}, {"infinite", 0}, {"mean_size", 1}, {"bytes", 16 + 4 + 6 * 24}};
    for (const auto& [key, value] : expected) EXPECT_EQ(number_at(info, key), value) << key;
    EXPECT_EQ(text_at(info, "room_largest"), "5 1 1");
    std::string bytes = read_file(name);
    bytes[bytes.size() - 13] = '\x7f';  // makes a lower bound of the last box NaN
    bytes[bytes.size() - 14] = '\xff';
    write_file(name, bytes);
    expect_error_line(run_fase({"info", name}), 2, "frame 1, body 2: found NaN as lower z");
}

TEST(InfoOfTraces, NamesAnUnfinishedTrace) {
    const TemporaryFolder folder;
    const std::string name = folder / "t.aabt";
    write_trace(name, {{cube_at(0)}}, {0});
    std::filesystem::rename(name, name + ".part");
    expect_error_line(run_fase({"info", name}), 3, "found an unfinished trace " + name + ".part; 'fase info ");
    EXPECT_EQ(run_fase({"info", name + ".part"}).code, 0);
}

TEST(RunTrace, ContainsTheInitialStateAndEveryStep) {
    const TemporaryFolder folder;
    const std::string name = folder / "t.aabt";
    const Outcome run = run_fase({"run", "stack", "--steps", "20", "--trace", name, "--json"});
    ASSERT_EQ(run.code, 0) << run.err;
    auto trace = record::TraceReader::open(name);
    ASSERT_TRUE(trace) << trace.error().text();
    EXPECT_EQ(trace->frames(), 21u);
    std::size_t static_boxes = 0;
    for (const auto flag : trace->flags()) static_boxes += (flag & record::trace_static) != 0 ? 1 : 0;
    EXPECT_GE(static_boxes, 1u) << "the ground";
    EXPECT_LT(static_boxes, trace->boxes());
    EXPECT_EQ(run_fase({"pairs", name, "--structure", "all", "--check"}).code, 0);
}

TEST(RunTrace, DoesNotChangeTheHashAndWorksWithARecording) {
    const TemporaryFolder folder;
    const auto hash = [&](const std::vector<std::string>& more) {
        std::vector<std::string> all{"run", "stack", "--steps", "20", "--json"};
        all.insert(all.end(), more.begin(), more.end());
        const auto document = scene::parse_json(run_fase(all).out);
        return document ? text_at(document->root(), "hash") : "";
    };
    EXPECT_EQ(hash({}), hash({"--trace", folder / "t.aabt", "--record", folder / "r.faserec"}));
    EXPECT_TRUE(std::filesystem::exists(folder / "r.faserec"));
    EXPECT_TRUE(std::filesystem::exists(folder / "t.aabt"));
    expect_error_line(run_fase({"run", "stack", "--trace", "/dev/null", "--record", "/dev/null"}), 3, "expected two");
}

TEST(RunTrace, AnUnwritablePathIsRefusedBeforeTheRun) {
    const TemporaryFolder folder;
    const std::vector<std::string> run{"run", "stack", "--steps", "100000", "--trace"};
    const auto to = [&](const std::string& name) {
        std::vector<std::string> all = run;
        all.push_back(name);
        return run_fase(all);
    };
    expect_error_line(to(folder.path()), 3, "found a folder");
    expect_error_line(to("/dev/full"), 3, "found a device");
}

TEST(RunTrace, AFullDiskKeepsTheOldTraceAndTheFramesThatFit) {
    const TemporaryFolder folder;
    const std::string name = folder / "t.aabt";
    ASSERT_EQ(run_fase({"run", "stack", "--steps", "3", "--trace", name}).code, 0);
    const std::string old = read_file(name);
    const Outcome outcome = RunningFase::by_shell("ulimit -f 64; exec \"$0\" \"$@\"",
                                                  {"run", "stack", "--steps", "100000", "--trace", name, "--json"})
                                .wait();
    expect_error_line(outcome, 3, "t.aabt.part: cannot write");
    EXPECT_EQ(read_file(name), old);
    const auto trace = record::TraceReader::open(name + ".part");
    ASSERT_TRUE(trace) << trace.error().text();
    EXPECT_NE(outcome.err.find("wrote " + std::to_string(trace->frames()) + " frames"), std::string::npos)
        << outcome.err;
}

TEST(RunTrace, ASignalEndsTheRunWithACompleteTrace) {
    const TemporaryFolder folder;
    const std::string name = folder / "t.aabt";
    RunningFase running({"run", "stack", "--steps", "10000000", "--trace", name});
    const auto grows = [&] {
        std::error_code none;
        return std::filesystem::file_size(name + ".part", none) > 4000 && !none;
    };
    ASSERT_TRUE(wait_until(grows));
    running.send(SIGTERM);
    EXPECT_EQ(running.wait().code, 143);
    EXPECT_TRUE(record::TraceReader::open(name));
}

}  // namespace
}  // namespace fase::cli
