#pragma once
/// Sets of boxes that are hard for plane trees, and checks of a tree.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <map>

#include "fase/broad/stats.hpp"
#include "tests/broad/drawn_boxes.hpp"

namespace fase::broad {

inline std::vector<Move> numbered(const std::vector<Aabb>& boxes) {
    std::vector<Move> moves;
    for (const Aabb& box : boxes) moves.push_back({static_cast<Proxy>(moves.size()), box});
    return moves;
}
inline std::vector<Move> standing_cubes(std::size_t count, float world, std::uint64_t seed) {
    Random random(seed);
    std::vector<Aabb> boxes;
    for (std::size_t i = 0; i < count; ++i) boxes.push_back(cube(place(random, 0, world)));
    return numbered(boxes);
}

/// Sets that make trees deep, large or slow, by name; 1,200 boxes each.
inline std::map<std::string, std::vector<Move>> hard_sets() {
    constexpr int count = 1200;
    Random random(31);
    std::map<std::string, std::vector<Aabb>> sets;
    for (int i = 0; i < count; ++i) {
        const auto number = static_cast<float>(i + 1);
        const Vec3 half{number, number, number}, at = place(random, 0, 40);
        sets["coincident"].push_back(cube({1, 2, 3}));
        sets["nested, even sizes"].push_back({-half, half});
        const float doubled = std::ldexp(1.0f, i % 110 - 55);
        sets["nested, doubling sizes"].push_back({Vec3{-doubled, -doubled, -doubled}, {doubled, doubled, doubled}});
        sets["one corner in common"].push_back({{0, 0, 0}, half});
        Vec3 needle{1e-4f, 1e-4f, 1e-4f};
        needle[i % 3] = 100;
        sets["needles across all"].push_back({at - needle, at + needle});
        sets["half of all is huge"].push_back(i % 2 == 0 ? cube(at) : cube(at - Vec3{1e6f, 1e6f, 1e6f}, 2e6f));
        const auto lattice = [](int n) { return static_cast<float>(n); };
        sets["touching lattice"].push_back(cube({lattice(i % 14), lattice(i / 14 % 14), lattice(i / 196)}));
        sets["points on a line"].push_back({{number, 0, 0}, {number, 0, 0}});
        sets["plates in one plane"].push_back({{at.x, 5, at.z}, {at.x + 1, 5, at.z + 1}});
        sets["steps of growing size"].push_back({{doubled, 0, 0}, {2 * doubled, doubled, doubled}});
    }
    std::map<std::string, std::vector<Move>> numbered_sets;
    for (const auto& [name, boxes] : sets) numbered_sets[name] = numbered(boxes);
    return numbered_sets;
}

/// A region that counts its box tests.
struct CountingRegion {
    Aabb box;
    std::size_t& tests;
    [[nodiscard]] bool touches(const Aabb& other) const {
        ++tests;
        return overlaps(box, other);
    }
    [[nodiscard]] bool contains(const Aabb& other) const { return fase::contains(box, other); }
    [[nodiscard]] Aabb bounds() const { return box; }
};

/// Checks a plane tree over any set: correct pairs, each box in one leaf, bounded memory and depth.
template <class S> void expect_sound(S& structure, const std::vector<Move>& boxes) {
    structure.build(boxes);
    ASSERT_EQ(structure.broken_invariant(), "");
    const StructureStats stats = stats_of(structure);
    EXPECT_EQ(stats.entries, boxes.size());
    EXPECT_LE(stats.nodes, 2 * boxes.size());
    EXPECT_LT(stats.depth, 100);
    EXPECT_LT(stats.bytes, 400 * boxes.size() + 4096);
    EXPECT_TRUE(sorted_pairs(structure) == reference_pairs(boxes));
}

/// Reads the boxes of a third-party file of `min max` lines; empty when the file is missing.
inline std::vector<Move> boxes_from_file(const std::string& file) {
    std::ifstream text(std::filesystem::path(FASE_SHARED_DATA) / "trees" / file);
    std::vector<Aabb> boxes;
    Aabb box;
    while (text >> box.lo.x >> box.lo.y >> box.lo.z >> box.hi.x >> box.hi.y >> box.hi.z) boxes.push_back(box);
    return numbered(boxes);
}

}  // namespace fase::broad
