#include "fase/broad/row_grid_set.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>

#include "fase/broad/brute_force.hpp"
#include "fase/broad/find_pairs.hpp"
#include "fase/broad/row_grid_kernels.hpp"
#include "fase/broad/row_grid_walk.hpp"
#include "fase/core/random.hpp"

namespace fase::broad {
namespace {

using Rows = RowGridSettings::Rows;

Vec3 place(Random& random, float from, float to) {
    const float x = random.between(from, to), y = random.between(from, to), z = random.between(from, to);
    return {x, y, z};
}
std::vector<Pair> sorted(std::vector<Pair> pairs) {
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

RC_GTEST_PROP(RowSetProperty, ShowsNoSearchARecordThatIsKilled, ()) {
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
        set.kill(i);
    }
    RC_ASSERT(set.broken_invariant(boxes) == "");
    RC_ASSERT(set.dead() + boxes.size() == set.size());
    BruteForce judge;
    for (const Move& m : boxes) judge.insert(m.proxy, m.box);

    std::vector<Pair> expected, found;
    find_pairs(judge, expected);
    {
        row_grid::PairBlock block(found);
        row_grid::find_own_pairs(set.view(), 0, set.size(), block);
    }
    RC_ASSERT(sorted(found) == sorted(expected));

    std::vector<Move> askers{{1000, Aabb::everything()}};
    for (Proxy p = 1001; p < 1020; ++p) askers.push_back({p, draw()});
    expected.clear();
    found.clear();
    find_pairs_of(judge, askers, expected);
    {
        row_grid::PairBlock block(found);
        row_grid::find_asked_pairs(set.view(), {askers, {}}, block);
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

}  // namespace
}  // namespace fase::broad
