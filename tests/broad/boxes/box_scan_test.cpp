#include "fase/broad/boxes/box_scan.hpp"

#include <gtest/gtest.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "fase/core/random.hpp"

namespace fase::broad {
namespace {

/// Boxes with integer coordinates, so that many touch; three of nine are infinite, inverted or NaN unless `regular`.
BoxColumns boxes_of(std::size_t count, std::uint64_t seed, bool regular) {
    Random random(seed);
    BoxColumns boxes;
    boxes.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
        const auto whole = [&](std::uint64_t below) { return static_cast<float>(random.below(below)); };
        Aabb box;
        for (int axis = 0; axis < 3; ++axis) {
            box.lo[axis] = whole(12);
            box.hi[axis] = box.lo[axis] + whole(4);
        }
        if (!regular && i % 9 == 4) box.hi[static_cast<int>(i % 3)] = Aabb::infinity;
        if (!regular && i % 9 == 5) std::swap(box.lo, box.hi);
        if (!regular && i % 9 == 6) box.lo[static_cast<int>(i % 3)] = std::nanf("");
        boxes.put(i, static_cast<Proxy>(random.below(1000000) * 1000 + i), box);
    }
    return boxes;
}

BoxColumns sorted_along(const BoxColumns& boxes, int axis) {
    std::vector<std::size_t> order(boxes.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return boxes.box(a).lo[axis] < boxes.box(b).lo[axis]; });
    BoxColumns sorted;
    sorted.resize(boxes.size());
    for (std::size_t i = 0; i < order.size(); ++i) sorted.put(i, boxes.proxy(order[i]), boxes.box(order[i]));
    return sorted;
}

/// Runs a check with each instruction set that the machine and the compiler support.
void on_every_target(const std::function<void()>& check) {
    int targets = 0;
    for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
        SCOPED_TRACE(hwy::TargetName(target));
        hwy::SetSupportedTargetsForTest(target);
        hwy::GetChosenTarget().Update(hwy::SupportedTargets());
        check();
        ++targets;
    }
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
    EXPECT_GE(targets, 1);
}

