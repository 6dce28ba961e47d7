#include "fase/pairs/frame_pairs.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "fase/broad/boxes/box_store.hpp"
#include "tests/broad/drawn_boxes.hpp"
#include "tests/conformance/scenes.hpp"

namespace fase::pairs {

using namespace broad;
namespace {

std::vector<Aabb> random_boxes(const conformance::Scene& scene, std::size_t count, Random& random) {
    std::vector<Aabb> boxes;
    while (boxes.size() < count)
        if (const Aabb box = scene.draw(random); is_regular(box)) boxes.push_back(box);
    return boxes;
}
std::vector<Pair> reference_pairs(std::span<const Aabb> boxes) {
    std::vector<Move> moves;
    for (const Aabb& box : boxes) moves.push_back({static_cast<Proxy>(moves.size()), box});
    return reference_pairs(std::span<const Move>(moves));
}
std::vector<Pair> in_order(std::vector<Pair> pairs) {
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

TEST(FramePairs, FindsTheSamePairsAsBruteForceInListsOfAnyLengthSequentially) {
    const auto serial = make_serial_runner();
    for (const conformance::Scene& scene : conformance::all_scenes()) {
        SCOPED_TRACE(scene.name);
        Random random(4);
        FramePairs frame;
        for (const std::size_t count : {0u, 1u, 2u, 15u, 700u, 300u, 301u}) {
            const std::vector<Aabb> boxes = random_boxes(scene, count, random);
            std::vector<Pair> found;
            ASSERT_TRUE(frame.sort(*serial, boxes));
            EXPECT_EQ(frame.size(), count);
            frame.find(*serial, found);
            ASSERT_TRUE(in_order(found) == reference_pairs(boxes)) << count;
        }
    }
}

TEST(FramePairs, FindsPairsInTheSameOrderForAnyNumberOfThreads) {
    Random random(8);
    std::vector<Aabb> boxes;
    for (int i = 0; i < 40000; ++i)
        boxes.push_back(conformance::box_around(place(random, 0, 60), place(random, 0.1f, 1)));
    std::vector<Pair> expected;
    {
        FramePairs frame;
        const auto serial = make_serial_runner();
        ASSERT_TRUE(frame.sort(*serial, boxes));
        frame.find(*serial, expected);
    }
    EXPECT_GT(expected.size(), 10000u);
    for (const int threads : {2, 3, 8}) {
        const auto tasks = make_thread_runner(threads);
        FramePairs frame;
        std::vector<Pair> found;
        ASSERT_TRUE(frame.sort(*tasks, boxes));
        frame.find(*tasks, found);
        EXPECT_TRUE(found == expected) << threads;
    }
}

TEST(FramePairs, RejectsAListWithABoxThatIsNotRegular) {
    const auto serial = make_serial_runner();
    constexpr float nan = std::numeric_limits<float>::quiet_NaN(), inf = Aabb::infinity;
    const std::vector<Aabb> irregular{Aabb{},
                                      Aabb::everything(),
                                      {{nan, 0, 0}, {1, 1, 1}},
                                      {{0, 0, 0}, {1, 1, nan}},
                                      {{1, 0, 0}, {0, 1, 1}},
                                      {{0, 0, 0}, {1, inf, 1}},
                                      {{-3e17f, 0, 0}, {-2e17f, 1, 1}},
                                      {{0, 0, 2e17f}, {1, 1, 3e17f}}};
    for (const std::size_t index : {0u, 7u, 8u, 36u}) {
        for (const Aabb& box : irregular) {
            std::vector<Aabb> boxes(37, Aabb{{0, 0, 0}, {1, 1, 1}});
            boxes[index] = box;
            FramePairs frame;
            EXPECT_FALSE(frame.sort(*serial, boxes)) << index;
            std::vector<Pair> found;
            frame.find(*serial, found);
            EXPECT_TRUE(found.empty());
            boxes[index] = boxes[index == 0 ? 1 : 0];
            ASSERT_TRUE(frame.sort(*serial, boxes)) << index;
            frame.find(*serial, found);
            EXPECT_EQ(found.size(), 37u * 36 / 2);
        }
    }
}

}  // namespace
}  // namespace fase::pairs
