/// The loops of a pair tracker against the plainest way, with every set of vector instructions.
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

/// Runs a check with each instruction set that this machine and this compiler offer.
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

/// Some in a small place, so that many overlap; now and then one that is absent, endless, or has no number.
Aabb box_in(Random& random, float room) {
    switch (random.below(20)) {
        case 0: return {};
        case 1: return Aabb::everything();
        case 2: return {{0, nan, 0}, {1, 1, 1}};
        default: break;
    }
    const Vec3 lo{random.between(0, room), random.between(0, room), random.between(0, room)};
    return {lo, lo + Vec3{1, 1, 1}};
}

std::vector<Aabb> boxes_in(Random& random, std::size_t count, float room) {
    std::vector<Aabb> boxes(count);
    for (Aabb& box : boxes) box = box_in(random, room);
    return boxes;
}

bool is_pair(const Aabb& a, const Aabb& b) { return a != Aabb{} && b != Aabb{} && overlaps(a, b); }

struct Told {
    Pairs staying, begun, ended;
    bool operator==(const Told&) const = default;
};

Told told_by_definition(std::span<const Aabb> before, std::span<const Aabb> now, const Pairs& pairs) {
    Told told;
    for (const Pair pair : pairs) {
        const bool was = is_pair(before[pair.a], before[pair.b]), is = is_pair(now[pair.a], now[pair.b]);
        if (was && is) told.staying.push_back(pair);
        if (!was && is) told.begun.push_back(pair);
        if (was && !is) told.ended.push_back(pair);
    }
    return told;
}

/// Tells random pairs of `boxes` boxes.
void expect_told_right(std::size_t boxes, std::size_t pairs, float room) {
    Random random(boxes + pairs);
    const std::vector<Aabb> before = boxes_in(random, boxes, room);
    std::vector<Aabb> now = boxes_in(random, boxes, room);
    for (std::size_t i = 0; i < boxes; ++i)
        if (random.below(3) != 0) now[i] = before[i];
    Pairs all;
    for (std::size_t i = 0; i < pairs; ++i)
        all.push_back({static_cast<Proxy>(random.below(boxes)), static_cast<Proxy>(random.below(boxes))});
    const Told right = told_by_definition(before, now, all);
    on_every_target([&] {
        std::vector<LastPlaces> places(boxes);
        for (std::size_t i = 0; i < boxes; ++i) stay(before[i], places[i]);
        std::vector<Aabb> spans(boxes);
        std::vector<Proxy> changed(boxes);
        advance(now, 0, boxes, places.data(), spans.data(), changed.data());
        const Pair kept{1, 2};
        Pairs list = all;
        list.push_back(kept);  // behind those that are asked for: nobody's to write to
        Told told{{}, {kept}, {kept}};
        const std::size_t staying = tell(places, std::span(list).first(pairs), told.begun, told.ended);
        EXPECT_EQ(list.back(), kept);
        EXPECT_EQ(told.begun.front(), kept);
        EXPECT_EQ(told.ended.front(), kept);
        told.begun.erase(told.begun.begin());
        told.ended.erase(told.ended.begin());
        told.staying.assign(list.begin(), list.begin() + static_cast<std::ptrdiff_t>(staying));
        EXPECT_EQ(told, right) << boxes << " boxes, " << pairs << " pairs";
    });
}

TEST(TrackerPasses, TellPairsApartInOrder) {
    for (const std::size_t pairs : {0u, 1u, 3u, 7u, 8u, 9u, 127u, 1023u, 1024u, 1025u, 5000u})
        for (const float room : {0.5f, 2.0f, 50.0f}) expect_told_right(40, pairs, room);
}

TEST(TrackerPasses, TellPairsOfMoreBoxesThanACacheHolds) {
    for (const std::size_t pairs : {0u, 1u, 100u, 128u, 129u, 1024u, 1152u, 1153u, 5000u})
        expect_told_right(20000, pairs, 1.5f);
}

TEST(TrackerPasses, SpanBothPlacesOfWhatChanged) {
    Random random(5);
    std::vector<std::vector<Aabb>> frames;
    for (int frame = 0; frame < 8; ++frame) {
        frames.push_back(boxes_in(random, 300, 3));
        for (std::size_t i = 0; frame > 0 && i < 300; ++i)
            if (random.below(2) != 0) frames.back()[i] = frames[frames.size() - 2][i];
    }
    const auto same_bits = [](const Aabb& a, const Aabb& b) { return std::memcmp(&a, &b, sizeof a) == 0; };
    on_every_target([&] {
        std::vector<LastPlaces> places(300);
        for (std::size_t i = 0; i < 300; ++i) stay(frames[0][i], places[i]);
        const Aabb untouched{{7, 7, 7}, {8, 8, 8}};
        for (std::size_t frame = 1; frame < frames.size(); ++frame) {
            const std::vector<Aabb>&now = frames[frame], &before = frames[frame - 1],
                  &older = frames[frame > 1 ? frame - 2 : 0];
            std::vector<Aabb> spans(300, untouched);
            std::vector<Proxy> changed(300), right;
            changed.resize(advance(now, 0, 300, places.data(), spans.data(), changed.data()));
            for (Proxy i = 0; i < 300; ++i) {
                if (same_bits(now[i], before[i]) && same_bits(before[i], older[i])) {
                    EXPECT_EQ(spans[i], untouched);
                    continue;
                }
                right.push_back(i);
                for (int k = 0; k < 3; ++k) {
                    if (now[i] == Aabb{} && before[i] == Aabb{}) continue;
                    for (const Aabb& box : {now[i], before[i]}) {
                        EXPECT_FALSE(box.lo[k] < spans[i].lo[k]) << "box " << i;
                        EXPECT_FALSE(box.hi[k] > spans[i].hi[k]) << "box " << i;
                    }
                }
                const bool have_numbers = now[i].lo.y == now[i].lo.y && before[i].lo.y == before[i].lo.y;
                if (have_numbers) {
                    EXPECT_EQ(spans[i], merge(now[i], before[i]));  // absent ones are empty, and add nothing
                }
            }
            EXPECT_EQ(changed, right);
        }
    });
}

}  // namespace
}  // namespace fase::pairs::passes
