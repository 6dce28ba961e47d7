/// Tests of the glTF reader with truncated, damaged and hostile files: each gives a one-line error or a scene, never a
/// crash.
#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/stat.h>

#include <cmath>
#include <map>

#include "fase/geometry/mass.hpp"
#include "fase/scene/detail/json.hpp"
#include "fase/scene/gltf_write.hpp"
#include "tests/scene/support.hpp"

namespace fase::scene {
namespace {

using test::read_text;

/// Expects what every result must satisfy.
void expect_sane(const Result<Scene>& scene, const std::string& what) {
    if (!scene) {
        const std::string text = scene.error().text();
        EXPECT_EQ(text.find('\n'), std::string::npos) << what << text;
        EXPECT_TRUE(scene.status() == Status::Format || scene.status() == Status::Unsupported) << what << text;
        EXPECT_FALSE(scene.error().problem.empty()) << what;
        EXPECT_TRUE(scene.error().where.starts_with("test.gltf")) << what << text;
        return;
    }
    for (const Body& body : scene->bodies) {
        EXPECT_TRUE(is_finite(body.def.position) && is_finite(body.def.rotation) && is_finite(body.def.linear_velocity))
            << what;
        for (const Collider& collider : body.colliders) {
            ASSERT_LT(collider.shape, scene->shapes.size()) << what;
            EXPECT_TRUE(check(scene->shapes[collider.shape])) << what;
            EXPECT_TRUE(is_finite(collider.def.pose.position)) << what;
        }
        for (const Visual& visual : body.visuals) ASSERT_LT(visual.mesh, scene->meshes.size()) << what;
    }
    for (const Mesh& mesh : scene->meshes) {
        for (const std::uint32_t index : mesh.indices) ASSERT_LT(index, mesh.positions.size()) << what;
    }
}

/// A small scene with bodies, hulls and visuals, as a file.
std::string sample(GltfForm form) {
    const Result<Scene> scene = read_gltf(test::fixture("meshes.gltf"));
    EXPECT_TRUE(scene);
    return *gltf_bytes(*scene, form);
}

TEST(HostileGltf, TruncatedAtEveryByte) {
    for (const std::string& whole :
         {sample(GltfForm::Binary), sample(GltfForm::Text), test::content_of(test::fixture("surfaces.gltf"))}) {
        ASSERT_TRUE(read_text(whole));
        for (std::size_t length = 0; length + 1 < whole.size(); ++length) {
            const auto scene = read_text(whole.substr(0, length));
            EXPECT_FALSE(scene) << "cut at " << length;
            expect_sane(scene, "cut at " + std::to_string(length) + ": ");
        }
    }
}

TEST(HostileGltf, OneBitFlippedAtEveryByte) {
    for (const std::string& whole :
         {sample(GltfForm::Binary), sample(GltfForm::Text), test::content_of(test::fixture("hierarchy.gltf")),
          test::content_of(test::fixture("older_omi.gltf"))}) {
        std::string damaged = whole;
        for (std::size_t at = 0; at < whole.size(); ++at) {
            for (const int bit : {static_cast<int>(at % 8), 0}) {
                damaged[at] = static_cast<char>(damaged[at] ^ 1 << bit);
                expect_sane(read_text(damaged), "bit " + std::to_string(bit) + " of byte " + std::to_string(at) + ": ");
                damaged[at] = whole[at];
            }
        }
    }
}

TEST(HostileGltf, NumbersReplacedByHostileOnes) {
    // Replaces every number of the files, one at a time, by each of these.
    for (const std::string_view name :
         {"meshes.gltf", "hierarchy.gltf", "motions.gltf", "surfaces.gltf", "joints.gltf", "shapes.gltf"}) {
        const std::string whole = test::content_of(test::fixture(name));
        const auto is_digit = [&](std::size_t i) {
            return i < whole.size() && std::string_view("0123456789.-").find(whole[i]) != std::string_view::npos;
        };
        bool in_text = false;
        for (std::size_t at = 0; at < whole.size(); ++at) {
            if (whole[at] == '"') in_text = !in_text;
            if (in_text || !is_digit(at) || is_digit(at - 1)) continue;
            std::size_t end = at;
            while (is_digit(end)) ++end;
            for (const std::string_view hostile : {"-1", "4294967295", "18446744073709551615", "1e308", "-1e30",
                                                   "1e-300", "0.5", "null", "\"x\"", "{}", "[]"}) {
                const std::string text = whole.substr(0, at) + std::string(hostile) + whole.substr(end);
                expect_sane(read_text(text),
                            std::string(name) + ", byte " + std::to_string(at) + " = " + std::string(hostile) + ": ");
            }
        }
    }
}

TEST(HostileGltf, ValidatorFilesNeverCrashAndStructuralErrorsAreRefused) {
    const std::filesystem::path folder = std::filesystem::path(FASE_SHARED_DATA) / "gltf-validator";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "skipped: no " << folder;
    std::size_t files = 0, refused = 0, accepted = 0;
    // Errors of the validator in parts that Fase does not read; files with only these may be accepted.
    const auto is_ignored = [](std::string_view pointer, std::string_view code) {
        for (const std::string_view part :
             {"/animations", "/cameras", "/images", "/samplers", "/skins", "/textures", "/extensionsUsed"}) {
            if (pointer.starts_with(part)) return true;
        }
        for (const std::string_view part :
             {"/weights", "/targets", "/skin", "Texture", "/min", "/max", "JOINTS", "WEIGHTS", "TANGENT", "NORMAL"}) {
            if (pointer.find(part) != std::string_view::npos) return true;
        }
        // Mesh data except positions, declared ranges of data, and rules about other references to it.
        for (const std::string_view part :
             {"ACCESSOR_M", "MESH_PRIMITIVE", "ACCESSOR_INDEX_PRIMITIVE_RESTART", "MESH_INVALID_WEIGHTS",
              "UNDEFINED_PROPERTY", "INVALID_EXTENSION_NAME", "UNSATISFIED_DEPENDENCY", "UNEXPECTED_EXTENSION",
              "UNDECLARED_EXTENSION", "NODE_SKIN", "NODE_WEIGHTS", "VALUE_NOT_IN_LIST", "ROTATION_NON_UNIT",
              "ACCESSOR_ELEMENT", "DATA_URI", "IO_ERROR"}) {
            if (code.starts_with(part)) return true;
        }
        return false;
    };
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::string ending = entry.path().extension().string();
        if (ending != ".gltf" && ending != ".glb") continue;
        ++files;
        const Result<Scene> scene = read_gltf(entry.path().string());
        if (!scene) {
            EXPECT_EQ(scene.error().text().find('\n'), std::string::npos);
            EXPECT_TRUE(scene.status() == Status::Format || scene.status() == Status::Unsupported)
                << scene.error().text();
        }
        ++(scene ? accepted : refused);
        const std::string report_text = test::content_of(entry.path().string() + ".report.json");
        const auto report = parse_json(report_text);
        ASSERT_TRUE(report) << entry.path();
        std::string structural;
        report->root().find("issues")->find("messages")->for_each_element([&](JsonValue message) {
            const auto pointer = message.find("pointer");
            const std::string_view where = pointer ? pointer->string() : "", code = message.find("code")->string();
            if (message.find("severity")->number() == 0 && !is_ignored(where, code))
                structural += std::string(code) + " at " + std::string(where) + "; ";
        });
        if (!structural.empty()) {
            EXPECT_FALSE(scene) << entry.path() << ": " << structural;
        }
    }
    EXPECT_GT(files, 100u);
    EXPECT_GT(accepted, 20u);
    EXPECT_GT(refused, 40u);
}

/// A file with these nodes.
std::string with_nodes(std::string_view nodes, std::string_view rest = "") {
    return R"({"asset":{"version":"2.0"},"nodes":[)" + std::string(nodes) + "]" + std::string(rest) + "}";
}

TEST(HostileGltf, InvalidTreesAreRefusedAndTheNodeIsNamed) {
    const auto error_of = [](const std::string& text) {
        const auto scene = read_text(text);
        EXPECT_FALSE(scene) << text;
        return scene ? std::string() : scene.error().text();
    };
    EXPECT_NE(error_of(with_nodes(R"({"children":[0]})")).find("node 0 as its own child"), std::string::npos);
    EXPECT_NE(error_of(with_nodes(R"({"children":[1]},{"children":[2]},{"children":[0]})"))
                  .find("node 0 among its own descendants"),
              std::string::npos);
    EXPECT_NE(error_of(with_nodes(R"({"children":[2]},{"children":[2]},{})")).find("child of nodes 0 and 1"),
              std::string::npos);
    EXPECT_NE(error_of(with_nodes(R"({"children":[1,1]},{})")).find("/nodes/0/children/1"), std::string::npos);
    EXPECT_NE(error_of(with_nodes(R"({"children":[7]})")).find("index 7"), std::string::npos);
    EXPECT_NE(error_of(with_nodes("{}", R"(,"scene":3,"scenes":[{"nodes":[0]}])")).find("/scene"), std::string::npos);
    EXPECT_NE(error_of(with_nodes("{}", R"(,"scenes":[{"nodes":[9]}])")).find("/scenes/0/nodes/0"), std::string::npos);
    EXPECT_NE(error_of(with_nodes(R"({"children":[1]},{})", R"(,"scenes":[{"nodes":[1]}])")).find("expected a root"),
              std::string::npos);
    EXPECT_NE(error_of(with_nodes(R"({"scale":[1,1]})")).find("/nodes/0/scale"), std::string::npos);
    EXPECT_NE(error_of(with_nodes(R"({"rotation":[0,0,0,0]})")).find("length 0"), std::string::npos);
}

TEST(HostileGltf, ALongChainOfNodesIsRefusedAndManyChildrenAreRead) {
    std::string chain, wide = R"({"children":[1)";
    for (int i = 0; i < 100000; ++i) chain += R"({"children":[)" + std::to_string(i + 1) + "]},";
    EXPECT_FALSE(read_text(with_nodes(chain + "{}")));
    for (int i = 2; i < 100000; ++i) wide.append(",").append(std::to_string(i));
    wide += "]}";
    for (int i = 1; i < 100000; ++i) wide += ",{}";
    EXPECT_TRUE(read_text(with_nodes(wide)));
}

/// A file with one mesh of 3 points and these members of its buffer, view and accessor.
std::string with_accessor(std::string_view accessor, std::string_view view = R"("buffer":0,"byteLength":36)",
                          std::string_view buffer = R"("byteLength":36)") {
    return R"({"asset":{"version":"2.0"},"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],"accessors":[{)" +
           std::string(accessor) + R"(}],"bufferViews":[{)" + std::string(view) + R"(}],"buffers":[{)" +
           std::string(buffer) + R"(,"uri":"data:;base64,AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAA"}]})";
}

TEST(HostileGltf, OffsetsAndCountsAreCheckedAgainstTheData) {
    EXPECT_TRUE(read_text(with_accessor(R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3")")));
    for (
        const std::string_view accessor : {
            R"("bufferView":0,"componentType":5126,"count":4,"type":"VEC3")",
            R"("bufferView":0,"componentType":5126,"count":4294967295,"type":"VEC3")",
            R"("bufferView":0,"componentType":5126,"count":1e15,"type":"VEC3")",
            R"("bufferView":0,"componentType":5126,"count":0,"type":"VEC3")",
            R"("bufferView":0,"componentType":5126,"count":-3,"type":"VEC3")",
            R"("bufferView":0,"componentType":5126,"count":2.5,"type":"VEC3")",
            R"("bufferView":0,"byteOffset":9007199254740992,"componentType":5126,"count":3,"type":"VEC3")",
            R"("bufferView":0,"byteOffset":18446744073709551612,"componentType":5126,"count":3,"type":"VEC3")",
            R"("bufferView":0,"byteOffset":2,"componentType":5126,"count":1,"type":"VEC3")",
            R"("bufferView":1,"componentType":5126,"count":3,"type":"VEC3")",
            R"("bufferView":0,"componentType":9999,"count":3,"type":"VEC3")",
            R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC9")",
            R"("bufferView":0,"componentType":5126,"count":3,"type":"SCALAR")",
            R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":4,"indices":{"bufferView":0,"componentType":5121},"values":{"bufferView":0}})",
            R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3","sparse":{"count":1,"indices":{"bufferView":0,"byteOffset":36,"componentType":5121},"values":{"bufferView":0}})",
        }) {
        EXPECT_FALSE(read_text(with_accessor(accessor))) << accessor;
    }
    const std::string_view good = R"("bufferView":0,"componentType":5126,"count":3,"type":"VEC3")";
    for (const std::string_view view :
         {R"("buffer":0,"byteLength":37)", R"("buffer":0,"byteOffset":1,"byteLength":36)",
          R"("buffer":0,"byteOffset":9007199254740991,"byteLength":36)", R"("buffer":1,"byteLength":36)",
          R"("buffer":0,"byteLength":36,"byteStride":0)", R"("buffer":0,"byteLength":36,"byteStride":8)"}) {
        EXPECT_FALSE(read_text(with_accessor(good, view))) << view;
    }
    for (const std::string_view buffer :
         {R"("byteLength":37)", R"("byteLength":0)", R"("byteLength":4294967295)", R"("byteLength":1e300)"}) {
        EXPECT_FALSE(read_text(with_accessor(good, R"("buffer":0,"byteLength":36)", buffer))) << buffer;
    }
}

TEST(HostileGltf, ManyViewsOfTheSameBytesStayWithinTheMemoryLimit) {
    // A megabyte of zeros that a thousand accessors decode again.
    std::string text = R"({"asset":{"version":"2.0"},"nodes":[)", meshes, accessors;
    for (int i = 0; i < 1000; ++i) {
        const std::string comma = i == 0 ? "" : ",", number = std::to_string(i);
        text += comma + R"({"mesh":)" + number + "}";
        meshes += comma + R"({"primitives":[{"attributes":{"POSITION":)" + number + "}}]}";
        accessors += comma + R"({"bufferView":0,"componentType":5126,"count":87381,"type":"VEC3"})";
    }
    text +=
        R"(],"meshes":[)" + meshes + R"(],"accessors":[)" + accessors +
        R"(],"bufferViews":[{"buffer":0,"byteLength":1048572}],"buffers":[{"byteLength":1048572,"uri":"data:;base64,)" +
        std::string(1398096, 'A') + R"("}]})";
    const auto scene = read_text(text);
    ASSERT_FALSE(scene);
    EXPECT_NE(scene.error().text().find("grows"), std::string::npos) << scene.error().text();
    // Elements of a hundred bytes that become hulls of kilobytes.
    std::string shapes, nodes;
    for (int i = 0; i < 10000; ++i) {
        shapes.append(i == 0 ? "" : ",").append(R"({"type":"capsule","capsule":{"radiusTop":0.1,"radiusBottom":0.5)");
        shapes.append(std::to_string(i)).append("}}");
        nodes.append(i == 0 ? "" : ",").append(R"({"extensions":{"OMI_physics_body":{"collider":{"shape":)");
        nodes.append(std::to_string(i)).append("}}}}");
    }
    const auto cones =
        read_text(with_nodes(nodes, R"(,"extensions":{"OMI_physics_shape":{"shapes":[)" + shapes + "]}}"));
    ASSERT_FALSE(cones);
    EXPECT_NE(cones.error().text().find("grows"), std::string::npos) << cones.error().text();
    // Zeros without bytes in the file.
    EXPECT_FALSE(read_text(with_accessor(R"("componentType":5126,"count":4294967295,"type":"VEC3")")));
}

