// A maze that never changes: trees fitted to its walls once, then only asked. Who sees whom across it?
#include <cstdio>
#include <vector>

#include "fase/broad/bsp.hpp"
#include "fase/broad/kd_tree.hpp"
#include "fase/core/random.hpp"
#include "fase/query/batch.hpp"

/// Walls of 1 m, along x or z, on a grid of 40 by 40 places; about one place in three has one.
std::vector<fase::broad::Move> maze() {
    fase::Random random(11);
    std::vector<fase::broad::Move> walls;
    for (float x = 0; x < 40; ++x) {
        for (float z = 0; z < 40; ++z) {
            const bool along_x = random.below(2) == 0;
            if (random.below(3) != 0) continue;
            const fase::Vec3 size = along_x ? fase::Vec3{1, 2, 0.1f} : fase::Vec3{0.1f, 2, 1};
            walls.push_back({static_cast<fase::broad::Proxy>(walls.size()), {{x, 0, z}, fase::Vec3{x, 0, z} + size}});
        }
    }
    return walls;
}

template <fase::broad::Structure Tree> int count_sight(const std::vector<fase::broad::Move>& walls) {
    Tree tree;
    tree.build(walls);
    fase::Random random(12);
    const auto place = [&] { return fase::Vec3d{random.between(0, 40), 1.6, random.between(0, 40)}; };
    std::vector<fase::Ray> sights;
    for (int i = 0; i < 1000; ++i) {
        const fase::Vec3d from = place(), way = place() - from;
        const double distance = fase::length(way);
        sights.push_back({from, fase::to_float(way * (1 / distance)), static_cast<float>(distance)});
    }
    std::vector<std::uint8_t> blocked;
    const auto tasks = fase::make_thread_runner(2);
    fase::query::any_hits(*tasks, tree, sights, blocked);
    int seen = 0;
    for (const std::uint8_t wall_between : blocked) seen += wall_between == 0 ? 1 : 0;
    std::printf("%-9s %zu walls, %d of 1000 see each other\n", Tree::info.name.data(), tree.size(), seen);
    return seen;
}

int main() {
    const auto walls = maze();
    const int by_faces = count_sight<fase::broad::Bsp>(walls), fitted = count_sight<fase::broad::KdTree>(walls);
    return by_faces == fitted ? 0 : 1;
}
