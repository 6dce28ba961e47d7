#include "fase/pairs/pair_tracker.hpp"
#include "fase/broad/registry.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
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

/// All overlapping pairs, except those of two static boxes and of absent boxes, by brute force.
Pairs brute_force_pairs(std::span<const Aabb> boxes, std::span<const MotionState> motion_states) {
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

/// A random box; some are infinite, inverted or have a NaN.
Aabb irregular_box(Random& random) {
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

struct Scenario {
    bool irregular = false;
    bool removes_boxes = false;  // boxes are removed and added again
    int threads = 1;
    std::string structure = "row_grid";
    std::size_t boxes = 60;
    int frames = 40;
};

/// The reference: differences of sorted lists of pairs.
class SetDifference {
public:
    struct Changes {
        Pairs begun, staying, ended;
    };
    /// @param current sorted, without duplicates
    Changes update(const Pairs& current) {
        Changes changes;
        std::set_difference(current.begin(), current.end(), last_.begin(), last_.end(),
                            std::back_inserter(changes.begun));
        std::set_intersection(current.begin(), current.end(), last_.begin(), last_.end(),
                              std::back_inserter(changes.staying));
        std::set_difference(last_.begin(), last_.end(), current.begin(), current.end(),
                            std::back_inserter(changes.ended));
        last_ = current;
        return changes;
    }

private:
    Pairs last_;
};

/// Runs a random scenario with a tracker and the reference, and compares their changes.
void expect_correct_changes(const Scenario& scenario, std::uint64_t seed) {
    Random random(seed);
    std::vector<Aabb> boxes;
    std::vector<MotionState> motion_states;
    for (std::size_t i = 0; i < scenario.boxes; ++i) {
        boxes.push_back(scenario.irregular ? irregular_box(random) : box_at(random, 2));
        motion_states.push_back(static_cast<MotionState>(random.below(3)));
        if (scenario.removes_boxes && random.below(8) == 0) boxes.back() = {};
    }
    const auto tasks = make_thread_runner(scenario.threads);
    PairTracker tracker(*AnyStructure::named(scenario.structure));
    SetDifference reference;
    Pairs all = sorted(tracker.build(*tasks, boxes, motion_states).begun);
    ASSERT_EQ(all, brute_force_pairs(boxes, motion_states));
    reference.update(all);
    for (int frame = 0; frame < scenario.frames; ++frame) {
        const bool static_moves = frame % 5 == 4, nothing_moves = frame % 11 > 7;
        for (std::size_t i = 0; i < boxes.size() && !nothing_moves; ++i) {
            const bool moves = motion_states[i] == MotionState::Awake    ? random.below(4) != 0
                               : motion_states[i] == MotionState::Asleep ? random.below(50) == 0
                                                                         : static_moves && random.below(20) == 0;
            if (!moves) continue;
            if (scenario.removes_boxes && random.below(8) == 0) {
                boxes[i] = {};
            } else if (scenario.irregular && random.below(3) == 0) {
                boxes[i] = irregular_box(random);
            } else if (random.below(6) == 0 || boxes[i] == Aabb{}) {
                boxes[i] = box_at(random, 2);
            } else {
                const Vec3 shift{random.between(-0.2f, 0.2f), random.between(-0.2f, 0.2f), random.between(-0.2f, 0.2f)};
                boxes[i].lo += shift;
                boxes[i].hi += shift;
            }
        }
        const PairChanges changes = tracker.update(*tasks, boxes);
        const Pairs now = brute_force_pairs(boxes, motion_states);
        const SetDifference::Changes expected = reference.update(now);
        ASSERT_EQ(sorted(changes.begun), sorted(expected.begun)) << "frame " << frame;
        ASSERT_EQ(sorted(changes.ended), sorted(expected.ended)) << "frame " << frame;
        // Pairs of two resting boxes may be omitted.
        const Pairs staying = sorted(changes.staying);
        ASSERT_TRUE(std::includes(expected.staying.begin(), expected.staying.end(), staying.begin(), staying.end()));
        for (const Pair pair : expected.staying)
            if (tracker.finder().motion_state(pair.a) == MotionState::Awake ||
                tracker.finder().motion_state(pair.b) == MotionState::Awake) {
                ASSERT_TRUE(std::binary_search(staying.begin(), staying.end(), pair)) << "frame " << frame;
            }
    }
}

TEST(PairTracker, ReportsTheSameChangesAsTheReference) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) expect_correct_changes({}, seed);
}

TEST(PairTracker, ReportsChangesOfInfiniteNanAndInvertedBoxes) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) expect_correct_changes({.irregular = true}, seed);
}

TEST(PairTracker, ReportsChangesOfAddedAndRemovedBoxes) {
    for (std::uint64_t seed = 1; seed <= 20; ++seed) expect_correct_changes({.removes_boxes = true}, seed);
    for (std::uint64_t seed = 1; seed <= 20; ++seed)
        expect_correct_changes({.irregular = true, .removes_boxes = true}, seed);
}

