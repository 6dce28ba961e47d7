#include "fase/pairs/pair_tracker.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "fase/core/random.hpp"

namespace fase::pairs {
namespace {

using broad::AnyStructure;
using broad::Pair;
using Pairs = std::vector<Pair>;

Pairs sorted(std::span<const Pair> pairs) {
    Pairs out(pairs.begin(), pairs.end());
    std::sort(out.begin(), out.end());
    return out;
}

/// Every pair that overlaps, but those of two static boxes and of absent ones, by trying all.
Pairs tried(std::span<const Aabb> boxes, std::span<const MotionState> motion_states) {
    Pairs out;
    for (broad::Proxy p = 0; p < boxes.size(); ++p)
        for (broad::Proxy q = p + 1; q < boxes.size(); ++q)
            if (overlaps(boxes[p], boxes[q]) && boxes[p] != Aabb{} && boxes[q] != Aabb{} &&
                (motion_states[p] != MotionState::Static || motion_states[q] != MotionState::Static))
                out.push_back({p, q});
    return out;
}

Aabb box_at(Random& random, float size) {
    const Vec3 lo{random.between(-4, 4), random.between(-4, 4), random.between(-4, 4)};
    return {lo, lo + Vec3{random.between(0, size), random.between(0, size), random.between(0, size)}};
}

/// Any box, and now and then one that is endless, no box at all, or inside out.
Aabb unbounded_box(Random& random) {
    constexpr float inf = Aabb::infinity, nan = std::numeric_limits<float>::quiet_NaN();
    switch (random.below(12)) {
        case 0: return Aabb::everything();
        case 1: return {{-inf, -1, -inf}, {inf, 0, inf}};
        case 2: return {{nan, 0, 0}, {1, 1, 1}};
        case 3: return {{0, 0, 0}, {1, nan, 1}};
        case 4: return {{1, 1, 1}, {0, 0, 0}};
        case 5: return {{inf, inf, inf}, {inf, inf, inf}};
        default: return box_at(random, 2);
    }
}

struct Life {
    bool unbounded = false;
    bool goes = false;  // boxes go, and come again
    int threads = 1;
    std::string structure = "row_grid";
    std::size_t boxes = 60;
    int frames = 40;
};

/// Plays a random life to a tracker and to a PairSet.
void expect_told_right(const Life& life, std::uint64_t seed) {
    Random random(seed);
    std::vector<Aabb> boxes;
    std::vector<MotionState> motion_states;
    for (std::size_t i = 0; i < life.boxes; ++i) {
        boxes.push_back(life.unbounded ? unbounded_box(random) : box_at(random, 2));
        motion_states.push_back(static_cast<MotionState>(random.below(3)));
        if (life.goes && random.below(8) == 0) boxes.back() = {};
    }
    const auto tasks = make_thread_runner(life.threads);
    PairTracker tracker(*AnyStructure::named(life.structure));
    PairSet judge;
    Pairs all = sorted(tracker.build(*tasks, boxes, motion_states).begun);
    ASSERT_EQ(all, tried(boxes, motion_states));
    judge.update(all);
    for (int frame = 0; frame < life.frames; ++frame) {
        const bool static_moves = frame % 5 == 4, nothing_moves = frame % 11 > 7;
        for (std::size_t i = 0; i < boxes.size() && !nothing_moves; ++i) {
            const bool moves = motion_states[i] == MotionState::Awake    ? random.below(4) != 0
                               : motion_states[i] == MotionState::Asleep ? random.below(50) == 0
                                                                         : static_moves && random.below(20) == 0;
            if (!moves) continue;
            if (life.goes && random.below(8) == 0) {
                boxes[i] = {};
            } else if (life.unbounded && random.below(3) == 0) {
                boxes[i] = unbounded_box(random);
            } else if (random.below(6) == 0 || boxes[i] == Aabb{}) {
                boxes[i] = box_at(random, 2);
            } else {
                const Vec3 way{random.between(-0.2f, 0.2f), random.between(-0.2f, 0.2f), random.between(-0.2f, 0.2f)};
                boxes[i].lo += way;
                boxes[i].hi += way;
            }
        }
        const PairChanges told = tracker.update(*tasks, boxes);
        const Pairs now = tried(boxes, motion_states);
        const PairChanges right = judge.update(now);
        ASSERT_EQ(sorted(told.begun), sorted(right.begun)) << "frame " << frame;
        ASSERT_EQ(sorted(told.ended), sorted(right.ended)) << "frame " << frame;
        // Those of two that rest may be left out.
        const Pairs staying = sorted(told.staying);
        ASSERT_TRUE(std::includes(right.staying.begin(), right.staying.end(), staying.begin(), staying.end()));
        for (const Pair pair : right.staying)
            if (tracker.finder().motion_state(pair.a) == MotionState::Awake ||
                tracker.finder().motion_state(pair.b) == MotionState::Awake) {
                ASSERT_TRUE(std::binary_search(staying.begin(), staying.end(), pair)) << "frame " << frame;
            }
    }
}

TEST(PairTracker, TellsWhatAPairSetTellsOfAllPairs) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) expect_told_right({}, seed);
}

TEST(PairTracker, TellsOfEndlessMissingAndInvertedBoxes) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) expect_told_right({.unbounded = true}, seed);
}

TEST(PairTracker, TellsOfBoxesThatComeAndGo) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) expect_told_right({.goes = true}, seed);
    for (std::uint64_t seed = 1; seed <= 20; ++seed) expect_told_right({.unbounded = true, .goes = true}, seed);
}

TEST(PairTracker, TellsTheSameOnEveryStructureAndOnThreads) {
    broad::for_each_structure([]<broad::Structure S>() {
        expect_told_right({.unbounded = true, .goes = true, .threads = 2, .structure = std::string(S::info.name)}, 7);
    });
}

