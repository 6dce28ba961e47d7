// What a quadtree is inside: a function called on each leaf's contents, pairs in several leaves, all boxes in one
// place.
#include <cstdio>

#include "fase/broad/quadtree.hpp"
#include "fase/broad/stats.hpp"
#include "fase/core/random.hpp"
#include "fase/query/index.hpp"

using fase::broad::Quadtree;
using Yard = fase::Index<int, Quadtree>;

/// A square of 64 m; a leaf that holds more than 2 splits where that pays, down to depth 6: squares of 1 m.
Yard empty_yard() { return Yard(Quadtree({.capacity = 2, .max_depth = 6, .bounds = {{{0, -1, 0}, {64, 1, 64}}}})); }

fase::Aabb box_at(float x, float z) { return {{x - 1, 0, z - 1}, {x + 1, 1, z + 1}}; }

void tell(const char* what, Yard& yard) {
    yard.commit();
    int tests = 0, unique = 0;
    yard.for_each_leaf([&](const Yard::Leaf& leaf) { tests += static_cast<int>(leaf.size() * (leaf.size() - 1) / 2); });
    yard.pairs([&](int, int) { ++unique; });
    const auto stats = fase::broad::stats_of(yard.structure());
    std::printf("%-22s %3zu boxes, %4zu leaves, depth %d, fullest %3zu; %4d tests in the leaves, %d pairs\n", what,
                stats.boxes, stats.leaves, stats.depth, stats.largest_leaf, tests, unique);
}

int main() {
    Yard yard = empty_yard();
    yard.insert(box_at(10, 10), 0);
    yard.insert(box_at(50, 12), 1);
    tell("two", yard);
    yard.insert(box_at(20, 44), 2);
    tell("a third: root splits", yard);
    yard.insert(box_at(32, 12), 3);
    tell("one astride", yard);

    yard.clear();
    fase::Random random(1);
    for (int i = 0; i < 100; ++i) {
        const float x = random.between(1, 63), z = random.between(1, 63);
        yard.insert(box_at(x, z), i);
    }
    tell("a hundred, spread", yard);

    yard.clear();
    for (int i = 0; i < 100; ++i) yard.insert(box_at(40, 40), i);
    tell("a hundred in one place", yard);
}
