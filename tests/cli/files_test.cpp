/// Tests `fase generate`, `info` and `distance`: their files and their output.
#include <fmt/format.h>

#include "fase/scene/generate.hpp"
#include "tests/cli/fase_program.hpp"
#include "tests/level/drawn_maps.hpp"

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
                      "KIND: found \"palace\"; expected a scene (castle");
    expect_error_line(run_fase({"generate", "pile", "-o", folder / "p.obj"}), 2,
                      "p.obj: found the extension \".obj\"; expected .glb or .gltf for a scene");
    expect_error_line(run_fase({"generate", "pile", "--count", "1000001", "-o", folder / "p.glb"}), 2, "--count");
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Info, DistinguishesScenesAndRecordings) {
    const TemporaryFolder folder;
    ASSERT_EQ(run_fase({"generate", "stack", "--count", "4", "-o", folder / "s.glb"}).code, 0);
    ASSERT_EQ(run_fase({"run", folder / "s.glb", "--steps", "9", "--record", folder / "r.faserec"}).code, 0);
    const Outcome scene = run_fase({"info", folder / "s.glb", "--json"}),
                  recording = run_fase({"info", folder / "r.faserec", "--json"});
    const auto scene_json = scene::parse_json(scene.out), recording_json = scene::parse_json(recording.out);
    ASSERT_TRUE(scene_json) << scene.out;
    ASSERT_TRUE(recording_json) << recording.out;
    expect_keys(scene_json->root(), {"kind", "bodies", "extensions_used", "warnings"});
    EXPECT_EQ(text_at(scene_json->root(), "kind"), "glTF scene");
    EXPECT_EQ(number_at(scene_json->root(), "bodies"), 5);
    EXPECT_EQ(text_at(recording_json->root(), "kind"), "Fase recording");
    EXPECT_EQ(number_at(recording_json->root(), "frames"), 10);
    write_file(folder / "other", "something else");
    expect_error_line(run_fase({"info", folder / "other"}), 2,
                      "other: found another kind of file; `fase info` reads scenes");
    expect_error_line(run_fase({"info", folder / "none"}), 3, "none");
}