TEST(PairTracker, ReportsCorrectChangesOnEveryStructureWithThreads) {
    broad::for_each_structure([]<broad::Structure S>() {
        expect_correct_changes(
            {.irregular = true, .removes_boxes = true, .threads = 2, .structure = std::string(S::info.name)}, 7);
    });
}

TEST(PairTracker, EndsThePairOfARemovedAsleepBoxAndAnInfiniteBox) {
    // By its coordinates alone, the absent box would overlap the infinite one.
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

TEST(PairTracker, WakesAnAsleepBoxThatShrinks) {
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

TEST(PairTracker, ClassifiesManyPairsInParallel) {
    // 300 equal boxes have 44,850 pairs: several chunks.
    std::vector<Aabb> boxes(300, Aabb{{0, 0, 0}, {1, 1, 1}});
    const std::vector<MotionState> motion_states(boxes.size(), MotionState::Awake);
    Pairs before;
    for (const int threads : {2, 3, 4}) {
        const auto tasks = make_thread_runner(threads);
        PairTracker tracker;
        tracker.build(*tasks, boxes, motion_states);
        std::vector<Aabb> next = boxes;
        for (std::size_t i = 0; i < next.size(); i += 3) next[i].lo += Vec3{5, 0, 0}, next[i].hi += Vec3{5, 0, 0};
        const PairChanges changes = tracker.update(*tasks, next);
        EXPECT_EQ(changes.staying.size(), 200u * 199 / 2 + 100u * 99 / 2);
        EXPECT_EQ(changes.ended.size(), 200u * 100);
        EXPECT_TRUE(changes.begun.empty());
        const Pairs staying(changes.staying.begin(), changes.staying.end());
        if (!before.empty()) {
            EXPECT_EQ(staying, before) << "different order on " << threads << " threads";
        }
        before = staying;
    }
}

TEST(PairTracker, FillsTheGapsOfEndedPairs) {
    // All boxes are equal first. Each then shrinks to the left or the right side, so that pairs end at single positions
    // in the list (kinds 0 and 1) or in long runs (kind 2); or each shrinks to its own x and all pairs end (kind 3).
    const std::vector<MotionState> motion_states(500, MotionState::Awake);
    const std::vector<Aabb> together(motion_states.size(), Aabb{{0, 0, 0}, {1, 1, 1}});
    Random random(3);
    for (int kind = 0; kind < 4; ++kind) {
        std::vector<Aabb> apart = together;
        for (std::size_t i = 0; i < apart.size(); ++i) {
            const bool is_left = kind == 0 ? random.below(2) == 0 : kind == 1 ? random.below(50) == 0 : i < 200;
            apart[i].lo.x = is_left ? 0 : 0.6f;
            apart[i].hi.x = is_left ? 0.4f : 1;
            if (kind == 3) apart[i].lo.x = apart[i].hi.x = static_cast<float>(i) / 512;
        }
        SetDifference reference;
        const Pairs all = brute_force_pairs(together, motion_states),
                    remaining = brute_force_pairs(apart, motion_states);
        reference.update(all);
        const SetDifference::Changes expected = reference.update(remaining);
        Pairs in_order;
        for (const int threads : {1, 2, 3}) {
            const auto tasks = make_thread_runner(threads);
            PairTracker tracker;
            tracker.build(*tasks, together, motion_states);
            const PairChanges changes = tracker.update(*tasks, apart);
            ASSERT_EQ(sorted(changes.staying), sorted(expected.staying))
                << "kind " << kind << ", " << threads << " threads";
            ASSERT_EQ(sorted(changes.ended), sorted(expected.ended))
                << "kind " << kind << ", " << threads << " threads";
            ASSERT_TRUE(changes.begun.empty());
            const Pairs staying(changes.staying.begin(), changes.staying.end());
            if (threads == 3) {
                ASSERT_EQ(staying, in_order) << "different order on three threads";
            }
            in_order = staying;
        }
    }
}

TEST(PairTracker, ReportsNothingIfAllBoxesRest) {
    std::vector<Aabb> boxes(50, Aabb{{0, 0, 0}, {1, 1, 1}});
    const std::vector<MotionState> motion_states(boxes.size(), MotionState::Asleep);
    const auto tasks = make_serial_runner();
    PairTracker tracker;
    EXPECT_EQ(tracker.build(*tasks, boxes, motion_states).begun.size(), 50u * 49 / 2);
    for (int i = 0; i < 3; ++i) {
        const PairChanges changes = tracker.update(*tasks, boxes);
        EXPECT_TRUE(changes.begun.empty() && changes.ended.empty() && changes.staying.empty());
    }
}

}  // namespace
}  // namespace fase::pairs
