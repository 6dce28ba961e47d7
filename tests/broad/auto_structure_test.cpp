#include "fase/broad/auto_structure.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "fase/broad/registry.hpp"
#include "fase/pairs/pair_finder.hpp"
#include "tests/conformance/scenes.hpp"

namespace fase::broad {
namespace {

std::vector<Move> row_of(std::size_t count, float every_tenth = 1) {
    std::vector<Move> boxes;
    for (Proxy p = 0; p < count; ++p) {
        const auto x = static_cast<float>(p) * 0.9f;
        const float size = p % 10 == 0 ? every_tenth : 1;
        boxes.push_back({p, {{x, 0, 0}, {x + size, size, size}}});
    }
    return boxes;
}

AnyStructure filled(std::string_view name, std::span<const Move> boxes) {
    AnyStructure structure = *AnyStructure::named(name);
    structure.build(boxes);
    return structure;
}

TEST(AutoStructure, ChoosesBruteForceForFewAndRowGridForManyBoxes) {
    EXPECT_EQ(choose_structure({10}, {}), "brute_force");
    EXPECT_EQ(choose_structure({10000}, {}), "row_grid");
    EXPECT_EQ(choose_structure({.boxes = 4, .use = BoxUse::AnswersQueries}, {}), "brute_force");
    EXPECT_EQ(choose_structure({.boxes = 100, .use = BoxUse::AnswersQueries}, {}), "wide_bvh");
    EXPECT_EQ(choose_structure({.boxes = 10000, .use = BoxUse::AnswersQueries}, {}), "wide_bvh");
    EXPECT_NE(choice_reason("wide_bvh"), choice_reason("row_grid"));
    EXPECT_NE(choice_reason("brute_force"), choice_reason("row_grid"));
    EXPECT_TRUE(choice_reason("octree").empty());
    for (const BoxUse use : {BoxUse::FindsPairs, BoxUse::IsQueried})
        for (const bool flat : {false, true})
            for (const float spread : {1.0f, 100.0f, Aabb::infinity}) {  // never back to brute force as the count grows
                bool sorts = false;
                for (std::size_t n = 0; n < 1000; ++n) {
                    const bool now = choose_structure({n, spread, flat, use}, {}) == "row_grid";
                    EXPECT_TRUE(now || !sorts) << n;
                    sorts = now;
                }
                EXPECT_TRUE(sorts);
            }
}

TEST(AutoStructure, HasHysteresis) {
    // A count that varies by a tenth changes the structure at most once.
    for (const BoxUse use : {BoxUse::FindsPairs, BoxUse::IsQueried}) {
        for (std::size_t middle = 20; middle < 1000; middle += 5) {
            std::string_view current = choose_structure({.boxes = middle, .use = use}, {});
            int changes = 0;
            for (int i = 0; i < 10; ++i) {
                const std::size_t n = i % 2 == 0 ? middle * 10 / 11 : middle * 11 / 10;
                const std::string_view next = choose_structure({.boxes = n, .use = use}, current);
                changes += next != current ? 1 : 0;
                current = next;
            }
            EXPECT_LE(changes, middle < 90 || middle > 470 ? 0 : 1) << middle;
        }
    }
}

TEST(AutoStructure, InspectsSizesAndPositionsWhereTheyMatter) {
    AnyStructure equal = filled("brute_force", row_of(100)), mixed = filled("brute_force", row_of(100, 9));
    update_auto_structure(equal, BoxUse::FindsPairs);
    EXPECT_EQ(equal.info().name, "brute_force") << "without inspect_sizes";
    update_auto_structure(equal, BoxUse::IsQueried, true);
    EXPECT_EQ(equal.info().name, "brute_force") << "few for a queried set";
    update_auto_structure(equal, BoxUse::FindsPairs, true);
    update_auto_structure(mixed, BoxUse::FindsPairs, true);
    EXPECT_EQ(equal.info().name, "row_grid");
    EXPECT_EQ(mixed.info().name, "brute_force");
    std::vector<Move> lattice;
    for (Proxy p = 0; p < 100; ++p)
        lattice.push_back({p, {{float(p % 5) * 2, float(p / 5 % 5) * 2, float(p / 25) * 2}, {}}});
    for (Move& m : lattice) m.box.hi = m.box.lo + Vec3{1, 1, 1};
    EXPECT_FALSE(statistics_of(lattice, BoxUse::FindsPairs).flat);
    EXPECT_TRUE(statistics_of(row_of(100), BoxUse::FindsPairs).flat);
    EXPECT_FLOAT_EQ(statistics_of(row_of(100, 9), BoxUse::FindsPairs).size_spread, 9);
}

TEST(AutoStructure, ConvertsEveryStructureToEveryOther) {
    for_each_structure([]<Structure From>() {
        for_each_structure([]<Structure To>() {
            std::vector<Move> boxes = row_of(40);
            constexpr float nan = std::numeric_limits<float>::quiet_NaN();
            boxes.push_back({50, Aabb::everything()});
            boxes.push_back({61, {{nan, 0, 0}, {1, 1, 1}}});
            AnyStructure structure = filled(From::info.name, boxes);
            const std::vector<Proxy> sleeping{3, 4, 5, 50};
            structure.set_awake(sleeping, false);
            const std::vector<Proxy> erased{7};
            structure.erase(erased);  // not committed yet
            structure.convert_to(*AnyStructure::named(To::info.name));
            EXPECT_EQ(structure.info().name, To::info.name);
            EXPECT_EQ(structure.size(), boxes.size() - 1);
            EXPECT_EQ(structure.broken_invariant(), "");
            for (const Proxy p : sleeping) EXPECT_FALSE(structure.is_awake(p));
            EXPECT_TRUE(structure.is_awake(6));
            std::vector<Pair> pairs;
            structure.find_awake_pairs(pairs);
            std::sort(pairs.begin(), pairs.end());
            EXPECT_EQ(std::count(pairs.begin(), pairs.end(), Pair{3, 4}), 0);
            EXPECT_EQ(std::count(pairs.begin(), pairs.end(), Pair{5, 6}), 1);
            EXPECT_EQ(std::count(pairs.begin(), pairs.end(), Pair{8, 50}), 1);
        });
    });
}

TEST(AutoStructure, ConvertsWhenAllBoxesWakeInOneFrame) {
    // All boxes but one sleep, then all wake in one frame: the awake set was brute force.
    std::vector<Aabb> boxes;
    for (const Move& m : row_of(5000)) boxes.push_back(m.box);
    std::vector<MotionState> motion_states(boxes.size(), MotionState::Asleep);
    motion_states[0] = MotionState::Awake;
    const auto tasks = make_serial_runner();
    pairs::PairFinder finder = pairs::PairFinder::automatic();
    finder.build(*tasks, boxes, motion_states);
    EXPECT_EQ(finder.chosen(MotionState::Awake).structure, "brute_force");
    EXPECT_EQ(finder.chosen(MotionState::Asleep).structure, "row_grid");
    EXPECT_FALSE(finder.chosen(MotionState::Awake).reason.empty());
    for (Aabb& box : boxes) box.hi.y += 1;
    finder.update(*tasks, boxes);
    EXPECT_EQ(finder.awake(), boxes.size());
    EXPECT_EQ(finder.chosen(MotionState::Awake).structure, "row_grid");
    EXPECT_EQ(finder.chosen(MotionState::Asleep).structure, "brute_force");
    std::vector<Pair> pairs;
    finder.find_pairs(*tasks, pairs);
    EXPECT_EQ(pairs.size(), boxes.size() - 1);
    EXPECT_EQ(finder.broken_invariant(), "");
    EXPECT_TRUE(pairs::PairFinder().chosen(MotionState::Awake).reason.empty()) << "named by the user";
}

}  // namespace
}  // namespace fase::broad
