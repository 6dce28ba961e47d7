#include "bench/sudden.hpp"

#include <gtest/gtest.h>

#include <set>

namespace fase::bench {
namespace {

const SuddenProgress go_on = [](std::uint64_t, std::uint64_t, std::string_view) { return true; };

TEST(Sudden, EveryStructureFindsTheRightPairsInEveryEvent) {
    const auto rows = measure_sudden({.boxes = 6000, .frames = 6, .structures = "auto,row_grid,octree"}, go_on);
    ASSERT_TRUE(rows) << rows.error().text();
    std::set<std::string> events;
    for (const SuddenRow& row : *rows) {
        EXPECT_TRUE(row.correct) << row.event << " " << row.structure;
        EXPECT_EQ(row.frames, 6u);
        EXPECT_GT(row.pairs, 0u);
        EXPECT_GE(row.ms.worst, row.ms.median);
        events.insert(row.event);
    }
    EXPECT_EQ(rows->size(), 3 * events.size());
    EXPECT_TRUE(events.contains("wall") && events.contains("wake"));
}

TEST(Sudden, RefusesFewBoxesAndUnknownStructures) {
    const auto few = measure_sudden({.boxes = 10}, go_on);
    ASSERT_FALSE(few);
    EXPECT_EQ(few.status(), Status::BadArgument);
    const auto unknown = measure_sudden({.structures = "row_grid,octopus"}, go_on);
    ASSERT_FALSE(unknown);
    EXPECT_NE(unknown.error().text().find("octopus"), std::string::npos);
}

TEST(Sudden, StopsWhenTheCallbackReturnsFalse) {
    int calls = 0;
    const auto rows = measure_sudden({.boxes = 5000, .frames = 5, .structures = "row_grid"},
                                     [&](std::uint64_t, std::uint64_t, std::string_view) { return ++calls < 15; });
    ASSERT_TRUE(rows);
    EXPECT_EQ(rows->size(), 1u) << "the first event is finished";
}

}  // namespace
}  // namespace fase::bench
