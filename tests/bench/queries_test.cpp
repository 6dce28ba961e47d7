/// All contenders give the same answers to queries; OBJ files are read or refused.
#include "bench/queries.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

namespace fase::bench {
namespace {

QueryOptions small() {
    QueryOptions options;
    options.counts = {.items = 5000, .rays = 640, .boxes = 640, .frusta = 64};
    options.rounds = 1;
    options.seconds = 20;
    return options;
}

TEST(Queries, AllContendersGiveTheSameAnswers) {
    const QueryOptions options = small();
    const Result<std::vector<QueryScene>> scenes = query_scenes(options);
    ASSERT_TRUE(scenes);
    ASSERT_EQ(scenes->size(), 3u);
    for (const QueryScene& scene : *scenes) {
        const auto rows = measure_queries(
            scene, options, [](std::uint64_t, std::uint64_t, std::string_view, std::string_view) { return true; });
        ASSERT_TRUE(rows) << rows.error().text();
        ASSERT_GE(rows->size(), 3 * 11u);
        std::size_t rays_hit = 0;
        for (const QueryRow& row : *rows) {
            SCOPED_TRACE(scene.name + " " + row.contender + " " + row.kind);
            EXPECT_GT(row.per_second, 0);
            EXPECT_LE(row.low, row.per_second);
            EXPECT_GE(row.high, row.per_second);
            EXPECT_GT(row.queries, 0u);
            EXPECT_LE(row.differ, row.compared / 200) << "of " << row.compared;
            EXPECT_FALSE(row.settings.empty());
            rays_hit += row.kind == "rays" ? row.hits : 0;
        }
        EXPECT_GT(rays_hit, 100u);
    }
}

TEST(Queries, ThePileMovesAndKeepsItsShape) {
    const QueryScene pile = stirred_pile({.items = 50000});
    std::vector<broad::Move> begin, end;
    pile.boxes_at(0, begin);
    pile.boxes_at(pile.frames - 1, end);
    ASSERT_EQ(begin.size(), 1000u);
    double max_distance = 0;
    for (std::size_t i = 0; i < begin.size(); ++i) {
        const Vec3d a = to_double(centre(begin[i].box)), b = to_double(centre(end[i].box));
        max_distance = std::max(max_distance, length(b - a));
        EXPECT_NEAR(a.x * a.x + a.z * a.z, b.x * b.x + b.z * b.z, 0.05 * (1 + a.x * a.x + a.z * a.z));
        EXPECT_NEAR(a.y, b.y, 1e-4);
    }
    EXPECT_GT(max_distance, 5);
}

TEST(Queries, StopWhenTheCallbackReturnsFalse) {
    const QueryOptions options = small();
    int calls = 0;
    const auto rows =
        measure_queries(static_boxes(options.counts), options,
                        [&](std::uint64_t, std::uint64_t, std::string_view, std::string_view) { return ++calls < 4; });
    ASSERT_TRUE(rows);
    EXPECT_TRUE(rows->empty());
    EXPECT_EQ(calls, 4);
}

class Levels : public testing::Test {
protected:
    std::filesystem::path path = std::filesystem::temp_directory_path() / "fase_queries_test.obj";
    ~Levels() override { std::filesystem::remove(path); }
    Result<QueryScene> read(const std::string& text) const {
        std::ofstream(path) << text;
        return level_from(path.string(), {.rays = 1, .boxes = 1, .frusta = 1});
    }
};

TEST_F(Levels, AreReadFromObjFiles) {
    const auto level = read("# a square\no one\nv 0 0 0\r\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1/1/1 2//2 3 4\nf -4 -3 -2\n");
    ASSERT_TRUE(level) << level.error().text();
    EXPECT_EQ(level->mesh.indices, (std::vector<std::uint32_t>{0, 1, 2, 0, 2, 3, 0, 1, 2}));
    ASSERT_EQ(level->boxes.size(), 3u);
    EXPECT_EQ(level->boxes[1].box, (Aabb{{0, 0, 0}, {1, 0, 1}}));
}

TEST_F(Levels, AreRefusedWithTheLineNumber) {
    for (const char* const text :
         {"v 0 0\n", "v 0 0 0\nf 1 1 2\n", "v 0 0 0\nf 1 1\n", "v 1 2 nan\n", "v 0 0 0\nf 0 1 1\n"}) {
        const auto level = read(text);
        ASSERT_FALSE(level) << text;
        EXPECT_EQ(level.error().status, Status::Format);
        EXPECT_NE(level.error().where.find(".obj:"), std::string::npos) << level.error().text();
    }
    EXPECT_FALSE(read("v 0 0 0\n"));
    EXPECT_EQ(level_from("/no/such/file.obj", {}).error().status, Status::Io);
}

}  // namespace
}  // namespace fase::bench
