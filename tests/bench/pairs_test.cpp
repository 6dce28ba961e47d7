/// Every broad phase of the list finds the same pairs.
#include "bench/pairs.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>

#include "bench/pair_engine.hpp"
#include "fase/broad/any_structure.hpp"
#include "fase/core/random.hpp"
#include "fase/record/trace.hpp"

namespace fase::bench {
namespace {

/// Writes a trace of moving, static and sleeping boxes on a coarse grid, so that many touch exactly.
std::string write_trace(const char* name) {
    const auto file = (std::filesystem::path(testing::TempDir()) / name).string();
    std::filesystem::remove(file);
    constexpr std::size_t count = 700;
    Random random(4);
    const auto integer = [&](std::uint64_t below) { return static_cast<float>(random.below(below)); };
    std::vector<Aabb> boxes;
    std::vector<Vec3> velocities;
    std::vector<std::uint8_t> flags;
    for (std::size_t i = 0; i < count; ++i) {
        const float x = integer(40), y = integer(40), z = integer(40);
        const Vec3 lo = Vec3{x, y, z} * 0.25f, sides = Vec3{1 + integer(3), 1 + integer(3), 1 + integer(3)} * 0.25f;
        boxes.push_back({lo, lo + sides});
        flags.push_back(i % 7 == 0 ? record::trace_static : i % 5 == 0 ? record::trace_asleep : 0);
        const float speed = flags.back() == 0 ? 0.25f : 0;
        velocities.push_back(Vec3{integer(3) - 1, integer(3) - 1, integer(3) - 1} * speed);
    }
    Result<record::TraceWriter> writer = record::TraceWriter::create(file, count);
    EXPECT_TRUE(writer);
    for (int frame = 0; frame < 9; ++frame) {
        EXPECT_TRUE(writer->add_frame(boxes));
        for (std::size_t i = 0; i < count; ++i) boxes[i] = {boxes[i].lo + velocities[i], boxes[i].hi + velocities[i]};
    }
    EXPECT_TRUE(writer->finish(flags));
    return file;
}

const PairBenchProgress never_stop = [](std::uint64_t, std::uint64_t, std::string_view, std::string_view) {
    return true;
};

TEST(BenchPairs, EveryEngineFindsThePairsOfTheFirstEngine) {
    const std::string file = write_trace("bench_pairs_all.aabt");
    PairBenchOptions options;
    options.engine = "all";
    const auto rows = measure_pair_engines(file, options, never_stop);
    ASSERT_TRUE(rows) << rows.error().text();
    ASSERT_EQ(rows->size(), pair_engines().size());
    for (const PairBenchRow& row : *rows) {
        // A peer may miss pairs of boxes that only touch; then its row says so.
        EXPECT_EQ(row.correct, row.hash == rows->front().hash) << row.engine;
        if (broad::AnyStructure::named(row.engine)) {
            EXPECT_TRUE(row.correct) << row.engine;
        }
        EXPECT_EQ(row.frames, 8u) << row.engine;
        EXPECT_GT(row.pairs, 100u);
        EXPECT_FALSE(row.settings.empty());
        EXPECT_LE(row.low, row.ms.median);
        EXPECT_LE(row.ms.median, row.high);
        EXPECT_LE(row.high, row.ms.worst);
    }
}

TEST(BenchPairs, SlowEnginesStopAtTheLimit) {
    const std::string file = write_trace("bench_pairs_slow.aabt");
    PairBenchOptions options;
    options.engine = "brute_force,row_grid";
    options.limit = 1e-9;
    const auto rows = measure_pair_engines(file, options, never_stop);
    ASSERT_TRUE(rows);
    ASSERT_EQ(rows->size(), 2u);
    EXPECT_EQ(rows->front().frames, 5u);  // one turn without its first frame
}

TEST(BenchPairs, RefusesUnknownNames) {
    const std::string file = write_trace("bench_pairs_names.aabt");
    PairBenchOptions options;
    options.engine = "row_grid,quick_grid";
    const auto rows = measure_pair_engines(file, options, never_stop);
    ASSERT_FALSE(rows);
    EXPECT_EQ(rows.error().status, Status::BadArgument);
    EXPECT_NE(rows.error().text().find("quick_grid"), std::string::npos);
}

}  // namespace
}  // namespace fase::bench
