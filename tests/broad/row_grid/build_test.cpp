#include <gtest/gtest.h>

#include <algorithm>

#include "fase/broad/boxes/box_store.hpp"
#include "fase/broad/row_grid/set.hpp"
#include "tests/broad/drawn_boxes.hpp"
#include "tests/conformance/scenes.hpp"

namespace fase::broad {
namespace {

std::vector<Move> drawn(const conformance::Scene& scene, std::size_t count) {
    Random random(6);
    std::vector<Move> boxes;
    while (boxes.size() < count)
        if (const Aabb box = scene.draw(random); is_regular(box))
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

/// So many that threads share them.
constexpr std::size_t many = 33000;

TEST(RowSetShared, StoresTheSameForAnyNumberOfThreads) {
    for (const conformance::Scene& scene : conformance::all_scenes()) {
        SCOPED_TRACE(scene.name);
        const std::vector<Move> boxes = drawn(scene, many);
        std::vector<Aabb> list;
        for (const Move& m : boxes) list.push_back(m.box);
        RowSet moves_alone, list_alone;
        ASSERT_TRUE(moves_alone.build(boxes, {}));
        ASSERT_TRUE(list_alone.build(list, {}));
        ASSERT_EQ(moves_alone.broken_invariant(boxes), "");
        for (const int threads : {2, 3, 8}) {
            const auto tasks = make_thread_runner(threads);
            RowSet moves, of_list;
            for (int step = 0; step < 2; ++step) {  // with the memory of the last one
                ASSERT_TRUE(moves.build(boxes, {}, tasks.get()));
                EXPECT_EQ(moves.broken_invariant(boxes), "");
                EXPECT_TRUE(same(records(moves), records(moves_alone))) << threads;
                ASSERT_TRUE(of_list.build(list, {}, tasks.get()));
                EXPECT_TRUE(same(records(of_list), records(list_alone))) << threads;
            }
        }
    }
}

TEST(RowSetShared, LeavesThreadsWithoutAShareWhereAllBoxesAreInOneCell) {
    std::vector<Move> boxes = gas(many, 7);
    for (Move& m : boxes) m.box = boxes[0].box;
    boxes.back().box = {boxes[0].box.lo + Vec3{90, 90, 90}, boxes[0].box.hi + Vec3{90, 90, 90}};
    RowSet alone, shared;
    ASSERT_TRUE(alone.build(boxes, {}));
    ASSERT_TRUE(shared.build(boxes, {}, make_thread_runner(8).get()));
    EXPECT_EQ(shared.broken_invariant(boxes), "");
    EXPECT_TRUE(same(records(shared), records(alone)));
}

TEST(RowSetShared, TellsOfABoxThatNoGridCanHold) {
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

TEST(RowSetShared, ChoosesTheCellsAnewWhereBoxesHaveGoneElsewhere) {
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