TEST(Info, DescribesAWad) {
    const TemporaryFolder folder;
    level::Wad wad = level::wad_of(level::pool_map());
    const level::Map second = [] {
        level::Map map = level::grid_map(5, 4, 1);
        map.name = "MAP02";
        return map;
    }();
    for (const level::Lump& lump : level::wad_of(second).lumps) wad.lumps.push_back(lump);
    const auto bytes = wad.to_bytes();
    ASSERT_TRUE(bytes);
    write_file(folder / "two.wad", {reinterpret_cast<const char*>(bytes->data()), bytes->size()});
    const Outcome outcome = run_fase({"info", folder / "two.wad", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto document = scene::parse_json(outcome.out);
    ASSERT_TRUE(document) << outcome.out;
    EXPECT_EQ(text_at(document->root(), "kind"), "WAD of additions (PWAD)");
    EXPECT_EQ(number_at(document->root(), "lumps"), static_cast<double>(wad.lumps.size()));
    EXPECT_EQ(number_at(document->root(), "map_count"), 2);
    EXPECT_NE(outcome.out.find("[\"MAP01\", \"MAP02\"]"), std::string::npos) << outcome.out;
    expect_keys(document->root(), {"lump_bytes", "warnings"});
    write_file(folder / "cut.wad", "IWAD");
    expect_error_line(run_fase({"info", folder / "cut.wad"}), 2,
                      "cut.wad: byte 0: found 4 bytes; expected a WAD header");
}

TEST(FileKinds, EachCommandNamesTheKindOfAFileThatItCannotRead) {
    const TemporaryFolder folder;
    struct Sample {
        std::string file, name;
    };
    const std::vector<Sample> samples{
        {"x.wad", "a WAD file"},   {"x.png", "a PNG image"},    {"x.rec", "a recording"},   {"x.aabt", "a trace"},
        {"x.snap", "a snapshot"},  {"x.zst", "a zstd archive"}, {"x.gz", "a gzip archive"}, {"x.none", "an empty file"},
        {"x.glb", "a glTF scene"}, {"x.json", "a JSON file"}};
    const std::string rest(200, '\0');
    write_file(folder / "x.wad", "IWAD" + rest);
    write_file(folder / "x.png", "\x89PNG\r\n\x1a\n" + rest);
    write_file(folder / "x.rec", "FASEREC\n" + rest);
    write_file(folder / "x.aabt", "AABT" + rest);
    write_file(folder / "x.snap", "FASESNAP" + rest);
    write_file(folder / "x.zst", "\x28\xb5\x2f\xfd" + rest);
    write_file(folder / "x.gz", "\x1f\x8b" + rest);
    write_file(folder / "x.none", "");
    write_file(folder / "x.glb", "glTF" + rest);
    write_file(folder / "x.json", "{}");
    const auto expect = [&](const std::vector<std::string>& command, const std::string& readable,
                            const std::string& reads) {
        for (const Sample& sample : samples) {
            if (readable.find(sample.file) != std::string::npos) continue;
            std::vector<std::string> arguments = command;
            arguments.insert(arguments.begin() + 1, folder / sample.file);
            expect_error_line(
                run_fase(arguments), 2,
                sample.file + ": found " + sample.name + (sample.file == "x.snap" ? " of a world" : "") + reads);
        }
    };
    expect({"info"}, "x.wad x.rec x.aabt x.glb x.png", "; `fase info` reads scenes (.gltf, .glb), recordings, traces");
    expect({"run"}, "x.wad x.glb", "; `fase run` reads scenes");
    expect({"query"}, "x.wad x.glb x.aabt", "; `fase query` reads scenes");
    expect({"level"}, "x.wad x.glb", "; `fase level` reads levels (.wad) and meshes");
    expect({"view"}, "x.rec x.none", "; `fase view` reads recordings (.faserec)");
    expect({"pairs"}, "x.aabt", "; `fase pairs` reads traces (.aabt)");
    expect({"draw", "-o", folder / "x.svg"}, "x.aabt", "; `fase draw` reads traces (.aabt)");
    expect({"distance"}, "x.json", "; `fase distance` reads pairs of shapes (.json)");
    expect({"atlas", "-o", folder / "sheet"}, "x.png", "; `fase atlas` reads PNG images");
    for (const Sample& sample : samples) {
        if (sample.file == "x.none" || sample.file == "x.json") continue;
        std::filesystem::copy_file(folder / sample.file, folder / (sample.file + ".obj"));
        if (sample.file != "x.wad" && sample.file != "x.glb")
            expect_error_line(run_fase({"level", folder / (sample.file + ".obj")}), 2, "`fase level` reads levels");
        expect_error_line(run_fase({"atlas", "--rects", folder / sample.file}), 2,
                          "`fase atlas --rects` reads a text with a width");
    }
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

TEST(Distance, AFileWithoutCasesIsRefused) {
    const TemporaryFolder folder;
    write_file(folder / "pairs.json", R"({"cases": []})");
    expect_error_line(run_fase({"distance", folder / "pairs.json"}), 2,
                      "pairs.json: byte 11: /cases: found no case; expected at least one");
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

/// The first block of code of that language in a page.
std::string code_in(const std::string& page, const std::string& language) {
    const std::string fence = "```" + language + "\n";
    const std::size_t begin = page.find(fence) + fence.size();
    return page.substr(begin, page.find("```", begin) - begin);
}

TEST(Distance, TheDocumentedExampleGivesTheDocumentedOutput) {
    const TemporaryFolder folder;
    const std::string page = read_file(FASE_DATA "/../docs/distance.md");
    write_file(folder / "pairs.json", code_in(page, "json"));
    const Outcome outcome = run_fase({"distance", folder / "pairs.json"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, code_in(page, "text"));
}

TEST(Distance, TheExampleOfTheHelpIsCorrect) {
    const TemporaryFolder folder;
    const std::string help = run_fase({"distance", "--help"}).out;
    const std::size_t begin = help.find("{\"cases\""), end = help.find("]}\n", begin);
    ASSERT_NE(end, std::string::npos) << help;
    write_file(folder / "pairs.json", help.substr(begin, end + 2 - begin));
    const Outcome outcome = run_fase({"distance", folder / "pairs.json"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("1 of 1 within tolerance"), std::string::npos) << outcome.out;
}

TEST(Distance, AllPublishedPairsAreCorrect) {
    const std::string file = FASE_SHARED_DATA "/shape-pairs/pairs.json";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "skipped: no " << file;
    const Outcome outcome = run_fase({"distance", file});
    EXPECT_EQ(outcome.code, 0) << outcome.out << outcome.err;
}

}  // namespace
}  // namespace fase::cli
