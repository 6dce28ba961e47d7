// Two structures: walls that are put in once, players that move. A player asks the walls without becoming one.
#include <cstdio>

#include "fase/broad/bsp.hpp"
#include "fase/query/index.hpp"

struct Player {
    const char* name;
    fase::Vec3 at, velocity;
};
struct Wall {
    const char* name;
};
constexpr float radius = 0.5f;
fase::Aabb box_of(const Player& p) { return fase::grown({p.at, p.at}, radius); }

/// Out of the wall along the axis where least is needed, and no faster into it.
void push_out(Player& player, const fase::Aabb& wall) {
    const fase::Aabb mine = box_of(player);
    int axis = 0;
    float least = fase::Aabb::infinity, by = 0;
    for (const int i : {0, 2}) {
        const float up = wall.hi[i] - mine.lo[i], down = mine.hi[i] - wall.lo[i];
        if (up < least) least = up, by = up, axis = i;
        if (down < least) least = down, by = -down, axis = i;
    }
    player.at[axis] += by;
    if (player.velocity[axis] * by < 0) player.velocity[axis] = 0;
}

int main() {
    fase::Index<Wall, fase::broad::Bsp> walls;
    walls.insert({{0, 0, 0}, {10, 3, 1}}, {"south wall"});
    walls.insert({{0, 0, 9}, {10, 3, 10}}, {"north wall"});
    walls.insert({{9, 0, 0}, {10, 3, 10}}, {"east wall"});
    walls.commit();  // built here, and never again

    fase::Index<Player> players;  // their boxes come with their first move
    players.insert({}, {"red", {2, 1, 5}, {3, 0, 1}});
    players.insert({}, {"blue", {6, 1, 3}, {-0.5f, 0, -1}});
    for (int frame = 0; frame < 180; ++frame) {
        players.for_each([&](auto id, Player& p) {
            p.at += p.velocity * (1.0f / 60);
            players.move(id, box_of(p));
        });
        players.commit();
        players.pairs_with(walls, [&](auto, Player& player, auto wall, Wall& what) {
            const fase::Vec3 before = player.velocity;
            push_out(player, walls.box(wall));
            if (player.velocity != before) std::printf("frame %3d: %s meets the %s\n", frame, player.name, what.name);
        });
    }
    players.for_each([](Player& p) { std::printf("%s ends at (%.2f, %.2f)\n", p.name, p.at.x, p.at.z); });
    std::printf("%zu walls, %zu players\n", walls.size(), players.size());
}
