#include "fase/pairs/pair_finder.hpp"
#include "fase/broad/registry.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/conformance/scenes.hpp"

namespace fase::pairs {

using namespace broad;
namespace {

using conformance::Scene;

/// All overlapping pairs, except those of two static boxes, by brute force.
std::vector<Pair> expected_pairs(const std::vector<Aabb>& boxes, const std::vector<MotionState>& motion_states) {
    std::vector<Pair> pairs;
    for (Proxy p = 0; p < boxes.size(); ++p)
        for (Proxy q = p + 1; q < boxes.size(); ++q) {
            const bool both_static = motion_states[p] == MotionState::Static && motion_states[q] == MotionState::Static;
            if (!both_static && overlaps(boxes[p], boxes[q])) pairs.push_back({p, q});
        }
    return pairs;
}
std::vector<Pair> pairs_of(const PairFinder& finder, TaskRunner& tasks) {
    std::vector<Pair> pairs;
    finder.find_pairs(tasks, pairs);
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

class EveryStructure : public ::testing::TestWithParam<std::string> {
protected:
    PairFinder finder{*AnyStructure::named(GetParam())};
    std::unique_ptr<TaskRunner> serial = make_serial_runner(), four = make_thread_runner(4);
};

std::vector<std::string> structure_names() {
    std::vector<std::string> names;
    for_each_structure([&]<Structure S>() { names.emplace_back(S::info.name); });
    return names;
}
INSTANTIATE_TEST_SUITE_P(PairFinder, EveryStructure, ::testing::ValuesIn(structure_names()),
                         [](const auto& name) { return name.param; });

TEST_P(EveryStructure, FindsTheSamePairsAsBruteForceInEachFrameOfEachScene) {
    constexpr std::size_t count = 120;
    constexpr int frames = 12;
    for (const Scene& scene : conformance::all_scenes()) {
        SCOPED_TRACE(scene.name);
        Random random(3);
        std::vector<Aabb> boxes;
        std::vector<MotionState> motion_states;
        for (std::size_t i = 0; i < count; ++i) {
            boxes.push_back(scene.draw(random));
            motion_states.push_back(static_cast<MotionState>(random.below(3)));
        }
        finder.build(*four, boxes, motion_states);
        for (int frame = 0; frame < frames; ++frame) {
            ASSERT_EQ(finder.broken_invariant(), "") << frame;
            const std::vector<Pair> expected = expected_pairs(boxes, motion_states);
            ASSERT_TRUE(pairs_of(finder, *serial) == expected) << frame;
            ASSERT_TRUE(pairs_of(finder, *four) == expected) << frame;
            // Some asleep boxes move in every third frame, some static boxes in every fifth.
            for (Proxy p = 0; p < count; ++p) {
                const MotionState motion_state = finder.motion_state(p);
                const bool moves = motion_state == MotionState::Awake    ? random.below(2) == 0
                                   : motion_state == MotionState::Asleep ? frame % 3 == 0 && random.below(9) == 0
                                                                         : frame % 5 == 0 && random.below(9) == 0;
                if (moves) boxes[p] = scene.draw(random);
            }
            finder.update(*serial, boxes);
        }
    }
}

TEST_P(EveryStructure, FindsThePairsOfManyBoxesInParallel) {
    Random random(5);
    std::vector<Aabb> boxes;
    std::vector<MotionState> motion_states;
    for (std::size_t i = 0; i < 4000; ++i) {
        boxes.push_back(conformance::box_around(conformance::point_in(random, 0, 20), {0.5f, 0.5f, 0.5f}));
        motion_states.push_back(static_cast<MotionState>(random.below(3)));
    }
    finder.build(*four, boxes, motion_states);
    EXPECT_TRUE(pairs_of(finder, *four) == expected_pairs(boxes, motion_states));
    EXPECT_TRUE(pairs_of(finder, *serial) == expected_pairs(boxes, motion_states));
}

/// Frames in which all boxes move or few move; boxes that are removed, added and infinite; lists that grow.
TEST(PairFinder, EntersAndLeavesFrameMode) {
    const auto serial = make_serial_runner(), three_threads = make_thread_runner(3);
    for (const bool automatic : {false, true}) {
        Random random(15);
        const auto draw = [&] {
            return conformance::box_around(conformance::point_in(random, 0, 14), {0.4f, 0.5f, 0.6f});
        };
        std::vector<Aabb> boxes(1300);
        for (Aabb& box : boxes) box = draw();
        std::vector<MotionState> motion_states(boxes.size(), MotionState::Awake);
        PairFinder finder = automatic ? PairFinder::automatic() : PairFinder();
        finder.build(*serial, boxes, motion_states);
        std::size_t frames_without_structure = 0;
        const auto check = [&](const char* what) {
            SCOPED_TRACE(what);
            ASSERT_EQ(finder.broken_invariant(), "");
            std::vector<Pair> expected = expected_pairs(boxes, motion_states);
            std::erase_if(expected, [&](Pair pair) { return boxes[pair.a] == Aabb{} || boxes[pair.b] == Aabb{}; });
            ASSERT_TRUE(pairs_of(finder, *three_threads) == expected);
            const auto present_count =
                boxes.size() - static_cast<std::size_t>(std::count(boxes.begin(), boxes.end(), Aabb{}));
            ASSERT_EQ(finder.awake(), present_count);
            ASSERT_EQ(finder.stats().boxes, present_count);
            frames_without_structure += finder.stats().bytes < 80 * boxes.size() ? 1 : 0;
        };
        const auto frame = [&](const char* what, std::uint32_t one_in) {
            for (Aabb& box : boxes)
                if (random.below(one_in) == 0 && !(box == Aabb{})) box = draw();
            finder.update(*three_threads, boxes);
            check(what);
        };
        for (int iteration = 0; iteration < 2; ++iteration) {
            for (int k = 0; k < 3; ++k) frame("all move", 1);
            for (int k = 0; k < 3; ++k) frame("few move", 40);
            for (int k = 0; k < 70; ++k) finder.update(*serial, boxes);
            for (int k = 0; k < 2; ++k) frame("all move again", 1);
            boxes[7] = Aabb::everything();
            frame("all move, one becomes infinite", 1);
            boxes[7] = Aabb::everything();
            finder.update(*serial, boxes);
            check("one is infinite");
            for (int k = 0; k < 70; ++k) frame("all move, none is infinite", k < 68 ? 400 : 1);
            boxes[9] = Aabb{};
            frame("all move, one is removed", 1);
            boxes[9] = draw();
            frame("all move, it is added again", 1);
            boxes.push_back(draw());
            motion_states.push_back(MotionState::Awake);
            frame("all move, one more", 1);
            for (int k = 0; k < 70; ++k) frame("few move for many frames", k < 68 ? 400 : 1);
            // The caller writes the boxes in place.
            for (const std::uint32_t one_in : {1u, 1u, 3u, 1u}) {
                std::vector<Proxy> changed;
                for (Proxy p = 0; p < boxes.size(); ++p) {
                    if (random.below(one_in) == 0) {
                        boxes[p] = draw();
                        changed.push_back(p);
                    }
                }
                const std::span<Aabb> stored = finder.writable_boxes();
                std::copy(boxes.begin(), boxes.end(), stored.begin());
                finder.update_changed(*three_threads, changed);
                check("written in place");
            }
            for (int k = 0; k < 66; ++k) finder.update_changed(*serial, {});
        }
        EXPECT_GT(frames_without_structure, 10u) << "the test must reach frame mode";
    }
}

TEST_P(EveryStructure, WakesAnAsleepBoxThatChanges) {
    const auto cube = [](float x) { return Aabb{{x, 0, 0}, {x + 1, 1, 1}}; };
    std::vector<Aabb> boxes{cube(0), cube(0.5f), cube(1), cube(9)};
    const std::vector<MotionState> motion_states{MotionState::Static, MotionState::Asleep, MotionState::Asleep,
                                                 MotionState::Awake};
    finder.build(*serial, boxes, motion_states);
    EXPECT_EQ(finder.awake(), 1u);
    EXPECT_EQ(finder.resting_pairs().size(), 3u);
    finder.update(*serial, boxes);
    EXPECT_EQ(finder.awake(), 1u) << "nothing has moved";
    boxes[2] = cube(1.5f);
    finder.update(*serial, boxes);
    EXPECT_EQ(finder.awake(), 2u);
    EXPECT_EQ(finder.motion_state(2), MotionState::Awake);
    EXPECT_EQ(finder.resting_pairs().size(), 1u);
    EXPECT_EQ(pairs_of(finder, *serial), (std::vector<Pair>{{0, 1}, {1, 2}}));
    finder.update(*serial, boxes);
    EXPECT_EQ(finder.motion_state(2), MotionState::Awake) << "it stays awake";
}

TEST_P(EveryStructure, AcceptsAListOfChangedBoxes) {
    Random random(11);
    const auto draw = [&] {
        return random.below(9) == 0 ? Aabb{}
                                    : conformance::box_around(conformance::point_in(random, 0, 8), {0.5f, 0.5f, 0.5f});
    };
    std::vector<Aabb> boxes;
    std::vector<MotionState> motion_states;
    for (std::size_t i = 0; i < 200; ++i) {
        boxes.push_back(draw());
        motion_states.push_back(static_cast<MotionState>(random.below(3)));
    }
    PairFinder notified(*AnyStructure::named(GetParam()));
    finder.build(*serial, boxes, motion_states);
    notified.build(*serial, boxes, motion_states);
    for (int frame = 0; frame < 12; ++frame) {
        std::vector<Proxy> changed;
        for (Proxy p = 0; p < boxes.size(); ++p) {
            if (random.below(4) != 0) continue;
            const Aabb box = draw();
            if (box == boxes[p]) continue;
            boxes[p] = notified.writable_boxes()[p] = box;
            changed.push_back(p);
        }
        finder.update(*serial, boxes);
        notified.update_changed(*serial, changed);
        ASSERT_EQ(notified.broken_invariant(), "") << frame;
        ASSERT_EQ(pairs_of(notified, *serial), pairs_of(finder, *serial)) << frame;
        for (Proxy p = 0; p < boxes.size(); ++p) ASSERT_EQ(notified.motion_state(p), finder.motion_state(p)) << frame;
    }
    notified.update_changed(*serial, std::vector<Proxy>{3});  // counts as changed although it is equal
    EXPECT_NE(notified.motion_state(3), MotionState::Asleep);
    EXPECT_EQ(notified.broken_invariant(), "");
}

TEST_P(EveryStructure, FindsAllPairsWhenAllMoveFewMoveOrSomeAreRemoved) {
    // Boxes that were sorted in frame mode must be inserted into the structures when fewer boxes move.
    Random random(12);
    std::vector<Aabb> boxes;
    for (int i = 0; i < 1100; ++i)
        boxes.push_back(conformance::box_around(conformance::point_in(random, 0, 20), {0.5f, 0.5f, 0.5f}));
    const std::vector<MotionState> motion_states(boxes.size(), MotionState::Awake);
    PairFinder notified(*AnyStructure::named(GetParam()));
    finder.build(*serial, boxes, motion_states);
    notified.build(*serial, boxes, motion_states);
    for (int frame = 0; frame < 15; ++frame) {
        std::vector<Proxy> changed;
        for (Proxy p = 0; p < boxes.size(); ++p) {
            const bool all_move = frame < 3 || (frame > 5 && frame < 8) || frame > 11;
            if (!all_move && random.below(50) != 0) continue;
            const Vec3 shift{random.between(-0.3f, 0.3f), random.between(-0.3f, 0.3f), random.between(-0.3f, 0.3f)};
            boxes[p] = {boxes[p].lo + shift, boxes[p].hi + shift};
            if (frame == 8 && random.below(2) == 0) boxes[p] = {};
            if (frame == 11 || (boxes[p].lo.x == Aabb{}.lo.x && frame > 8))
                boxes[p] = conformance::box_around(conformance::point_in(random, 0, 20), {0.5f, 0.5f, 0.5f});
            notified.writable_boxes()[p] = boxes[p];
            changed.push_back(p);
        }
        finder.update(*serial, boxes);
        notified.update_changed(*four, changed);
        ASSERT_EQ(notified.broken_invariant(), "") << frame;
        ASSERT_EQ(pairs_of(notified, *serial), expected_pairs(boxes, motion_states)) << frame;
        ASSERT_EQ(pairs_of(notified, *serial), pairs_of(finder, *serial)) << frame;
    }
}

TEST_P(EveryStructure, KeepsThePairsIfNoBoxChanges) {
    Random random(14);
    for (const std::size_t count : {60u, 1200u}) {
        std::vector<Aabb> boxes;
        std::vector<MotionState> motion_states;
        for (std::size_t i = 0; i < count; ++i) {
            const float world = count < 100 ? 6 : 20;
            boxes.push_back(conformance::box_around(conformance::point_in(random, 0, world), {0.5f, 0.5f, 0.5f}));
            motion_states.push_back(i % 7 == 0   ? MotionState::Static
                                    : i % 5 == 0 ? MotionState::Asleep
                                                 : MotionState::Awake);
        }
        finder.build(*serial, boxes, motion_states);
        for (int frame = 0; frame < 24; ++frame) {
            const std::uint64_t movers = frame % 3 != 0 ? 0 : frame % 2 == 0 ? 2 : count;
            for (std::uint64_t k = 0; k < movers; ++k) {
                const std::size_t p = movers == count ? k : random.below(count);
                boxes[p] = conformance::box_around(conformance::point_in(random, 0, 20), {0.5f, 0.5f, 0.5f});
                if (motion_states[p] == MotionState::Asleep) motion_states[p] = MotionState::Awake;
            }
            if (frame == 13) boxes.push_back(boxes[1]), motion_states.push_back(MotionState::Awake);
            if (frame == 19) finder.build(*four, boxes, motion_states);
            finder.update(frame % 2 == 0 ? *serial : *four, boxes);
            ASSERT_EQ(finder.broken_invariant(), "") << frame;
            ASSERT_EQ(pairs_of(finder, *serial), expected_pairs(boxes, motion_states)) << frame;
        }
    }
}

TEST_P(EveryStructure, CanBeRebuiltAndCanBeEmpty) {
    finder.build(*serial, {}, {});
    finder.update(*serial, {});
    EXPECT_TRUE(pairs_of(finder, *four).empty());
    const std::vector<Aabb> two(2, Aabb{{0, 0, 0}, {1, 1, 1}});
    finder.build(*serial, two, std::vector<MotionState>(2, MotionState::Asleep));
    EXPECT_EQ(pairs_of(finder, *serial).size(), 1u);
    finder.build(*serial, two, std::vector<MotionState>(2, MotionState::Static));
    EXPECT_EQ(pairs_of(finder, *serial).size(), 0u);
}

TEST_P(EveryStructure, TreatsAnEmptyBoxAsAbsent) {
    Random random(6);
    std::vector<Aabb> boxes;
    std::vector<MotionState> motion_states;
    const auto draw = [&] {
        return random.below(40) == 0 ? Aabb::everything()
                                     : conformance::box_around(conformance::point_in(random, 0, 8), {0.5f, 0.5f, 0.5f});
    };
    const auto expected_present_pairs = [&] {  // without pairs of infinite and absent boxes
        std::vector<Pair> pairs = expected_pairs(boxes, motion_states);
        std::erase_if(pairs, [&](Pair pair) { return boxes[pair.a] == Aabb{} || boxes[pair.b] == Aabb{}; });
        return pairs;
    };
    for (std::size_t i = 0; i < 200; ++i) {
        boxes.push_back(random.below(4) == 0 ? Aabb{} : draw());
        motion_states.push_back(static_cast<MotionState>(random.below(3)));
    }
    finder.build(*serial, boxes, motion_states);
    for (int frame = 0; frame < 40; ++frame) {
        ASSERT_EQ(finder.broken_invariant(), "") << frame;
        ASSERT_TRUE(pairs_of(finder, *serial) == expected_present_pairs()) << frame;
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            EXPECT_EQ(finder.motion_state(static_cast<Proxy>(i)) == MotionState::Absent, boxes[i] == Aabb{});
            if (random.below(frame % 7 == 0 ? 2 : 20) == 0) boxes[i] = random.below(3) == 0 ? Aabb{} : draw();
        }
        boxes.push_back(draw());
        motion_states.push_back(MotionState::Awake);
        finder.update(*serial, boxes);
    }
}

TEST_P(EveryStructure, KeepsTheRestingPairsOfUnchangedBoxes) {
    const auto cube = [](float x) { return Aabb{{x, 0, 0}, {x + 1, 1, 1}}; };
    std::vector<Aabb> boxes;
    for (int i = 0; i < 100; ++i) boxes.push_back(cube(0.75f * static_cast<float>(i)));
    finder.build(*serial, boxes, std::vector<MotionState>(100, MotionState::Asleep));
    EXPECT_EQ(finder.resting_pairs().size(), 99u);
    boxes[50].hi.y = 2;
    finder.update(*serial, boxes);
    EXPECT_EQ(finder.resting_pairs().size(), 97u);
    boxes[10] = {};
    finder.update(*serial, boxes);
    EXPECT_EQ(finder.resting_pairs().size(), 95u);
    EXPECT_EQ(pairs_of(finder, *serial).size(), 97u);
    for (Aabb& box : boxes) box = {box.lo + Vec3{0, 1, 0}, box.hi + Vec3{0, 1, 0}};
    boxes[10] = cube(7.5f);
    finder.update(*serial, boxes);
    EXPECT_EQ(finder.resting_pairs().size(), 0u);
    EXPECT_EQ(finder.awake(), 100u);
}

}  // namespace
}  // namespace fase::pairs
