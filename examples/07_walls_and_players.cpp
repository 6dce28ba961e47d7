// Two indexes: static walls, built once, and moving players. The players query the walls' index.
#include <cstdio>

#include "fase/broad/bsp.hpp"
#include "fase/query/index.hpp"

struct Player {
    const char* name;
    fase::Vec3 position, velocity;
};
struct Wall {
    const char* name;
};
constexpr float radius = 0.5f;
fase::Aabb box_of(const Player& p) { return fase::enlarged({p.position, p.position}, radius); }

/// Moves a player out of a wall along the axis of least penetration, and removes the velocity into the wall.
void push_out(Player& player, const fase::Aabb& wall) {
    const fase::Aabb mine = box_of(player);
    int axis = 0;
    float depth = fase::Aabb::infinity, push = 0;
    for (const int i : {0, 2}) {
        const float up = wall.hi[i] - mine.lo[i], down = mine.hi[i] - wall.lo[i];
        if (up < depth) depth = up, push = up, axis = i;
        if (down < depth) depth = down, push = -down, axis = i;
    }
    player.position[axis] += push;
    if (player.velocity[axis] * push < 0) player.velocity[axis] = 0;
}

int main() {
    fase::Index<Wall, fase::broad::Bsp> walls;
    walls.insert({{0, 0, 0}, {10, 3, 1}}, {"south wall"});
    walls.insert({{0, 0, 9}, {10, 3, 10}}, {"north wall"});
    walls.insert({{9, 0, 0}, {10, 3, 10}}, {"east wall"});
    walls.commit();  // builds the tree, once

    fase::Index<Player> players;  // move() sets their boxes
    players.insert(fase::Aabb{}, {"red", {2, 1, 5}, {3, 0, 1}});
    players.insert(fase::Aabb{}, {"blue", {6, 1, 3}, {-0.5f, 0, -1}});
    for (int frame = 0; frame < 180; ++frame) {
        players.for_each([&](auto id, Player& p) {
            p.position += p.velocity * (1.0f / 60);
            players.move(id, box_of(p));
        });
        players.commit();
        players.pairs_with(walls, [&](auto, Player& player, auto id, Wall& wall) {
            const fase::Vec3 before = player.velocity;
            push_out(player, walls.box(id));
            if (player.velocity != before) std::printf("frame %3d: %s hits the %s\n", frame, player.name, wall.name);
        });
    }
    players.for_each([](Player& p) { std::printf("%s ends at (%.2f, %.2f)\n", p.name, p.position.x, p.position.z); });
    std::printf("%zu walls, %zu players\n", walls.size(), players.size());
}
