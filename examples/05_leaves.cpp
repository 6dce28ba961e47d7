// The leaves of a quadtree: visiting the values of each leaf, pairs in several leaves, many boxes in one place.
#include <cstdio>

#include "fase/broad/quadtree.hpp"
#include "fase/broad/stats.hpp"
#include "fase/core/random.hpp"
#include "fase/query/index.hpp"

using fase::broad::Quadtree;
using Yard = fase::Index<int, Quadtree>;

/// Covers a square of 64 m. A leaf with more than 2 boxes splits when that saves tests, down to depth 6 (1 m squares).
Yard empty_yard() { return Yard(Quadtree({.capacity = 2, .max_depth = 6, .bounds = {{{0, -1, 0}, {64, 1, 64}}}})); }

fase::Aabb box_at(float x, float z) { return {{x - 1, 0, z - 1}, {x + 1, 1, z + 1}}; }

void print(const char* what, Yard& yard) {
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
    print("two", yard);
    yard.insert(box_at(20, 44), 2);
    print("a third: root splits", yard);
    yard.insert(box_at(32, 12), 3);
    print("one across the border", yard);

    yard.clear();
    fase::Random random(1);
    for (int i = 0; i < 100; ++i) {
        const float x = random.between(1, 63), z = random.between(1, 63);
        yard.insert(box_at(x, z), i);
    }
    print("a hundred, spread", yard);

    yard.clear();
    for (int i = 0; i < 100; ++i) yard.insert(box_at(40, 40), i);
    print("a hundred in one place", yard);
}
