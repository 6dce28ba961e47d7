#include "fase/broad/row_deal.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>

#include "fase/broad/box_store.hpp"
#include "tests/broad/drawn_boxes.hpp"
#include "tests/conformance/scenes.hpp"

namespace fase::broad {
namespace {

std::vector<Move> drawn(const conformance::Scene& scene, std::size_t count) {
    Random random(6);
    std::vector<Move> boxes;
    while (boxes.size() < count)
        if (const Aabb box = scene.draw(random); is_ordinary(box))
            boxes.push_back({static_cast<Proxy>(3 * boxes.size() + 1), box});
    return boxes;
}

/// In the order in which they are stored.
std::vector<Move> records(const RowSet& set) {
    std::vector<Move> all;
    const RowView view = set.view();
    for (std::size_t i = 0; i < view.count; ++i) all.push_back({view.proxies[i], view.box(i)});
    return all;
}
bool same(const std::vector<Move>& a, const std::vector<Move>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                      [](const Move& x, const Move& y) { return x.proxy == y.proxy && x.box == y.box; });
}

TEST(RowDeal, ChangesNothingOfWhatIsStored) {
    for (const conformance::Scene& scene : conformance::all_scenes()) {
        SCOPED_TRACE(scene.name);
        const std::vector<Move> boxes = drawn(scene, 33000);
        std::vector<Aabb> list;
        for (const Move& m : boxes) list.push_back(m.box);
        RowSet moves_alone, list_alone;
        ASSERT_TRUE(moves_alone.build(boxes, {}));
        ASSERT_TRUE(list_alone.build(list, {}));
        ASSERT_EQ(moves_alone.broken_invariant(boxes), "");
        for (const int threads : {2, 3, 8}) {
            const auto tasks = make_thread_runner(threads);
            ASSERT_TRUE(RowDeal::pays(boxes.size(), tasks.get()));
            RowDeal deal;
            RowSet moves, of_list;
            for (int step = 0; step < 2; ++step) {  // with the memory of the last one
                ASSERT_TRUE(moves.build(boxes, {}, &deal, tasks.get()));
                EXPECT_EQ(moves.broken_invariant(boxes), "");
                EXPECT_TRUE(same(records(moves), records(moves_alone))) << threads;
                ASSERT_TRUE(of_list.build(list, {}, &deal, tasks.get()));
                EXPECT_TRUE(same(records(of_list), records(list_alone))) << threads;
            }
        }
    }
}

TEST(RowDeal, IsForOneThreadTooWhereBoxesAreMany) {
    EXPECT_FALSE(RowDeal::pays(row_grid::past_caches - 1, nullptr));
    const std::vector<Move> boxes = gas(row_grid::past_caches, 14);
    RowSet alone, set;
    RowDeal deal;
    ASSERT_TRUE(alone.build(boxes, {}));
    ASSERT_TRUE(set.build(boxes, {}, &deal));
    EXPECT_GT(deal.slabs().size(), 8u);
    EXPECT_EQ(set.broken_invariant(boxes), "");
    EXPECT_TRUE(same(records(set), records(alone)));
}

TEST(RowDeal, HasEachBoxOnceInTheSlabOfItsCellAndThoseOfASlabInTheirOrder) {
    const std::vector<Move> boxes = gas(40000, 5);
    RowFit fit;
    RowSample sample;
    fit_rows(boxes, {}, sample, fit);
    const auto tasks = make_thread_runner(2);
    RowDeal deal;
    const row_grid::Counted counted = deal.deal(boxes, fit, tasks.get());
    EXPECT_FALSE(counted.odd);
    std::uint32_t counter = 0, record = 0;
    for (const RowSlab& slab : deal.slabs()) {
        ASSERT_EQ(slab.counters, counter);
        ASSERT_EQ(slab.first, record);
        counter = slab.counters_end;
        std::int64_t before = -1;
        for (const RecordSpan run : slab.runs) {
            ASSERT_LT(run.begin, run.end);
            record += run.end - run.begin;
            std::vector<float> keys(run.end - run.begin);
            std::vector<std::uint32_t> table(fit.table);
            row_grid::count_cells(deal.boxes().subspan(run.begin, keys.size()), fit, keys.data(), table.data());
            for (std::uint32_t i = run.begin; i < run.end; ++i) {
                const Move& m = deal.boxes()[i];
                ASSERT_TRUE(m.box == boxes[m.proxy].box);
                ASSERT_GT(m.proxy, before);
                before = m.proxy;
                const auto key = std::bit_cast<std::uint32_t>(keys[i - run.begin]);
                ASSERT_TRUE(slab.counters <= key && key < slab.counters_end);
            }
        }
    }
    EXPECT_EQ(counter, fit.table);
    EXPECT_EQ(record, boxes.size());
}

TEST(RowDeal, TellsOfABoxThatNoGridCanHold) {
    const auto tasks = make_thread_runner(2);
    for (const std::size_t at : {0u, 17000u, 34999u}) {
        std::vector<Move> boxes = gas(35000, 3);
        boxes[at].box = Aabb::everything();
        RowSet set;
        RowDeal deal;
        EXPECT_FALSE(set.build(boxes, {}, &deal, tasks.get())) << at;
        EXPECT_EQ(set.size(), 0u);
        boxes[at].box = boxes[1].box;
        EXPECT_TRUE(set.build(boxes, {}, &deal, tasks.get()));
        EXPECT_EQ(set.broken_invariant(boxes), "");
    }
}

TEST(RowDeal, ChoosesTheCellsAnewWhereBoxesHaveGoneElsewhere) {
    const auto tasks = make_thread_runner(2);
    std::vector<Move> boxes = gas(35000, 3);
    RowSet set;
    RowDeal deal;
    ASSERT_TRUE(set.build(boxes, {}, &deal, tasks.get()));
    for (Move& m : boxes) m.box = {m.box.lo + Vec3{500, 0, 0}, m.box.hi + Vec3{500, 0, 0}};
    ASSERT_TRUE(set.build(boxes, {}, &deal, tasks.get()));
    EXPECT_EQ(set.broken_invariant(boxes), "");
    std::vector<std::uint32_t> filled;
    for (const RowSlab& slab : deal.slabs())
        if (!slab.runs.empty()) filled.push_back(slab.counters);
    EXPECT_GT(filled.size(), 4u);
}

}  // namespace
}  // namespace fase::broad
