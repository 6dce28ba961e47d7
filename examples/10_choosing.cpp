// One scene in several structures, chosen by name: all give the same pairs and the same hits.
#include <cstdio>

#include "fase/broad/any_structure.hpp"
#include "fase/core/random.hpp"
#include "fase/query/cast_ray.hpp"

int main() {
    fase::Random random(5);
    std::vector<fase::broad::Move> boxes;  // 2000 crates on a plain of 80 m
    for (fase::broad::Proxy p = 0; p < 2000; ++p) {
        const fase::Vec3 at{random.between(0, 80), random.between(0, 1), random.between(0, 80)};
        boxes.push_back({p, {at, at + fase::Vec3{1, 1, 1}}});
    }
    const fase::Ray ray{{-1, 0.5, 40}, {1, 0, 0}, 100};
    for (const char* name : {"brute_force", "sweep_and_prune", "row_grid", "quadtree", "bsp", "dynamic_bvh"}) {
        auto structure = fase::broad::AnyStructure::named(name);
        if (!structure) return std::puts(structure.error().text().c_str()), 1;
        structure->build(boxes);
        std::vector<fase::broad::Pair> pairs;
        structure->find_pairs(pairs);
        const auto hit = fase::query::nearest_hit(*structure, ray);
        if (!hit) return 1;
        std::printf("%-16s %zu pairs, box %u after %.2f m\n", name, pairs.size(), hit->proxy, hit->distance);
    }
}
