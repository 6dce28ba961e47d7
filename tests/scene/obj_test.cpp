#include "fase/scene/obj.hpp"

#include <gtest/gtest.h>

#include <filesystem>

namespace fase::scene {
namespace {

Result<TriangleMesh> parsed(std::string_view text) {
    return parse_obj("x.obj", std::as_bytes(std::span(text.data(), text.size())));
}
std::string refusal(std::string_view text) {
    const auto mesh = parsed(text);
    return mesh ? "read" : mesh.error().text();
}

constexpr std::string_view corners = "v 0 0 0\nv 1 0 0\nv 1 1 0 1.0\nv 0 1 0\n";

TEST(Obj, ReadsCornersAndFaces) {
    const auto mesh = parsed(std::string(corners) + "# a face\no x\nf 1/2/3 2//1 3\nf -4 -2 -1\ns off\n");
    ASSERT_TRUE(mesh) << mesh.error().text();
    EXPECT_EQ(mesh->positions.size(), 4u);
    EXPECT_EQ(mesh->positions[2], (Vec3{1, 1, 0}));
    EXPECT_EQ(mesh->indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
}

/// Sum of the triangles' area vectors, and of their areas.
std::pair<Vec3, float> surface(const TriangleMesh& mesh) {
    Vec3 sum{};
    float size = 0;
    for (std::size_t t = 0; t < mesh.indices.size(); t += 3) {
        const Vec3 a = mesh.positions[mesh.indices[t]];
        const Vec3 half =
            cross(mesh.positions[mesh.indices[t + 1]] - a, mesh.positions[mesh.indices[t + 2]] - a) * 0.5f;
        sum += half;
        size += length(half);
    }
    return {sum, size};
}

TEST(Obj, TriangulatesFacesOfMoreCorners) {
    const auto mesh = parsed(std::string(corners) + "f 1 2 3 4");
    ASSERT_TRUE(mesh);
    EXPECT_EQ(mesh->indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3}));
}

TEST(Obj, TriangulatesConcaveFacesInsideTheirOutline) {
    // A comb with three teeth, in each of the three coordinate planes, in both orientations.
    constexpr float comb[][2] = {{0, 0}, {5, 0}, {5, 3}, {4, 3}, {4, 1}, {3, 1},
                                 {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
    for (int axis = 0; axis < 3; ++axis) {
        for (const bool reversed : {false, true}) {
            std::string text, face = "f";
            for (int i = 0; i < 12; ++i) {
                Vec3 p{};
                p[(axis + 1) % 3] = comb[i][0];
                p[(axis + 2) % 3] = comb[i][1];
                text += "v " + std::to_string(p.x) + " " + std::to_string(p.y) + " " + std::to_string(p.z) + "\n";
                face += " " + std::to_string(reversed ? 12 - i : i + 1);
            }
            const auto mesh = parsed(text + face);
            ASSERT_TRUE(mesh);
            EXPECT_EQ(mesh->indices.size(), 30u);
            const auto [sum, size] = surface(*mesh);
            EXPECT_FLOAT_EQ(size, 11);
            EXPECT_FLOAT_EQ(sum[axis], reversed ? -11.0f : 11.0f);
        }
    }
}

TEST(Obj, KeepsSelfIntersectingFaces) {
    const auto mesh = parsed(std::string(corners) + "f 1 3 2 4\nf 1 1 1 1 1\n");
    ASSERT_TRUE(mesh);
    EXPECT_EQ(mesh->indices.size(), 15u);
}

TEST(Obj, ReadsContinuedLinesAndDosLineEnds) {
    const auto mesh = parsed("v 0 0 0\r\nv 1 \\\r\n 0 0\r\nv 0 +1 1e-3\r\nf 1 2 \\\n3\r\n");
    ASSERT_TRUE(mesh) << mesh.error().text();
    EXPECT_EQ(mesh->indices.size(), 3u);
    EXPECT_EQ(mesh->positions[1], (Vec3{1, 0, 0}));
}

TEST(Obj, NamesTheLineOfAnError) {
    EXPECT_EQ(refusal("v 0 0\n"), "x.obj:1: found nothing as a coordinate; expected a number in the range of float");
    EXPECT_EQ(refusal("\nv 0 0 1e99\n"),
              "x.obj:2: found \"1e99\" as a coordinate; expected a number in the range of float");
    EXPECT_EQ(refusal("v 0 0 nan\n"),
              "x.obj:1: found \"nan\" as a coordinate; expected a number in the range of float");
    EXPECT_EQ(refusal(std::string(corners) + "f 1 2 5\n"),
              "x.obj:5: found corner 5; expected one of the 4 before this line");
    EXPECT_EQ(refusal(std::string(corners) + "f 1 2 0\n"),
              "x.obj:5: found corner 0; expected one of the 4 before this line");
    EXPECT_EQ(refusal(std::string(corners) + "f -5 2 1\n"),
              "x.obj:5: found corner -5; expected one of the 4 before this line");
    EXPECT_EQ(refusal(std::string(corners) + "f 1 2\n"), "x.obj:5: found a face of 2 corners; expected at least 3");
    EXPECT_EQ(refusal(std::string(corners) + "f 1 b 3\n"),
              "x.obj:5: found \"b\" as a corner of a face; expected a vertex number");
    EXPECT_EQ(refusal(std::string("v 0\0 0", 6)), "x.obj: byte 3: found a NUL byte; expected text");
}

TEST(Obj, SurvivesEveryTruncationAndFlippedBit) {
    const std::string text = std::string(corners) + "f 1/1 2/2 3/3 \\\n 4/4\nf -1 -2 -3\n";
    for (std::size_t size = 0; size <= text.size(); ++size) {
        const auto mesh = parsed(std::string_view(text).substr(0, size));
        if (mesh) {
            for (const std::uint32_t index : mesh->indices) EXPECT_LT(index, mesh->positions.size());
        }
    }
    for (std::size_t bit = 0; bit < text.size() * 8; ++bit) {
        std::string flipped = text;
        flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
        const auto mesh = parsed(flipped);
        if (mesh) {
            for (const std::uint32_t index : mesh->indices) EXPECT_LT(index, mesh->positions.size());
        }
    }
}

TEST(Obj, ReadsTheSharedMeshes) {
    const auto folder = std::filesystem::path(FASE_SHARED_DATA) / "meshes";
    if (!std::filesystem::exists(folder)) GTEST_SKIP() << "skipped: no meshes in " << FASE_SHARED_DATA;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) {
        if (entry.path().extension() != ".obj") continue;
        const auto mesh = read_obj(entry.path().string());
        ASSERT_TRUE(mesh) << mesh.error().text();
        EXPECT_GE(mesh->indices.size(), 3u) << entry.path();
    }
}

TEST(Obj, RefusesMissingFilesAndFolders) {
    EXPECT_EQ(read_obj("/nowhere/x.obj").status(), Status::Io);
    EXPECT_EQ(read_obj(".").status(), Status::Format);
}

}  // namespace
}  // namespace fase::scene
