#include "bench/index.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "fase/core/random.hpp"
#include "fase/query/detail/near_pairs.hpp"

namespace fase::bench {
namespace {

const IndexProgress do_not_stop = [](std::uint64_t, std::uint64_t, std::string_view) { return true; };

TEST(BenchIndex, AllContendersFindTheSame) {
    for (const int threads : {1, 2}) {
        const auto rows = measure_index({.units = 3000, .rounds = 2, .threads = threads}, do_not_stop);
        ASSERT_TRUE(rows) << rows.error().text();
        std::set<std::string> contenders;
        std::map<std::string, std::set<std::uint64_t>> found;
        for (const IndexRow& row : *rows) {
            const std::string at = row.contender + " " + row.question;
            contenders.insert(row.contender);
            EXPECT_EQ(row.differ, 0u) << at;
            EXPECT_GE(row.worst_ms, row.median_ms) << at;
            if (row.question == "moves" || row.question == "frame") continue;
            EXPECT_GT(row.compared, 0u) << at;
            EXPECT_GT(row.found, 0u) << at;
            found[row.question].insert(row.found);
        }
        EXPECT_EQ(contenders.size(), index_contenders().size());
        EXPECT_EQ(found.size(), index_questions - 2);
        for (const auto& [question, counts] : found) EXPECT_EQ(counts.size(), 1u) << question;
        EXPECT_EQ(found["neighbours"], found["neighbours_moved"]);
        EXPECT_GT(*found["grown_pairs"].begin(), *found["neighbours"].begin()) << "corners are farther";
    }
}

TEST(BenchIndex, ItsGridFindsWhatBruteForceFinds) {
    for (const float side : {3.0f, 60.0f}) {
        Random random(4);
        std::vector<Unit> units;
        for (int i = 0; i < 200; ++i) units.push_back({random.between(0, side), 1, random.between(0, side), i});
        const auto grid = make_flat_grid({side, 5, nullptr});
        grid->move(units);
        Tally near, grown, inside, expected_near, expected_grown, expected_inside;
        const std::vector<Aabb> rectangles{{{-9, -9, -9}, {10, 9, 10}}, {{20, 0, 30}, {50, 9, 35}}};
        grid->neighbours(5, near);
        grid->grown_pairs(5, grown);
        grid->rectangles(rectangles, inside);
        for (std::uint32_t a = 0; a < units.size(); ++a) {
            const Aabb box = box_of(units[a]);
            for (const Aabb& rectangle : rectangles)
                if (overlaps(rectangle, box)) expected_inside.add(a);
            for (std::uint32_t b = 0; b < a; ++b) {
                const Aabb other = box_of(units[b]);
                if (query::squared_distance(box, other) <= 25) expected_near.add(b, a);
                const Vec3 half{2.5f, 2.5f, 2.5f};
                if (overlaps({box.lo - half, box.hi + half}, {other.lo - half, other.hi + half}))
                    expected_grown.add(a, b);
            }
        }
        EXPECT_EQ(near, expected_near);
        EXPECT_EQ(grown, expected_grown);
        EXPECT_EQ(inside, expected_inside);
        EXPECT_GT(inside.count, 0u);
    }
}

TEST(BenchIndex, RefusesUnknownContenders) {
    const auto rows = measure_index({.units = 10, .contender = "index,abacus"}, do_not_stop);
    ASSERT_FALSE(rows);
    EXPECT_EQ(rows.status(), Status::BadArgument);
    EXPECT_NE(rows.error().text().find("abacus"), std::string::npos);
}

TEST(BenchIndex, WorksWithASingleUnit) {
    const auto rows = measure_index({.units = 1, .rounds = 1}, do_not_stop);
    ASSERT_TRUE(rows);
    for (const IndexRow& row : *rows) EXPECT_EQ(row.differ, 0u) << row.contender << " " << row.question;
}

TEST(BenchIndex, StopsWhenTheCallbackReturnsFalse) {
    const auto rows =
        measure_index({.units = 10}, [](std::uint64_t done, std::uint64_t, std::string_view) { return done < 3; });
    ASSERT_TRUE(rows);
    EXPECT_TRUE(rows->empty());
}

}  // namespace
}  // namespace fase::bench
