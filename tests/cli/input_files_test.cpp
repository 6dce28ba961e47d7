/// Tests what each command says about a file of another kind, and that it creates the folders of its output files.
#include <filesystem>

#include "tests/cli/fase_program.hpp"
#include "tests/level/drawn_maps.hpp"

namespace fase::cli {
namespace {

/// A folder with a small file of each kind.
class InputFiles : public ::testing::Test {
protected:
    void SetUp() override {
        ASSERT_EQ(run_fase({"generate", "stack", "--count", "2", "-o", folder / "s.glb"}).code, 0);
        ASSERT_EQ(run_fase({"run", folder / "s.glb", "--steps", "2", "--record", folder / "r.faserec", "--trace",
                            folder / "t.aabt"})
                      .code,
                  0);
        const auto wad = level::wad_of(level::pool_map()).to_bytes();
        ASSERT_TRUE(wad);
        write_file(folder / "w.wad", {reinterpret_cast<const char*>(wad->data()), wad->size()});
        write_file(folder / "m.obj", "# a triangle\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        write_file(folder / "p.json", "{\"cases\": []}");
        write_file(folder / "i.jpg", "\xff\xd8\xff\xe0 JFIF");
        write_file(folder / "i.png", "\x89PNG\r\n\x1a\n cut");
        write_file(folder / "j.xml", "<!-- a -->\n<mujoco model=\"j\"/>");
    }
    /// Expects that the command refuses the file with these words after its name.
    void expect_refused(std::vector<std::string> command, const std::string& file, const std::string& words) {
        const std::string path = folder / file;
        command.push_back(path);
        std::string expected = path + ": " + words;
        if (const std::size_t at = expected.find("FILE"); at != std::string::npos) expected.replace(at, 4, path);
        expect_error_line(run_fase(command), 2, expected);
    }
    TemporaryFolder folder;
};

TEST_F(InputFiles, AFileOfAnotherKindIsNamedWithTheCommandThatReadsIt) {
    expect_refused({"run"}, "r.faserec",
                   "found a recording; `fase run` reads scenes (.gltf, .glb) and levels (.wad): use `fase view FILE`");
    expect_refused({"run"}, "t.aabt",
                   "found a trace; `fase run` reads scenes (.gltf, .glb) and levels (.wad): use `fase pairs FILE`");
    expect_refused({"run"}, "m.obj",
                   "found an OBJ mesh; `fase run` reads scenes (.gltf, .glb) and levels (.wad): use `fase level FILE`");
    expect_refused({"run"}, "j.xml",
                   "found a MuJoCo model (MJCF); `fase run` reads scenes (.gltf, .glb) and levels (.wad); no command");
    expect_refused({"view"}, "s.glb",
                   "found a glTF scene; `fase view` reads recordings (.faserec): use `fase run FILE`");
    expect_refused({"view"}, "t.aabt", "found a trace; `fase view` reads recordings (.faserec): use `fase pairs FILE`");
    expect_refused({"pairs"}, "r.faserec",
                   "found a recording; `fase pairs` reads traces (.aabt): use `fase view FILE`");
    expect_refused({"pairs"}, "w.wad", "found a WAD file; `fase pairs` reads traces (.aabt): use `fase level FILE`");
    expect_refused({"query"}, "i.png",
                   "found a PNG image; `fase query` reads scenes (.gltf, .glb), levels (.wad) and traces (.aabt): use "
                   "`fase atlas FILE -o NAME`");
    expect_refused({"draw", "-o", folder / "x.svg"}, "s.glb", "found a glTF scene; `fase draw` reads traces");
    expect_refused({"distance"}, "s.glb",
                   "found a glTF scene; `fase distance` reads pairs of shapes (.json): use `fase run FILE`");
    expect_refused({"level"}, "r.faserec", "found a recording; `fase level` reads levels (.wad) and meshes");
    expect_refused({"atlas", "-o", folder / "a"}, "i.jpg",
                   "found a JPEG image; `fase atlas` reads PNG images; convert it");
    expect_refused({"atlas", "-o", folder / "a"}, "t.aabt",
                   "found a trace; `fase atlas` reads PNG images: use `fase pairs FILE`");
    expect_refused({"atlas", "--rects"}, "i.png", "found a PNG image; `fase atlas --rects` reads a text");
    expect_refused({"info"}, "i.jpg", "found a JPEG image; `fase info` reads scenes");
}

TEST_F(InputFiles, TheContentDecidesAndNotTheName) {
    const auto renamed = [&](const std::string& from, const std::string& to) {
        std::filesystem::copy_file(folder / from, folder / to);
        return folder / to;
    };
    EXPECT_EQ(run_fase({"run", renamed("s.glb", "s.data"), "--steps", "1"}).code, 0);
    EXPECT_EQ(run_fase({"run", renamed("w.wad", "w.glb"), "--count", "2", "--steps", "1"}).code, 0);
    EXPECT_EQ(run_fase({"level", renamed("m.obj", "m.glb")}).code, 0);
    EXPECT_EQ(run_fase({"level", renamed("s.glb", "s.obj")}).code, 0);
    EXPECT_EQ(run_fase({"pairs", renamed("t.aabt", "t.wad")}).code, 0);
    const Outcome mesh = run_fase({"info", folder / "m.glb"});
    EXPECT_NE(mesh.out.find("OBJ mesh"), std::string::npos) << mesh.out;
}

TEST_F(InputFiles, FoldersOfOutputFilesAreCreated) {
    const std::string scene = folder / "s.glb", trace = folder / "t.aabt";
    const std::vector<std::pair<std::vector<std::string>, std::string>> cases{
        {{"run", scene, "--steps", "1", "--record"}, "a/b/r.faserec"},
        {{"run", scene, "--steps", "1", "--trace"}, "c/t.aabt"},
        {{"view", folder / "r.faserec", "--html"}, "d/r.html"},
        {{"view", folder / "r.faserec", "--glb"}, "e/r.glb"},
        {{"generate", "stack", "-o"}, "f/s.glb"},
        {{"generate", "rain", "--count", "10", "--frames", "2", "-o"}, "g/r.aabt"},
        {{"level", folder / "w.wad", "-o"}, "h/w.wad"},
        {{"level", folder / "w.wad", "--svg"}, "i/w.svg"},
        {{"level", folder / "w.wad", "--png"}, "j/w.png"},
        {{"draw", trace, "-o"}, "k/t.svg"},
    };
    for (const auto& [arguments, file] : cases) {
        std::vector<std::string> all = arguments;
        all.push_back(folder / file);
        const Outcome outcome = run_fase(all);
        EXPECT_EQ(outcome.code, 0) << file << " " << outcome.err;
        EXPECT_TRUE(std::filesystem::exists(folder / file)) << file;
    }
}

TEST_F(InputFiles, TheNameOfAKindInPlaceOfAFileIsExplained) {
    expect_error_line(run_fase({"pairs", "rain"}), 3, "; 'fase generate rain -o rain.aabt' writes such a trace");
    expect_error_line(run_fase({"run", "rain"}), 2, "rain: found a kind of trace; expected a scene");
}

TEST_F(InputFiles, ARefusedCommandCreatesNoFolder) {
    expect_error_line(run_fase({"run", folder / "t.aabt", "--record", folder / "new/r.faserec"}), 2, "found a trace");
    expect_error_line(run_fase({"draw", folder / "s.glb", "-o", folder / "new/x.svg"}), 2, "found a glTF scene");
    EXPECT_FALSE(std::filesystem::exists(folder / "new"));
}

}  // namespace
}  // namespace fase::cli