TEST(HostileGltf, UrisOutsideTheFolderAreRefused) {
    const test::TemporaryFolder folder;
    std::filesystem::create_directory(folder / "model");
    const std::string model = folder / "model";
    test::write_text(folder / "secret.bin", std::string(100, 'x'));
    test::write_text(model + "/data.bin", std::string(100, 'x'));
    ASSERT_EQ(mkfifo((model + "/pipe").c_str(), 0600), 0);
    std::filesystem::create_directory(model + "/sub");
    std::filesystem::create_symlink("/dev/zero", model + "/zero");
    std::filesystem::create_symlink("../secret.bin", model + "/link.bin");
    const auto with_uri = [&](std::string_view uri) {
        return read_text(R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":4,"uri":)" + scene::quoted(uri) + "}]}",
                         model);
    };
    EXPECT_TRUE(with_uri("data.bin"));
    for (const std::string_view uri : {"../secret.bin", "../../../../../etc/passwd", "%2e%2e/secret.bin", "/etc/passwd",
                                       "C:\\a", "http://localhost/a", "pipe", "sub", "zero", "link.bin", "missing.bin",
                                       "data.bin%00.txt", "", "data:;base64,@@@@"}) {
        expect_sane(with_uri(uri), std::string(uri));
        EXPECT_FALSE(with_uri(uri)) << uri;
    }
}