std::vector<Pair> sorted(std::vector<Pair> pairs) {
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

/// The definition: overlaps() of each box in begin..end-1 and each later box.
std::vector<Pair> pairs_by_definition(const BoxColumns& boxes, std::size_t begin, std::size_t end) {
    std::vector<Pair> pairs;
    for (std::size_t i = begin; i < end; ++i)
        for (std::size_t k = i + 1; k < boxes.size(); ++k)
            if (overlaps(boxes.box(i), boxes.box(k))) pairs.push_back(ordered_pair(boxes.proxy(i), boxes.proxy(k)));
    return pairs;
}

/// Calls `find` on every target: it must find the expected pairs, in the same order on all targets.
void expect_pairs(const std::vector<Pair>& expected, const std::function<void(std::vector<Pair>&)>& find) {
    std::vector<Pair> first;
    bool is_first = true;
    on_every_target([&] {
        std::vector<Pair> found;
        find(found);
        ASSERT_EQ(sorted(found), sorted(expected));
        if (is_first) first = found;
        is_first = false;
        ASSERT_EQ(found, first) << "the order depends on the instruction set";
    });
}

constexpr std::size_t lengths[] = {0, 1, 2, 3, 4, 5, 15, 16, 17, 31, 33, 64, 100, 257};

TEST(BoxScan, FindsThePairsOfEachBoxWithLaterBoxes) {
    for (const std::size_t count : lengths) {
        SCOPED_TRACE(count);
        const BoxColumns boxes = boxes_of(count, count, false);
        for (const std::size_t begin : {std::size_t{0}, count / 3}) {
            const std::size_t end = count - count / 4;
            expect_pairs(pairs_by_definition(boxes, begin, end),
                         [&](std::vector<Pair>& out) { scan_behind(boxes.view(), begin, end, out); });
        }
    }
}

TEST(BoxScan, FindsThePairsInASortedList) {
    for (const std::size_t count : lengths) {
        for (int axis = 0; axis < 3; ++axis) {
            SCOPED_TRACE(std::to_string(count) + " along " + std::to_string(axis));
            const BoxColumns boxes = sorted_along(boxes_of(count, count, true), axis);
            const std::size_t begin = count / 5;
            expect_pairs(pairs_by_definition(boxes, begin, count),
                         [&](std::vector<Pair>& out) { sweep_behind(boxes.view(axis), begin, count, out); });
        }
    }
}

/// More pairs per box than a block holds, and more boxes than a chunk.
TEST(BoxScan, FindsAllPairsOfThousandsOfCoincidentBoxes) {
    BoxColumns boxes;
    boxes.resize(2600);
    for (std::size_t i = 0; i < boxes.size(); ++i) boxes.put(i, static_cast<Proxy>(i), {{1, 2, 3}, {2, 3, 4}});
    const std::size_t begin = 2, end = 9;  // two groups of four, and one box
    const std::vector<Pair> expected = pairs_by_definition(boxes, begin, end);
    expect_pairs(expected, [&](std::vector<Pair>& out) { scan_behind(boxes.view(), begin, end, out); });
    expect_pairs(expected, [&](std::vector<Pair>& out) { sweep_behind(boxes.view(), begin, end, out); });
}

TEST(BoxScan, FindsEachPairOfTwoSortedListsOnce) {
    for (const std::size_t count : lengths) {
        SCOPED_TRACE(count);
        const BoxColumns a = sorted_along(boxes_of(count, 1, true), 1);
        const BoxColumns b = sorted_along(boxes_of(300 - count, 2, true), 1);
        std::vector<Pair> expected;
        for (std::size_t i = 0; i < a.size(); ++i)
            for (std::size_t k = 0; k < b.size(); ++k)
                if (overlaps(a.box(i), b.box(k))) expected.push_back(ordered_pair(a.proxy(i), b.proxy(k)));
        expect_pairs(expected, [&](std::vector<Pair>& out) {
            sweep_across(a.view(1), 0, a.size() / 2, b.view(1), Ties::Mine, out);
            sweep_across(a.view(1), a.size() / 2, a.size(), b.view(1), Ties::Mine, out);
            sweep_across(b.view(1), 0, b.size(), a.view(1), Ties::Theirs, out);
        });
    }
}

TEST(BoxScan, FindsPairsWithinRangesByTheirMarks) {
    const BoxColumns boxes = boxes_of(200, 5, true);
    Random random(6);
    std::vector<std::uint32_t> marks(boxes.size() + BoxColumns::padding);
    for (std::uint32_t& mark : marks) mark = static_cast<std::uint32_t>(random.below(8));
    const std::vector<ScanRange> ranges = {{0, 5, 5}, {5, 5, 40}, {40, 60, 95}, {95, 96, 96}, {96, 200, 200}};
    std::vector<Pair> expected;
    for (const ScanRange& range : ranges)
        for (std::size_t i = range.first; i < range.queries_end; ++i)
            for (std::size_t k = i + 1; k < range.end; ++k)
                if (overlaps(boxes.box(i), boxes.box(k)) && (marks[i] | marks[k]) == 7)
                    expected.push_back(ordered_pair(boxes.proxy(i), boxes.proxy(k)));
    ASSERT_GT(expected.size(), 20u);
    expect_pairs(expected, [&](std::vector<Pair>& out) { scan_ranges(boxes.view(), marks.data(), ranges, out); });
}

TEST(BoxScan, FindsTheBoxesThatTouchABoxInOrder) {
    const BoxColumns boxes = boxes_of(200, 7, false);
    Random random(8);
    for (int i = 0; i < 100; ++i) {
        const BoxColumns candidates = boxes_of(5, random.next(), false);
        const Aabb region = candidates.box(random.below(5));
        const std::size_t begin = random.below(200), end = begin + random.below(201 - begin);
        std::vector<std::uint32_t> expected;
        for (std::size_t k = begin; k < end; ++k)
            if (overlaps(region, boxes.box(k))) expected.push_back(static_cast<std::uint32_t>(k));
        on_every_target([&] {
            std::vector<std::uint32_t> hits(end - begin + BoxColumns::padding);
            hits.resize(scan_touching(boxes.view(), begin, end, region, hits.data()));
            ASSERT_EQ(hits, expected);
        });
    }
}

}  // namespace
}  // namespace fase::broad
