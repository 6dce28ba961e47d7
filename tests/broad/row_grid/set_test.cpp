#include "fase/broad/row_grid/set.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "fase/broad/brute_force.hpp"
#include "fase/broad/find_pairs.hpp"
#include "fase/broad/row_grid/kernels.hpp"
#include "fase/broad/row_grid/walk.hpp"
#include "fase/core/random.hpp"
#include "tests/broad/drawn_boxes.hpp"

namespace fase::broad {
namespace {

using Rows = RowGridSettings::Rows;

std::vector<Pair> sorted(std::vector<Pair> pairs) {
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

RC_GTEST_PROP(RowSetProperty, HidesErasedRecordsFromAllSearches, ()) {
    Random random(*rc::gen::inRange<std::uint64_t>(0, 1u << 30));
    const float world = *rc::gen::element(0.0f, 5.0f, 40.0f, 1e6f);
    const auto count = *rc::gen::inRange<Proxy>(1, 300);
    const auto draw = [&] {
        const Vec3 lo = place(random, 0, world), sides = place(random, 0, random.below(8) == 0 ? 20.0f : 1.5f);
        return Aabb{lo, lo + sides};
    };
    std::vector<Move> boxes;
    for (Proxy p = 0; p < count; ++p) boxes.push_back({p, draw()});
    RowSet set;
    set.build(boxes, {.rows = *rc::gen::element(Rows::Table, Rows::List)});
    const std::uint64_t chance = *rc::gen::inRange<std::uint64_t>(0, 9);
    for (std::size_t i = 0; i < set.size(); ++i) {
        if (random.below(8) >= chance) continue;
        const Proxy p = set.view().proxies[i];
        std::erase_if(boxes, [&](const Move& m) { return m.proxy == p; });
        set.erase_record(i);
    }
    RC_ASSERT(set.broken_invariant(boxes) == "");
    RC_ASSERT(set.tombstones() + boxes.size() == set.size());
    BruteForce reference;
    for (const Move& m : boxes) reference.insert(m.proxy, m.box);

    std::vector<Pair> expected, found;
    find_pairs(reference, expected);
    {
        row_grid::PairBlock block(found);
        row_grid::find_own_pairs(set.view(), 0, set.size(), block);
    }
    RC_ASSERT(sorted(found) == sorted(expected));

    std::vector<Move> query_boxes{{1000, Aabb::everything()}};
    for (Proxy p = 1001; p < 1020; ++p) query_boxes.push_back({p, draw()});
    expected.clear();
    found.clear();
    find_pairs_of(reference, query_boxes, expected);
    {
        row_grid::PairBlock block(found);
        row_grid::find_query_pairs(set.view(), {query_boxes, {}}, block);
    }
    RC_ASSERT(sorted(found) == sorted(expected));

    std::vector<Proxy> visited, all;
    row_grid::walk(set.view(), Everything{}, [&](Proxy p, const Aabb&) {
        visited.push_back(p);
        return true;
    });
    for (const Move& m : boxes) all.push_back(m.proxy);
    std::sort(visited.begin(), visited.end());
    RC_ASSERT(visited == all);
}

RC_GTEST_PROP(RowSetProperty, InsertsBoxesInPlaceOfErasedOnes, ()) {
    Random random(*rc::gen::inRange<std::uint64_t>(0, 1u << 30));
    const float world = *rc::gen::element(0.0f, 5.0f, 20.0f, 1e6f);
    const auto count = *rc::gen::inRange<Proxy>(1, 400);
    const auto draw = [&] {
        const Vec3 lo = place(random, -world / 4, world), sides = place(random, 0, random.below(8) == 0 ? 20.0f : 1.5f);
        return Aabb{lo, lo + sides};
    };
    std::vector<Move> boxes;
    for (Proxy p = 0; p < count; ++p) boxes.push_back({p, draw()});
    std::vector<Move> with_free_slots = boxes;
    for (Proxy p = 0; p < count; p += 5) with_free_slots.push_back({tombstone, boxes[p].box});
    RowSet set;
    set.build(with_free_slots, {.rows = *rc::gen::element(Rows::Table, Rows::List)});
    set.make_free_slots();
    RC_ASSERT(set.broken_invariant(boxes) == "");
    Proxy next = count;
    std::size_t inserted = 0;
    const auto record_of = [&](Proxy p) {
        const RowView view = set.view();
        return static_cast<std::uint32_t>(std::find(view.proxies, view.proxies + view.count, p) - view.proxies);
    };
    for (int step = 0; step < 60; ++step) {
        if (random.below(3) == 0 && !boxes.empty()) {
            const std::size_t at = random.below(boxes.size());
            set.erase_record(record_of(boxes[at].proxy));
            boxes[at] = boxes.back();
            boxes.pop_back();
            continue;
        }
        Move m{next++, draw()};
        if (random.below(2) == 0 && !boxes.empty()) m.box = boxes[random.below(boxes.size())].box;
        std::vector<std::uint32_t> before;
        for (const Move& other : boxes) before.push_back(record_of(other.proxy));
        const auto moved = set.try_insert(m);
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            const std::uint32_t now = record_of(boxes[i].proxy);
            RC_ASSERT(now == before[i] || (moved && now >= moved->begin && now < moved->end));
        }
        if (!moved) continue;
        ++inserted;
        const std::uint32_t mine = record_of(m.proxy);
        RC_ASSERT(mine >= moved->begin && mine < moved->end);
        boxes.push_back(m);
        RC_ASSERT(set.broken_invariant(boxes) == "");
    }
    RC_CLASSIFY(inserted > 10);
    std::vector<Pair> expected, found;
    BruteForce reference;
    for (const Move& m : boxes) reference.insert(m.proxy, m.box);
    find_pairs(reference, expected);
    {
        row_grid::PairBlock block(found);
        row_grid::find_own_pairs(set.view(), 0, set.size(), block);
    }
    RC_ASSERT(sorted(found) == sorted(expected));
}

}  // namespace
}  // namespace fase::broad
