#include <gtest/gtest.h>

#include <algorithm>

#include "fase/broad/boxes/box_store.hpp"
#include "fase/broad/row_grid/set.hpp"
#include "tests/broad/drawn_boxes.hpp"
#include "tests/conformance/scenes.hpp"

namespace fase::broad {
namespace {

std::vector<Move> random_boxes(const conformance::Scene& scene, std::size_t count) {
    Random random(6);
    std::vector<Move> boxes;
    while (boxes.size() < count)
        if (const Aabb box = scene.draw(random); is_regular(box))
            boxes.push_back({static_cast<Proxy>(3 * boxes.size() + 1), box});
    return boxes;
}

/// Returns the records in stored order.
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

/// Enough boxes for a sort on several threads.
constexpr std::size_t many = 33000;

TEST(RowSetParallel, StoresTheSameForAnyNumberOfThreads) {
    for (const conformance::Scene& scene : conformance::all_scenes()) {
        SCOPED_TRACE(scene.name);
        const std::vector<Move> boxes = random_boxes(scene, many);
        std::vector<Aabb> list;
        for (const Move& m : boxes) list.push_back(m.box);
        RowSet serial_moves, serial_list;
        ASSERT_TRUE(serial_moves.build(boxes, {}));
        ASSERT_TRUE(serial_list.build(list, {}));
        ASSERT_EQ(serial_moves.broken_invariant(boxes), "");
        for (const int threads : {2, 3, 8}) {
            const auto tasks = make_thread_runner(threads);
            RowSet moves, of_list;
            for (int step = 0; step < 2; ++step) {  // reuses the memory of the previous step
                ASSERT_TRUE(moves.build(boxes, {}, tasks.get()));
                EXPECT_EQ(moves.broken_invariant(boxes), "");
                EXPECT_TRUE(same(records(moves), records(serial_moves))) << threads;
                ASSERT_TRUE(of_list.build(list, {}, tasks.get()));
                EXPECT_TRUE(same(records(of_list), records(serial_list))) << threads;
            }
        }
    }
}

TEST(RowSetParallel, AcceptsThreadsWithoutCellsWhenAllBoxesAreInOneCell) {
    std::vector<Move> boxes = gas(many, 7);
    for (Move& m : boxes) m.box = boxes[0].box;
    boxes.back().box = {boxes[0].box.lo + Vec3{90, 90, 90}, boxes[0].box.hi + Vec3{90, 90, 90}};
    RowSet serial, parallel;
    ASSERT_TRUE(serial.build(boxes, {}));
    ASSERT_TRUE(parallel.build(boxes, {}, make_thread_runner(8).get()));
    EXPECT_EQ(parallel.broken_invariant(boxes), "");
    EXPECT_TRUE(same(records(parallel), records(serial)));
}

TEST(RowSetParallel, RefusesAnUnboundedBox) {
    const auto tasks = make_thread_runner(2);
    for (const std::size_t at : {std::size_t{0}, many / 2, many - 1}) {
        std::vector<Move> boxes = gas(many, 3);
        boxes[at].box = Aabb::everything();
        RowSet set;
        EXPECT_FALSE(set.build(boxes, {}, tasks.get())) << at;
        EXPECT_EQ(set.size(), 0u);
        boxes[at].box = boxes[1].box;
        EXPECT_TRUE(set.build(boxes, {}, tasks.get()));
        EXPECT_EQ(set.broken_invariant(boxes), "");
    }
}

TEST(RowSetParallel, ChoosesNewCellsWhenAllBoxesHaveMovedAway) {
    const auto tasks = make_thread_runner(2);
    std::vector<Move> boxes = gas(many, 3);
    RowSet set;
    ASSERT_TRUE(set.build(boxes, {}, tasks.get()));
    const float before = set.levels().front().origin[0];
    for (Move& m : boxes) m.box = {m.box.lo + Vec3{500, 0, 0}, m.box.hi + Vec3{500, 0, 0}};
    ASSERT_TRUE(set.build(boxes, {}, tasks.get()));
    EXPECT_EQ(set.broken_invariant(boxes), "");
    EXPECT_GT(set.levels().front().origin[0], before + 400);
}

}  // namespace
}  // namespace fase::broad
