// A program that needs fase::collision alone: an index of values, pairs of boxes, and a contact of two shapes.
#include <cstdio>

#include "fase/broad/row_grid.hpp"
#include "fase/collision.hpp"

int main() {
    fase::Index<int> index;
    for (int i = 0; i < 10; ++i) {
        const float x = 0.75f * static_cast<float>(i);
        index.insert({{x, 0, 0}, {x + 1, 1, 1}}, i);
    }
    index.commit();
    int pairs = 0;
    index.pairs([&](int&, int&) { ++pairs; });
    const auto tasks = fase::make_thread_runner(2);
    int chunks = 0;
    fase::make_serial_runner()->run(3, [&](std::size_t) { ++chunks; });
    std::printf("%d pairs of neighbours, %d threads\n", pairs, tasks->threads());
    return pairs == 9 && chunks == 3 ? 0 : 1;
}
