/// Tests `fase generate`, `info` and `distance`: their files and their output.
#include <fmt/format.h>

#include "fase/scene/generate.hpp"
#include "tests/cli/fase_program.hpp"

namespace fase::cli {
namespace {

TEST(Generate, GeneratesASmallSceneOfEveryKind) {
    const TemporaryFolder folder;
    for (const scene::Generator& kind : scene::generators()) {
        const std::string file = folder / (std::string(kind.name) + ".glb");
        const Outcome made = run_fase({"generate", std::string(kind.name), "--count", "60", "-o", file});
        EXPECT_EQ(made.code, 0) << made.err;
        EXPECT_NE(made.out.find(kind.name), std::string::npos) << made.out;
        const Outcome run = run_fase({"run", file, "--steps", "3", "--json"});
        EXPECT_EQ(run.code, 0) << run.err;
        EXPECT_NE(run.out.find("\"warnings\": []"), std::string::npos) << run.out;
    }
}

TEST(Generate, EqualSeedsGiveEqualBytes) {
    const TemporaryFolder folder;
    const auto bytes = [&](const char* seed) {
        EXPECT_EQ(run_fase({"generate", "pile", "--count", "50", "--seed", seed, "-o", folder / "p.glb"}).code, 0);
        return read_file(folder / "p.glb");
    };
    const std::string first = bytes("5");
    EXPECT_EQ(bytes("5"), first);
    EXPECT_NE(bytes("6"), first);
}

TEST(Generate, RefusesUnknownKindsCountsAndExtensions) {
    const TemporaryFolder folder;
    expect_error_line(run_fase({"generate", "palace", "-o", folder / "p.glb"}), 2,
                      "KIND: found \"palace\"; expected one of castle");
    expect_error_line(run_fase({"generate", "pile", "-o", folder / "p.obj"}), 2, "p.obj: found another extension");
    expect_error_line(run_fase({"generate", "pile", "--count", "1000001", "-o", folder / "p.glb"}), 2, "--count");
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Info, DistinguishesScenesAndRecordings) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_fase({"generate", "stack", "--count", "4", "-o", folder / "s.glb"}).code, 0);
    ASSERT_EQ(run_fase({"run", folder / "s.glb", "--steps", "9", "--record", folder / "r"}).code, 0);
    const Outcome scene = run_fase({"info", folder / "s.glb", "--json"}),
                  recording = run_fase({"info", folder / "r", "--json"});
    const auto scene_json = scene::parse_json(scene.out), recording_json = scene::parse_json(recording.out);
    ASSERT_TRUE(scene_json) << scene.out;
    ASSERT_TRUE(recording_json) << recording.out;
    expect_keys(scene_json->root(), {"kind", "bodies", "extensions_used", "warnings"});
    EXPECT_EQ(text_at(scene_json->root(), "kind"), "glTF scene");
    EXPECT_EQ(number_at(scene_json->root(), "bodies"), 5);
    EXPECT_EQ(text_at(recording_json->root(), "kind"), "Fase recording");
    EXPECT_EQ(number_at(recording_json->root(), "frames"), 10);
    write_file(folder / "other", "something else");
    expect_error_line(run_fase({"info", folder / "other"}), 2, "other");
    expect_error_line(run_fase({"info", folder / "none"}), 3, "none");
}

/// Two unit spheres 1 m apart, with a published distance to compare.
std::string pairs_file(double published) {
    constexpr const char* unit = "\"rot\": [1,0,0,0,1,0,0,0,1]";
    return fmt::format(
        "{{\"cases\": [{{\"id\": \"p1\", \"a\": {{\"type\": \"sphere\", \"size\": [1], \"pos\": [0,0,0], {0}}}, "
        "\"b\": {{\"type\": \"sphere\", \"size\": [1], \"pos\": [3,0,0], {0}}}, \"distance\": {1}, \"tol\": 1e-6}}, "
        "{{\"id\": \"p2\", \"a\": {{\"type\": \"torus\"}}, \"b\": {{\"type\": \"sphere\", \"size\": [1], \"pos\": "
        "[3,0,0], {0}}}, \"distance\": 0, \"tol\": 1}}]}}",
        unit, published);
}

TEST(Distance, PrintsTheKeysThatScriptsRelyOn) {
    const TemporaryFolder folder;
    write_file(folder / "pairs.json", pairs_file(1));
    const Outcome outcome = run_fase({"distance", folder / "pairs.json", "--json"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const auto document = scene::parse_json(outcome.out);
    ASSERT_TRUE(document) << outcome.out;
    const scene::JsonValue all = document->root();
    expect_keys(all, {"total", "within", "skipped", "worst_error", "cases"});
    EXPECT_EQ(number_at(all, "total"), 2);
    EXPECT_EQ(number_at(all, "within"), 1);
    EXPECT_EQ(number_at(all, "skipped"), 1);
    all.find("cases")->for_each_element([](const scene::JsonValue& one) {
        expect_keys(one, {"id", "distance", "published", "error", "skipped"});
    });
    const Outcome lines = run_fase({"distance", folder / "pairs.json"});
    EXPECT_NE(lines.out.find("1 of 1 within tolerance"), std::string::npos) << lines.out;
}

TEST(Distance, AWrongDistanceGivesExitCode1) {
    const TemporaryFolder folder;
    write_file(folder / "pairs.json", pairs_file(1.5));
    const Outcome outcome = run_fase({"distance", folder / "pairs.json"});
    EXPECT_EQ(outcome.code, 1) << outcome.err;
    EXPECT_NE(outcome.out.find("0 of 1 within tolerance"), std::string::npos) << outcome.out;
    write_file(folder / "pairs.json", "{\"cases\": 3}");
    expect_error_line(run_fase({"distance", folder / "pairs.json"}), 2, "pairs.json");
    expect_error_line(run_fase({"distance", folder / "none.json"}), 3, "none.json");
}

TEST(Distance, AllPublishedPairsAreCorrect) {
    const std::string file = FASE_SHARED_DATA "/shape-pairs/pairs.json";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "skipped: no " << file;
    const Outcome outcome = run_fase({"distance", file});
    EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
}

}  // namespace
}  // namespace fase::cli
