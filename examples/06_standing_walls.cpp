// A static maze: trees are built once for its walls, queried for lines of sight, and built again when walls fall.
#include <cstdio>
#include <vector>

#include "fase/broad/bsp.hpp"
#include "fase/broad/kd_tree.hpp"
#include "fase/core/random.hpp"
#include "fase/query/batch.hpp"

/// Returns walls of 1 m, along x or z, in about one third of the cells of a 40 by 40 grid.
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

template <fase::broad::Structure Tree> int print(const Tree& tree, const std::vector<std::uint8_t>& blocked) {
    int visible = 0;
    for (const std::uint8_t is_blocked : blocked) visible += is_blocked == 0 ? 1 : 0;
    std::printf("%-9s %zu walls, %d of 1000 see each other\n", Tree::info.name.data(), tree.size(), visible);
    return visible;
}

template <fase::broad::Structure Tree> int count_visible(const std::vector<fase::broad::Move>& walls) {
    Tree tree;
    tree.build(walls);
    fase::Random random(12);
    const auto point = [&] { return fase::Vec3d{random.between(0, 40), 1.6, random.between(0, 40)}; };
    std::vector<fase::Ray> lines_of_sight;
    for (int i = 0; i < 1000; ++i) {
        const fase::Vec3d from = point(), path = point() - from;
        const double distance = fase::length(path);
        lines_of_sight.push_back({from, fase::to_float(path * (1 / distance)), static_cast<float>(distance)});
    }
    std::vector<std::uint8_t> blocked;
    const auto tasks = fase::make_thread_runner(2);
    fase::query::any_hits(*tasks, tree, lines_of_sight, blocked);
    const int visible = print(tree, blocked);
    // A bomb destroys the walls in a square of 12 m: the next commit() builds the whole tree again.
    for (const auto& [proxy, box] : walls)
        if (fase::overlaps(box, {{14, 0, 14}, {26, 2, 26}})) tree.erase(proxy);
    tree.commit();
    fase::query::any_hits(*tasks, tree, lines_of_sight, blocked);
    return visible + print(tree, blocked);
}

int main() {
    const auto walls = maze();
    const int bsp = count_visible<fase::broad::Bsp>(walls), kd_tree = count_visible<fase::broad::KdTree>(walls);
    return bsp == kd_tree ? 0 : 1;
}