TEST(HostileGltf, InvalidContainersAreRefusedAtTheirByte) {
    const std::string whole = sample(GltfForm::Binary);
    const auto changed = [&](std::size_t at, char value) {
        std::string text = whole;
        text[at] = value;
        const auto scene = read_text(text);
        EXPECT_FALSE(scene);
        return scene ? std::string() : scene.error().where;
    };
    EXPECT_EQ(changed(4, 7), "test.gltf: byte 4");
    EXPECT_EQ(changed(8, whole[8] == 4 ? 8 : 4), "test.gltf: byte 8");
    EXPECT_EQ(changed(15, 0x7f), "test.gltf: byte 12");
    EXPECT_EQ(changed(16, 'X'), "test.gltf: byte 16");
    EXPECT_FALSE(read_text(whole + "junk"));
    EXPECT_EQ(read_text(whole.substr(0, 10)).error().where, "test.gltf: byte 10");
}

TEST(HostileGltf, InvalidPhysicsIsRefused) {
    const auto with_node = [](std::string_view physics, std::string_view shape = R"({"type":"box"})") {
        return read_text(R"({"asset":{"version":"2.0"},"extensions":{"KHR_implicit_shapes":{"shapes":[)" +
                         std::string(shape) + R"(]}},"nodes":[{"extensions":{"KHR_physics_rigid_bodies":)" +
                         std::string(physics) + "}}]}");
    };
    EXPECT_TRUE(with_node(R"({"motion":{},"collider":{"geometry":{"shape":0}}})"));
    for (const std::string_view physics :
         {R"({"motion":{"mass":-1}})", R"({"motion":{"mass":1,"inertiaDiagonal":[1,1,5]}})",
          R"({"motion":{"linearVelocity":[1,2]}})", R"({"motion":[]})",
          R"({"motion":{"inertiaOrientation":[0,0,0,5]}})", R"({"collider":{"geometry":{"shape":1}}})",
          R"({"collider":{"geometry":{}}})", R"({"collider":{"geometry":{"shape":0,"node":0}}})",
          R"({"collider":{"geometry":{"shape":0},"physicsMaterial":0}})", R"({"joint":{"connectedNode":0}})",
          R"({"trigger":{"nodes":[5]}})", R"({"motion":{"isKinematic":1}})"}) {
        const auto scene = with_node(physics);
        EXPECT_FALSE(scene) << physics;
        expect_sane(scene, std::string(physics));
    }
    for (const std::string_view shape :
         {R"({"type":"sphere","sphere":{"radius":0}})", R"({"type":"sphere","sphere":{"radius":-1}})",
          R"({"type":"sphere","sphere":{"radius":1e20}})", R"({"type":"box","box":{"size":[1,0,1]}})",
          R"({"type":"capsule","capsule":{"radiusTop":0,"radiusBottom":0}})", R"({"sphere":{}})", R"({"type":3})",
          "7"}) {
        EXPECT_FALSE(with_node(R"({"collider":{"geometry":{"shape":0}}})", shape)) << shape;
    }
}

TEST(HostileGltf, MemoryStaysWithinSixteenTimesTheFile) {
    // Reads the bytes in use from the allocator while the document exists.
    for (const std::string_view element : {"0,", "{},", "[],", "\"\",", "{\"a\":0},"}) {
        std::string text = R"({"asset":{"version":"2.0"},"extras":[)";
        while (text.size() < 8u << 20) text += element;
        text.pop_back();
        text += "]}";
        const std::size_t before = mallinfo2().uordblks + mallinfo2().hblkhd;
        const auto document = parse_json(text);
        ASSERT_TRUE(document);
        const std::size_t after = mallinfo2().uordblks + mallinfo2().hblkhd;
        EXPECT_LT(after - before, 16 * text.size()) << element;
    }
}

}  // namespace
}  // namespace fase::scene
