// Sleeping monsters behind a door: pairs of two sleepers are skipped, and so are branches where all sleep.
#include <cstdio>
#include <vector>

#include "fase/query/index.hpp"

struct Monster {
    float x, z;
};
using Level = fase::Index<Monster>;

fase::Aabb box_of(const Monster& m) { return {{m.x - 0.6f, 0, m.z - 0.6f}, {m.x + 0.6f, 2, m.z + 0.6f}}; }

void print(const char* when, Level& level) {
    int all = 0, awake = 0;
    level.pairs([&](Monster&, Monster&) { ++all; });
    level.awake_pairs([&](Monster&, Monster&) { ++awake; });
    std::printf("%-24s %4d pairs touch, %4d of them awake\n", when, all, awake);
}

int main() {
    Level level;
    std::vector<Level::Id> sleepers;
    for (int i = 0; i < 400; ++i) {  // a packed room: each touches its neighbours
        const Monster m{static_cast<float>(i % 20), static_cast<float>(i / 20)};
        sleepers.push_back(level.insert(box_of(m), m));
        level.set_awake(sleepers.back(), false);
    }
    const auto player = level.insert(fase::Aabb{}, {-3, 10});
    const auto walk_to = [&](float x) {
        level.value(player).x = x;
        level.move(player, box_of(level.value(player)));
        level.commit();
    };
    walk_to(-3);
    print("the door is shut:", level);

    walk_to(-1);
    print("the player at the door:", level);

    // The door opens: wake the monsters within 4 m of it.
    level.overlapping(fase::query::SphereRegion({-1, 1, 10}, 4),
                      [&](Level::Id id, Monster&) { level.set_awake(id, true); });
    level.commit();
    print("those near it wake:", level);

    for (const auto id : sleepers) level.set_awake(id, true);
    level.commit();
    print("all awake:", level);
}
