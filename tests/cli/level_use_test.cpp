/// Tests `fase level` with meshes and visibility, and `fase run` with levels.
#include <filesystem>
#include <fstream>

#include "tests/cli/fase_program.hpp"
#include "tests/level/drawn_maps.hpp"

namespace fase::cli {
namespace {

namespace fs = std::filesystem;

std::string write_wad(const TemporaryFolder& folder) {
    const auto bytes = level::wad_of(level::pool_map()).to_bytes();
    std::ofstream(folder / "pool.wad", std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes->data()), static_cast<std::streamsize>(bytes->size()));
    return folder / "pool.wad";
}
std::string write_cube(const TemporaryFolder& folder) {
    std::ofstream(folder / "cube.obj") << "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                                          "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n";
    return folder / "cube.obj";
}

TEST(LevelCommand, ComputesVisibleSetsAndChecksThemWithRays) {
    const TemporaryFolder folder;
    const std::string wad = write_wad(folder);
    for (const bool heights : {false, true}) {
        std::vector<std::string> arguments{"level",  wad,       "--pvs",   "--rays", "5000",
                                           "--json", "--point", "300,100", "--svg",  folder / "seen.svg"};
        if (heights) arguments.emplace_back("--heights");
        const Outcome outcome = run_fase(arguments);
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        const auto json = scene::parse_json(outcome.out);
        ASSERT_TRUE(json) << outcome.out;
        const auto pvs = json->root().find("pvs");
        ASSERT_TRUE(pvs);
        EXPECT_EQ(number_at(*pvs, "false_hidden"), 0);
        EXPECT_EQ(number_at(*pvs, "rays"), 5000);
        EXPECT_GE(number_at(*pvs, "passages"), 5000);
        EXPECT_GE(number_at(*pvs, "pairs"), number_at(json->root(), "subsectors"));
        const auto seen = json->root().find("seen");
        ASSERT_TRUE(seen);
        EXPECT_GE(number_at(*seen, "subsectors"), 1);
        EXPECT_GT(number_at(*seen, "area"), 0);
        EXPECT_GT(fs::file_size(folder / "seen.svg"), 500u);
    }
    const Outcome words = run_fase({"level", wad, "--pvs", "--rays", "100"});
    EXPECT_NE(words.out.find("0 falsely hidden"), std::string::npos) << words.out;
}

TEST(LevelCommand, BuildsATreeOfAMesh) {
    const TemporaryFolder folder;
    const std::string cube = write_cube(folder);
    const Outcome outcome = run_fase({"level", cube, "--json", "--rays", "2000", "--point", "0.5,0.5,0.5"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto json = scene::parse_json(outcome.out);
    ASSERT_TRUE(json) << outcome.out;
    EXPECT_EQ(number_at(json->root(), "triangles"), 12);
    EXPECT_EQ(number_at(json->root(), "solid"), 1);
    EXPECT_EQ(number_at(json->root(), "nodes"), 6);
    EXPECT_NE(outcome.out.find("\"point_solid\": true"), std::string::npos);
    EXPECT_NE(outcome.out.find("\"closed\": true"), std::string::npos);
    const auto rays = json->root().find("rays");
    ASSERT_TRUE(rays);
    EXPECT_EQ(number_at(*rays, "wrong"), 0);
    EXPECT_GT(number_at(*rays, "met"), 200);
    const Outcome words = run_fase({"level", cube, "--point", "-0.5,2,0"});
    EXPECT_EQ(words.code, 0);
    EXPECT_NE(words.out.find("(-0.5, 2, 0) is empty"), std::string::npos) << words.out;
}

TEST(LevelCommand, ReadsMeshesFromGltf) {
    const TemporaryFolder folder;
    const std::string file = folder / "stack.glb";
    ASSERT_EQ(run_fase({"generate", "stack", "-o", file}).code, 0);
    const Outcome outcome = run_fase({"level", file, "--rays", "300"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_NE(outcome.out.find(": 0 wrong"), std::string::npos) << outcome.out;
}

TEST(LevelCommand, RefusesOptionsThatDoNotApply) {
    const TemporaryFolder folder;
    const std::string cube = write_cube(folder), wad = write_wad(folder);
    expect_error_line(run_fase({"level", cube, "E1M1"}), 2, "MAP: found a mesh; expected a WAD");
    expect_error_line(run_fase({"level", cube, "--svg", folder / "x.svg"}), 2, "--svg: found a mesh; expected a WAD");
    expect_error_line(run_fase({"level", cube, "--point", "1,2"}), 2, "expected X,Y,Z, three numbers within 1e9");
    expect_error_line(run_fase({"level", cube, "--point", "1,2,nan"}), 2, "expected X,Y,Z");
    expect_error_line(run_fase({"level", wad, "--rays", "10"}), 2, "--rays: found no --pvs");
    expect_error_line(run_fase({"level", folder / "none.obj"}), 3, "none.obj");
    std::ofstream(folder / "bad.obj") << "v 0 0 0\nf 1 2 3\n";
    expect_error_line(run_fase({"level", folder / "bad.obj"}), 2, "bad.obj:2: found corner 2; expected one of the 1");
    std::ofstream(folder / "empty.obj") << "# no face\nv 0 0 0\n";
    expect_error_line(run_fase({"level", folder / "empty.obj"}), 2, "found 0 triangles without area");
    EXPECT_FALSE(fs::exists(folder / "x.svg"));
}

TEST(RunCommand, KeepsAllBodiesInsideALevel) {
    const TemporaryFolder folder;
    const std::string wad = write_wad(folder), recording = folder / "pool.faserec";
    const Outcome outcome =
        run_fase({"run", wad, "--map", "MAP01", "--count", "12", "--seconds", "5", "--json", "--record", recording});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const auto json = scene::parse_json(outcome.out);
    ASSERT_TRUE(json) << outcome.out;
    EXPECT_EQ(number_at(json->root(), "outside"), 0);
    EXPECT_EQ(number_at(json->root(), "bodies"), 13);
    EXPECT_GT(number_at(json->root(), "contacts"), 0);
    EXPECT_EQ(run_fase({"info", recording}).code, 0);
    const Outcome again = run_fase({"run", wad, "--count", "12", "--seconds", "5", "--json", "--threads", "1"});
    const auto other = scene::parse_json(again.out);
    ASSERT_TRUE(other) << again.err;
    EXPECT_EQ(text_at(other->root(), "hash"), text_at(json->root(), "hash"));
    const Outcome words = run_fase({"run", wad, "--count", "3", "--steps", "10"});
    EXPECT_NE(words.out.find("outside    0 bodies at the end"), std::string::npos) << words.out;
}

TEST(RunCommand, RefusesMissingAndDamagedLevels) {
    const TemporaryFolder folder;
    const std::string wad = write_wad(folder);
    expect_error_line(run_fase({"run", wad, "--map", "E9M9"}), 2, "no map \"E9M9\"; expected one of MAP01");
    expect_error_line(run_fase({"run", wad, "--count", "200000"}), 2, "--count: found 200000; expected at most 100000");
    expect_error_line(run_fase({"run", "castle", "--map", "MAP01"}), 2, "--map: found a scene that is not a WAD");
    std::ofstream(folder / "cut.wad", std::ios::binary) << "PWAD";
    expect_error_line(run_fase({"run", folder / "cut.wad"}), 2, "expected a WAD header of 12");
}

}  // namespace
}  // namespace fase::cli
