/// The SIMD loops of a pair tracker against plain references, on every SIMD target.
#include "fase/pairs/detail/tracker_passes.hpp"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <cstring>
#include <functional>
#include <limits>

#include "fase/core/random.hpp"

namespace fase::pairs::passes {
namespace {

using broad::Pair;
using broad::Proxy;
using Pairs = std::vector<Pair>;

constexpr float nan = std::numeric_limits<float>::quiet_NaN();

/// Runs a check on each SIMD target that this machine and this compiler support.
void on_every_target(const std::function<void()>& check) {
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        SCOPED_TRACE(hwy::TargetName(target));
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        check();
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

/// A box in a small region, so that many overlap; some are absent, infinite or have a NaN.
Aabb box_in(Random& random, float extent) {
    switch (random.below(20)) {
        case 0: return {};
        case 1: return Aabb::everything();
        case 2: return {{0, nan, 0}, {1, 1, 1}};
        default: break;
    }
    const Vec3 lo{random.between(0, extent), random.between(0, extent), random.between(0, extent)};
    return {lo, lo + Vec3{1, 1, 1}};
}

std::vector<Aabb> boxes_in(Random& random, std::size_t count, float extent) {
    std::vector<Aabb> boxes(count);
    for (Aabb& box : boxes) box = box_in(random, extent);
    return boxes;
}

bool is_pair(const Aabb& a, const Aabb& b) { return a != Aabb{} && b != Aabb{} && overlaps(a, b); }

struct Changes {
    Pairs staying, begun, ended;
    bool operator==(const Changes&) const = default;
};

Changes expected_changes(std::span<const Aabb> before, std::span<const Aabb> now, const Pairs& pairs) {
    Changes changes;
    for (const Pair pair : pairs) {
        const bool was = is_pair(before[pair.a], before[pair.b]), is = is_pair(now[pair.a], now[pair.b]);
        if (was && is) changes.staying.push_back(pair);
        if (!was && is) changes.begun.push_back(pair);
        if (was && !is) changes.ended.push_back(pair);
    }
    return changes;
}

/// Classifies random pairs of `boxes` boxes.
void expect_correct_changes(std::size_t boxes, std::size_t pairs, float extent) {
    Random random(boxes + pairs);
    const std::vector<Aabb> before = boxes_in(random, boxes, extent);
    std::vector<Aabb> now = boxes_in(random, boxes, extent);
    for (std::size_t i = 0; i < boxes; ++i)
        if (random.below(3) != 0) now[i] = before[i];
    Pairs all;
    for (std::size_t i = 0; i < pairs; ++i)
        all.push_back({static_cast<Proxy>(random.below(boxes)), static_cast<Proxy>(random.below(boxes))});
    const Changes expected = expected_changes(before, now, all);
    on_every_target([&] {
        std::vector<BoxHistory> histories(boxes);
        for (std::size_t i = 0; i < boxes; ++i) reset_history(before[i], histories[i]);
        std::vector<Aabb> swept(boxes);
        std::vector<Proxy> changed(boxes);
        advance_histories(now, 0, boxes, histories.data(), swept.data(), changed.data());
        const Pair sentinel{1, 2};
        Pairs list = all;
        list.push_back(sentinel);  // past the end of the input: must not be written to
        Changes changes{{}, {sentinel}, {sentinel}};
        const std::size_t staying =
            classify_pairs(histories, std::span(list).first(pairs), changes.begun, changes.ended);
        EXPECT_EQ(list.back(), sentinel);
        EXPECT_EQ(changes.begun.front(), sentinel);
        EXPECT_EQ(changes.ended.front(), sentinel);
        changes.begun.erase(changes.begun.begin());
        changes.ended.erase(changes.ended.begin());
        changes.staying.assign(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(staying));
        EXPECT_EQ(changes, expected) << boxes << " boxes, " << pairs << " pairs";
    });
}

TEST(TrackerPasses, ClassifyPairsInOrder) {
    for (const std::size_t pairs : {0u, 1u, 3u, 7u, 8u, 9u, 127u, 1023u, 1024u, 1025u, 5000u})
        for (const float extent : {0.5f, 2.0f, 50.0f}) expect_correct_changes(40, pairs, extent);
}

TEST(TrackerPasses, ClassifyPairsOfMoreBoxesThanFitTheCache) {
    for (const std::size_t pairs : {0u, 1u, 100u, 128u, 129u, 1024u, 1152u, 1153u, 5000u})
        expect_correct_changes(20000, pairs, 1.5f);
}

TEST(TrackerPasses, ComputeSweptBoxesOfChangedBoxes) {
    Random random(5);
    std::vector<std::vector<Aabb>> frames;
    for (int frame = 0; frame < 8; ++frame) {
        frames.push_back(boxes_in(random, 300, 3));
        for (std::size_t i = 0; frame > 0 && i < 300; ++i)
            if (random.below(2) != 0) frames.back()[i] = frames[frames.size() - 2][i];
    }
    const auto same_bits = [](const Aabb& a, const Aabb& b) { return std::memcmp(&a, &b, sizeof a) == 0; };
    on_every_target([&] {
        std::vector<BoxHistory> histories(300);
        for (std::size_t i = 0; i < 300; ++i) reset_history(frames[0][i], histories[i]);
        const Aabb untouched{{7, 7, 7}, {8, 8, 8}};
        for (std::size_t frame = 1; frame < frames.size(); ++frame) {
            const std::vector<Aabb>&now = frames[frame], &before = frames[frame - 1],
                  &older = frames[frame > 1 ? frame - 2 : 0];
            std::vector<Aabb> swept(300, untouched);
            std::vector<Proxy> changed(300), expected;
            changed.resize(advance_histories(now, 0, 300, histories.data(), swept.data(), changed.data()));
            for (Proxy i = 0; i < 300; ++i) {
                if (same_bits(now[i], before[i]) && same_bits(before[i], older[i])) {
                    EXPECT_EQ(swept[i], untouched);
                    continue;
                }
                expected.push_back(i);
                for (int k = 0; k < 3; ++k) {
                    if (now[i] == Aabb{} && before[i] == Aabb{}) continue;
                    for (const Aabb& box : {now[i], before[i]}) {
                        EXPECT_FALSE(box.lo[k] < swept[i].lo[k]) << "box " << i;
                        EXPECT_FALSE(box.hi[k] > swept[i].hi[k]) << "box " << i;
                    }
                }
                const bool have_numbers = now[i].lo.y == now[i].lo.y && before[i].lo.y == before[i].lo.y;
                if (have_numbers) {
                    EXPECT_EQ(swept[i], merge(now[i], before[i]));  // absent boxes are empty and do not enlarge it
                }
            }
            EXPECT_EQ(changed, expected);
        }
    });
}

}  // namespace
}  // namespace fase::pairs::passes
