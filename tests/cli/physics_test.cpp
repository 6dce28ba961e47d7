/// Tests scenes without physics: the warnings of `fase run`, and automatic colliders.
#include "tests/cli/fase_program.hpp"

namespace fase::cli {
namespace {

std::string yard() { return std::string(FASE_DATA) + "/gltf/yard.gltf"; }

Outcome run_yard(std::vector<std::string> options) {
    options.insert(options.begin(), {"run", yard(), "--steps", "30"});
    return run_fase(options);
}

TEST(Physics, ASceneWithoutPhysicsSaysSoAndGivesExitCode1) {
    const Outcome outcome = run_yard({});
    expect_error_line(outcome, 1,
                      "yard.gltf: nothing here has physics: 5 meshes, no colliders; add colliders "
                      "(KHR_physics_rigid_bodies) or use --auto-colliders hull|box\n");
    const TemporaryFolder folder;
    write_file(folder / "empty.gltf", R"({"asset": {"version": "2.0"}})");
    expect_error_line(run_fase({"run", folder / "empty.gltf", "--json", "--record", folder / "r.faserec"}), 1,
                      "nothing here has physics: 0 meshes, no colliders; add bodies");
    EXPECT_FALSE(std::filesystem::exists(folder / "r.faserec"));
}

TEST(Physics, AutomaticCollidersMakeItMove) {
    for (const std::string shape : {"hull", "box"}) {
        const Outcome outcome = run_yard({"--auto-colliders", shape, "--static", "^Gro"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_NE(outcome.out.find(shape == "hull" ? "colliders  5 convex hulls made: 3 dynamic bodies, 1 static\n"
                                                   : "colliders  5 boxes made: 3 dynamic bodies, 1 static\n"),
                  std::string::npos)
            << outcome.out;
        EXPECT_EQ(outcome.out.find("nothing is static"), std::string::npos) << outcome.out;
    }
    const auto json = scene::parse_json(run_yard({"--auto-colliders", "box", "--json"}).out);
    ASSERT_TRUE(json);
    EXPECT_EQ(number_at(json->root(), "auto_colliders"), 5);
    EXPECT_EQ(number_at(json->root(), "bodies"), 4);
}

TEST(Physics, WarningsComeFirstInTheOrderOfHarm) {
    const Outcome outcome = run_yard({"--auto-colliders", "hull"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(outcome.out.starts_with(
        "warning    nothing is static: everything falls for ever; name the ground with --static REGEX\n"
        "warning    extension \"ACME_0\" is not supported, and 4 more of this kind (5 times)\n"
        "warning    textures are not drawn (3 times)\n"
        "warning    flat meshes got colliders 0.1 m thick, behind their faces\n"
        "scene "))
        << outcome.out;
    const Outcome info = run_fase({"info", yard()});
    EXPECT_TRUE(info.out.starts_with("warnings ")) << info.out;
}

TEST(Physics, ASceneInWhichNothingCanMoveWarns) {
    const Outcome outcome = run_yard({"--auto-colliders", "box", "--static", "."});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(
        outcome.out.starts_with("warning    nothing can move: no dynamic or moving kinematic body; "
                                "let --static match fewer nodes\n"))
        << outcome.out;
    EXPECT_EQ(run_yard({"--auto-colliders", "box"}).out.find("nothing can move"), std::string::npos);
}

TEST(Physics, AutomaticCollidersWithoutEffectAreRefused) {
    const auto refused = [](std::vector<std::string> options, const std::string& words) {
        options.insert(options.begin(), {"run", yard()});
        expect_error_line(run_fase(options), 2, words);
    };
    refused({"--auto-colliders", "mesh"},
            "--auto-colliders: found \"mesh\"; expected hull or box; Fase has no triangle-mesh colliders yet");
    refused({"--auto-colliders", "ball"}, "--auto-colliders: found \"ball\"; expected hull or box\n");
    refused({"--auto-colliders", "hull", "--static", "("}, "--static: found \"(\"; expected a regular expression");
    refused({"--auto-colliders", "hull", "--static", "Floor"},
            "--static: found no node that \"Floor\" matches; expected one of \"Ground\", \"Cube.000\"");
    refused({"--static", "Ground"}, "--static: found no --auto-colliders; expected both");
    expect_error_line(run_fase({"run", "stack", "--auto-colliders", "hull"}), 2,
                      "--auto-colliders: found no mesh without a collider");
}

}  // namespace
}  // namespace fase::cli
