#include "fase/broad/search/plain_sweep.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/conformance/scenes.hpp"

namespace fase::broad {
namespace {

TEST(PlainSweep, FindsTheSamePairsAsTestsOfAllPairs) {
    for (const conformance::Scene& scene : conformance::all_scenes()) {
        SCOPED_TRACE(scene.name);
        Random random(11);
        std::vector<Move> moves;
        for (Proxy p = 0; p < 300; ++p) moves.push_back({p, scene.draw(random)});
        std::vector<Pair> pairs;
        find_pairs_by_sweep(moves, pairs);
        std::sort(pairs.begin(), pairs.end());
        std::vector<Pair> expected;
        for (const Move& a : moves)
            for (const Move& b : moves)
                if (a.proxy < b.proxy && overlaps(a.box, b.box)) expected.push_back({a.proxy, b.proxy});
        EXPECT_TRUE(pairs == expected) << pairs.size() << " pairs; expected " << expected.size();
    }
}

TEST(PlainSweep, SkipsPairsThatTheFilterRejects) {
    const std::vector<Move> same(4, Move{0, {{0, 0, 0}, {1, 1, 1}}});
    std::vector<Move> moves = same;
    for (Proxy p = 0; p < 4; ++p) moves[p].proxy = p;
    std::vector<Pair> pairs;
    find_pairs_by_sweep(moves, pairs, [](Proxy p, Proxy q) { return (p + q) % 2 == 0; });
    std::sort(pairs.begin(), pairs.end());
    EXPECT_EQ(pairs, (std::vector<Pair>{{0, 2}, {1, 3}}));
}

}  // namespace
}  // namespace fase::broad
