/// Tests `fase run`: its figures, its refusals, and that the hash does not depend on settings.
#include "tests/cli/fase_program.hpp"

namespace fase::cli {
namespace {

scene::JsonDocument json_of(const Outcome& outcome) {
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    auto document = scene::parse_json(outcome.out);
    EXPECT_TRUE(document) << outcome.out;
    return document ? *std::move(document) : scene::JsonDocument{};
}

std::string hash_of(std::vector<std::string> arguments) {
    arguments.push_back("--json");
    const Outcome outcome = run_fase(arguments);
    const scene::JsonDocument document = json_of(outcome);
    return outcome.code == 0 ? text_at(document.root(), "hash") : "";
}

TEST(Run, PrintsTheKeysThatScriptsRelyOn) {
    const scene::JsonDocument document = json_of(run_fase({"run", "stack", "--count", "5", "--steps", "20", "--json"}));
    const scene::JsonValue run = document.root();
    expect_keys(run, {"scene", "bodies", "shapes", "joints", "steps", "ms_per_step", "stages", "contacts", "awake",
                      "peak_bytes", "hash", "warnings"});
    EXPECT_EQ(text_at(run, "scene"), "stack");
    EXPECT_EQ(number_at(run, "bodies"), 6);
    EXPECT_EQ(number_at(run, "joints"), 0);
    EXPECT_EQ(number_at(run, "steps"), 20);
    EXPECT_EQ(number_at(run, "contacts"), 5);
    EXPECT_EQ(number_at(run, "awake"), 5);
    EXPECT_GT(number_at(run, "peak_bytes"), 1e6);
    EXPECT_EQ(text_at(run, "hash").size(), 16u);
    EXPECT_EQ(run.find("warnings")->size(), 0u);
    EXPECT_EQ(keys_of(*run.find("ms_per_step")), (std::set<std::string>{"mean", "median", "worst"}));
    EXPECT_EQ(keys_of(*run.find("stages")), (std::set<std::string>{"refresh", "pairs", "collide", "islands", "solve",
                                                                   "finish", "events", "sleep", "queries"}));
    const scene::JsonValue ms = *run.find("ms_per_step");
    EXPECT_GE(number_at(ms, "worst"), number_at(ms, "mean"));
}

TEST(Run, PrintsATable) {
    const Outcome outcome = run_fase({"run", "stack", "--count", "5", "--steps", "30"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    for (const char* line : {"scene      stack\n", "bodies     6, 5 of them dynamic", "steps      30, 0.5 s simulated",
                             "ms/step    ", "stages     refresh ", "contacts   at most 5", "memory     "}) {
        EXPECT_NE(outcome.out.find(line), std::string::npos) << line << " is not in\n" << outcome.out;
    }
    EXPECT_EQ(outcome.out.find("hash "), std::string::npos) << outcome.out;
}

TEST(Run, PrintsTheHashOnRequest) {
    const std::vector<std::string> run{"run", "stack", "--count", "2", "--steps", "3"};
    std::vector<std::string> with_hash = run;
    with_hash.push_back("--hash");
    const Outcome outcome = run_fase(with_hash);
    EXPECT_NE(outcome.out.find("hash       " + hash_of(run) + "\n"), std::string::npos) << outcome.out;
    expect_error_line(run_fase({"run", "stack", "--hash", "--json"}), 2, "expected one of the two");
    EXPECT_EQ(run_fase({"bench", "step", "--scene", "large_pyramid", "--engine", "fase", "--count", "3", "--steps", "2",
                        "--rounds", "1"})
                  .out.find("hash"),
              std::string::npos);
}

TEST(Run, ConvertsSecondsToSteps) {
    const auto steps = [](std::vector<std::string> more) {
        std::vector<std::string> arguments{"run", "stack", "--count", "1", "--json"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return number_at(json_of(run_fase(arguments)).root(), "steps");
    };
    EXPECT_EQ(steps({"--seconds", "0.5"}), 30);
    EXPECT_EQ(steps({"--seconds", "0.5", "--dt", "0.005"}), 100);
    EXPECT_EQ(steps({"--seconds", "1e-6"}), 1);
    EXPECT_EQ(steps({}), 600);
    EXPECT_EQ(steps({"--steps", "0"}), 0);
}

TEST(Run, TheHashDoesNotDependOnThreadsAndStructure) {
    const std::vector<std::string> run{"run", "pile", "--count", "150", "--steps", "120"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), run.begin(), run.end());
        return hash_of(more);
    };
    const std::string hash = with({"--threads", "1"});
    EXPECT_EQ(with({"--threads", "1"}), hash);
    for (const char* threads : {"0", "2", "4"}) EXPECT_EQ(with({"--threads", threads}), hash) << threads;
    for (const char* structure : {"auto", "brute_force", "dynamic_bvh"}) {
        EXPECT_EQ(with({"--structure", structure}), hash) << structure;
        EXPECT_EQ(with({"--structure", structure, "--threads", "4"}), hash) << structure;
    }
    EXPECT_NE(with({"--seed", "2"}), hash);
    EXPECT_NE(with({"--sub-steps", "5"}), hash);
}

TEST(Run, AFileRunsLikeTheKindThatGeneratedIt) {
    const TemporaryFolder folder;
    const std::string kind = hash_of({"run", "pile", "--count", "60", "--steps", "60"});
    for (const char* name : {"pile.glb", "pile.gltf"}) {
        ASSERT_EQ(run_fase({"generate", "pile", "--count", "60", "-o", folder / name}).code, 0);
        EXPECT_EQ(hash_of({"run", folder / name, "--steps", "60"}), kind) << name;
    }
}

TEST(Run, RecordingDoesNotChangeTheHash) {
    const TemporaryFolder folder;
    const std::vector<std::string> run{"run", "castle", "--count", "100", "--steps", "20"};
    std::vector<std::string> recorded = run;
    recorded.insert(recorded.end(), {"--record", folder / "r.faserec", "--contacts"});
    EXPECT_EQ(hash_of(recorded), hash_of(run));
}

TEST(Run, RefusesUnknownScenesAndStructuresByName) {
    expect_error_line(run_fase({"run", "no_such.glb"}), 3,
                      "no_such.glb: no such file; expected a .gltf, .glb or .wad file, or one of castle");
    expect_error_line(run_fase({"run", "stack", "--structure", "oak"}), 2,
                      "--structure: found \"oak\"; expected auto or one of brute_force");
    expect_error_line(run_fase({"run", "stack", "--seconds", "1e9"}), 2, "--seconds: found ");
    expect_error_line(run_fase({"run", "/"}), 2, "/");
}

TEST(Run, ABrokenSceneGivesOneErrorLineAndNoFile) {
    const TemporaryFolder folder;
    const std::string scene = folder / "scene.glb", recording = folder / "r.faserec";
    ASSERT_EQ(run_fase({"generate", "stack", "--count", "2", "-o", scene}).code, 0);
    const std::string whole = read_file(scene);
    for (const std::size_t size : {std::size_t{0}, std::size_t{3}, whole.size() / 2, whole.size() - 1}) {
        write_file(scene, whole.substr(0, size));
        expect_error_line(run_fase({"run", scene, "--record", recording}), 2, "scene.glb");
    }
    write_file(scene,
               "{\"asset\": {\"version\": \"2.0\"}, \"nodes\": [{\"children\": [0]}], \"scenes\": [{\"nodes\": [0]}]}");
    expect_error_line(run_fase({"run", scene, "--record", recording}), 2, "nodes");
    EXPECT_FALSE(std::filesystem::exists(recording));
    EXPECT_FALSE(std::filesystem::exists(recording + ".part"));
}

TEST(Run, PrintsNoProgressToAPipeWithJson) {
    const Outcome outcome = run_fase({"run", "pile", "--count", "100", "--steps", "1", "--json"});
    EXPECT_EQ(outcome.err, "");
    EXPECT_TRUE(scene::parse_json(outcome.out));
}

}  // namespace
}  // namespace fase::cli