TEST(PairTracker, EndsThePairOfASleeperThatGoesFromWhatIsEverywhere) {
    // The box that is not there would overlap an endless one, taken by its numbers.
    std::vector<Aabb> boxes{Aabb::everything(), {{0, 0, 0}, {1, 1, 1}}};
    const std::vector<MotionState> motion_states{MotionState::Awake, MotionState::Asleep};
    const auto tasks = make_serial_runner();
    PairTracker tracker;
    EXPECT_EQ(tracker.build(*tasks, boxes, motion_states).begun.size(), 1u);
    boxes[1] = {};
    EXPECT_EQ(tracker.update(*tasks, boxes).ended.size(), 1u);
    EXPECT_TRUE(tracker.update(*tasks, boxes).staying.empty());
    boxes[1] = {{5, 0, 0}, {6, 1, 1}};
    EXPECT_EQ(tracker.update(*tasks, boxes).begun.size(), 1u);
}

TEST(PairTracker, WakesASleeperThatShrinksWithinItsPlace) {
    std::vector<Aabb> boxes{{{0, 0, 0}, {2, 1, 1}}, {{1.5f, 0, 0}, {3, 1, 1}}};
    const std::vector<MotionState> motion_states(2, MotionState::Asleep);
    const auto tasks = make_serial_runner();
    PairTracker tracker;
    EXPECT_EQ(tracker.build(*tasks, boxes, motion_states).begun.size(), 1u);
    boxes[0].hi.x = 1;
    EXPECT_EQ(tracker.update(*tasks, boxes).ended.size(), 1u);
    EXPECT_EQ(tracker.finder().motion_state(0), MotionState::Awake);
    EXPECT_TRUE(tracker.update(*tasks, boxes).ended.empty());
}

TEST(PairTracker, SharesManyPairsAmongThreads) {
    // 300 boxes in one place have 44,850 pairs: several portions.
    std::vector<Aabb> boxes(300, Aabb{{0, 0, 0}, {1, 1, 1}});
    const std::vector<MotionState> motion_states(boxes.size(), MotionState::Awake);
    Pairs before;
    for (const int threads : {2, 3, 4}) {
        const auto tasks = make_thread_runner(threads);
        PairTracker tracker;
        tracker.build(*tasks, boxes, motion_states);
        std::vector<Aabb> next = boxes;
        for (std::size_t i = 0; i < next.size(); i += 3) next[i].lo += Vec3{5, 0, 0}, next[i].hi += Vec3{5, 0, 0};
        const PairChanges told = tracker.update(*tasks, next);
        EXPECT_EQ(told.staying.size(), 200u * 199 / 2 + 100u * 99 / 2);
        EXPECT_EQ(told.ended.size(), 200u * 100);
        EXPECT_TRUE(told.begun.empty());
        const Pairs staying(told.staying.begin(), told.staying.end());
        if (!before.empty()) {
            EXPECT_EQ(staying, before) << "in another order on " << threads << " threads";
        }
        before = staying;
    }
}

TEST(PairTracker, FillsTheGapsOfWhatEndsAmongManyPairs) {
    // Boxes shrink to one side or the other of what they all span, so that pairs end here and there in the list, or in
    // long rows; or each to a side of its own, and none stays.
    const std::vector<MotionState> motion_states(500, MotionState::Awake);
    const std::vector<Aabb> together(motion_states.size(), Aabb{{0, 0, 0}, {1, 1, 1}});
    Random random(3);
    for (int kind = 0; kind < 4; ++kind) {
        std::vector<Aabb> apart = together;
        for (std::size_t i = 0; i < apart.size(); ++i) {
            const bool left = kind == 0 ? random.below(2) == 0 : kind == 1 ? random.below(50) == 0 : i < 200;
            apart[i].lo.x = left ? 0 : 0.6f;
            apart[i].hi.x = left ? 0.4f : 1;
            if (kind == 3) apart[i].lo.x = apart[i].hi.x = static_cast<float>(i) / 512;
        }
        PairSet judge;
        const Pairs all = tried(together, motion_states), left = tried(apart, motion_states);
        judge.update(all);
        const PairChanges right = judge.update(left);
        Pairs in_order;
        for (const int threads : {1, 2, 3}) {
            const auto tasks = make_thread_runner(threads);
            PairTracker tracker;
            tracker.build(*tasks, together, motion_states);
            const PairChanges told = tracker.update(*tasks, apart);
            ASSERT_EQ(sorted(told.staying), sorted(right.staying)) << "kind " << kind << ", " << threads << " threads";
            ASSERT_EQ(sorted(told.ended), sorted(right.ended)) << "kind " << kind << ", " << threads << " threads";
            ASSERT_TRUE(told.begun.empty());
            const Pairs staying(told.staying.begin(), told.staying.end());
            if (threads == 3) {
                ASSERT_EQ(staying, in_order) << "in another order on three threads";
            }
            in_order = staying;
        }
    }
}

TEST(PairTracker, SaysNothingOfAWorldAtRest) {
    std::vector<Aabb> boxes(50, Aabb{{0, 0, 0}, {1, 1, 1}});
    const std::vector<MotionState> motion_states(boxes.size(), MotionState::Asleep);
    const auto tasks = make_serial_runner();
    PairTracker tracker;
    EXPECT_EQ(tracker.build(*tasks, boxes, motion_states).begun.size(), 50u * 49 / 2);
    for (int i = 0; i < 3; ++i) {
        const PairChanges told = tracker.update(*tasks, boxes);
        EXPECT_TRUE(told.begun.empty() && told.ended.empty() && told.staying.empty());
    }
}

}  // namespace
}  // namespace fase::pairs
