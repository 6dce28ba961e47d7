/// Point location, front-to-back order, cones and rays in levels.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>

#include "fase/level/level_order.hpp"
#include "tests/level/freedoom.hpp"

namespace fase::level {
namespace {

std::pair<int, int> default_room(char) { return {0, 128}; }

std::vector<Level> levels() {
    std::vector<Level> all = freedoom_levels({"e1m1.wad", "map07.wad", "map29.wad"});
    Map map = grid_map({"aaaa aaa", "a  bbb a", "aaaa aca", "  a   a ", "aaaaaaaa"}, [](char c) {
        return c == 'b' ? std::pair{24, 96} : c == 'c' ? std::pair{64, 64} : std::pair{0, 128};
    });
    auto bsp = compile(map);
    all.push_back({"grid", std::move(map), *std::move(bsp)});
    return all;
}

/// Returns the sector of a point by the nearest line to its east: the reference, without a tree. The outer nullopt
/// means too close to a line, the inner one outside.
std::optional<std::optional<std::uint32_t>> sector_by_lines(const Map& map, Point p) {
    double nearest = 1e30;
    std::optional<std::uint32_t> sector;
    for (const Line& line : map.lines) {
        const Vertex a = map.vertices[line.from], b = map.vertices[line.to];
        const double dx = b.x - a.x, dy = b.y - a.y, length = std::sqrt(dx * dx + dy * dy);
        const double share = std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / (length * length), 0.0, 1.0);
        if (std::hypot(p.x - a.x - share * dx, p.y - a.y - share * dy) < 0.01) return std::nullopt;
        if ((a.y > p.y) == (b.y > p.y)) continue;
        const double x = a.x + (p.y - a.y) / dy * dx;
        if (x < p.x || x >= nearest) continue;
        nearest = x;
        const std::uint16_t side = dy > 0 ? line.left : line.right;  // the one that faces west
        sector = side == no_side ? std::nullopt : std::optional<std::uint32_t>(map.sides[side].sector);
    }
    return sector;
}

TEST(LevelPlace, FindsTheSectorByLines) {
    for (const Level& level : levels()) {
        const PlanBox box = box_of(level.bsp);
        Random random(1);
        std::size_t inside = 0, wrong = 0, tested = 0;
        for (int i = 0; i < 20000; ++i) {
            const Point p = point_in(box, random);
            const auto expected = sector_by_lines(level.map, p);
            if (!expected) continue;
            ++tested;
            const auto found = sector_at(level.bsp, p);
            inside += found ? 1 : 0;
            wrong += found == *expected ? 0 : 1;
        }
        EXPECT_GT(inside, 2000u) << level.name;
        EXPECT_GT(tested, 18000u) << level.name;
        // Real maps have a few flipped lines, where the reference is wrong.
        EXPECT_LE(wrong, level.name == "grid" ? 0u : tested / 200) << level.name;
    }
}

TEST(LevelPlace, ReturnsNulloptOutsideAndForNan) {
    for (const Level& level : levels()) {
        const double nan = std::numeric_limits<double>::quiet_NaN();
        EXPECT_FALSE(sub_sector_at(level.bsp, {1e6, 1e6}));
        EXPECT_FALSE(sub_sector_at(level.bsp, {-1e300, 1e300}));
        EXPECT_FALSE(sub_sector_at(level.bsp, {nan, nan}));
    }
}

TEST(LevelPlace, FindsTheMiddleOfEachSubSectorInside) {
    for (const Level& level : levels())
        for (const SubSector& s : level.bsp.sub_sectors)
            if (s.edges > 0) {
                EXPECT_TRUE(is_within(level.bsp, s, middle_of(level.bsp, s)));
            }
}

TEST(LevelOrder, VisitsNearSubSectorsFirst) {
    for (const Level& level : levels()) {
        const PlanBox box = box_of(level.bsp);
        Random random(2);
        for (int i = 0; i < 60; ++i) {
            LevelRay ray = ray_inside(level, box, random);
            std::vector<std::size_t> position(level.bsp.sub_sectors.size(), 0);
            std::size_t next = 0;
            front_to_back(level.bsp, ray.from, [&](std::uint32_t s) {
                position[s] = ++next;
                return true;
            });
            EXPECT_EQ(next, level.bsp.sub_sectors.size());
            EXPECT_EQ(std::count(position.begin(), position.end(), std::size_t{0}), 0);
            for (int k = 0; k < 40; ++k) {
                ray.direction = {double(random.between(-1, 1)), double(random.between(-1, 1))};
                std::vector<Passage> path;
                passages(level.bsp, level.map, ray, Heights::Ignored, path);
                ASSERT_FALSE(path.empty());
                for (std::size_t w = 1; w < path.size(); ++w) {
                    if (path[w].to - path[w].from > 1e-6 && path[w - 1].to - path[w - 1].from > 1e-6) {
                        EXPECT_LT(position[path[w - 1].sub_sector], position[path[w].sub_sector]) << level.name;
                    }
                }
            }
        }
    }
}

TEST(LevelOrder, StopsWhenVisitReturnsFalse) {
    for (const Level& level : levels()) {
        int calls = 0;
        front_to_back(level.bsp, {0, 0}, [&](std::uint32_t) { return ++calls < 3; });
        EXPECT_EQ(calls, 3);
    }
}

TEST(LevelOrder, FindsAllSubSectorsThatOverlapACone) {
    for (const Level& level : levels()) {
        const PlanBox box = box_of(level.bsp);
        Random random(3);
        for (int i = 0; i < 40; ++i) {
            const Point eye = point_in(box, random);
            const Point ahead{double(random.between(-1, 1)), double(random.between(-1, 1))};
            const ViewCone cone = ViewCone::around(eye, ahead, double(random.between(0.05f, 3)));
            std::vector<std::uint8_t> found(level.bsp.sub_sectors.size(), 0);
            within_cone(level.bsp, cone, [&](std::uint32_t s) {
                EXPECT_EQ(found[s], 0);
                found[s] = 1;
                return true;
            });
            for (int k = 0; k < 300; ++k) {
                const Point p = point_in(box, random);
                const auto s = sub_sector_at(level.bsp, p);
                if (s && cone.contains(p)) {
                    EXPECT_EQ(found[*s], 1) << level.name;
                }
            }
            // And none that is completely on the wrong side of an edge.
            for (std::uint32_t s = 0; s < found.size(); ++s) {
                bool all_right = true, all_left = true;
                for (const Seg& seg : level.bsp.edges(level.bsp.sub_sectors[s])) {
                    all_right = all_right && cone.from_right(level.bsp.vertices[seg.from]) < 0;
                    all_left = all_left && cone.from_left(level.bsp.vertices[seg.from]) > 0;
                }
                if (all_right || all_left) {
                    EXPECT_EQ(found[s], 0);
                }
            }
        }
    }
}

/// The first obstacle on a ray.
struct Expected {
    double distance;
    Barrier barrier;
};
/// Finds the first obstacle by the lines of the map alone, sector after sector. nullopt: too close to a corner to
/// decide.
std::optional<Expected> stop_by_lines(const Level& level, const LevelRay& ray, Heights heights) {
    struct Crossing {
        double distance;
        std::uint32_t line;
        bool from_right;
    };
    std::vector<Crossing> crossings;
    for (std::uint32_t l = 0; l < level.map.lines.size(); ++l) {
        const Vertex va = level.map.vertices[level.map.lines[l].from], vb = level.map.vertices[level.map.lines[l].to];
        const Point a{double(va.x), double(va.y)}, b{double(vb.x), double(vb.y)};
        const double sa = ray.direction.x * (a.y - ray.from.y) - ray.direction.y * (a.x - ray.from.x);
        const double sb = ray.direction.x * (b.y - ray.from.y) - ray.direction.y * (b.x - ray.from.x);
        if (std::abs(sa) < 1e-4 || std::abs(sb) < 1e-4) return std::nullopt;
        if ((sa > 0) == (sb > 0)) continue;
        const double distance = orient2d(b, a, ray.from) / (sa - sb);
        if (distance > 0) crossings.push_back({distance, l, orient2d(a, b, ray.from) < 0});
    }
    std::sort(crossings.begin(), crossings.end(),
              [](const Crossing& a, const Crossing& b) { return a.distance < b.distance; });
    for (const Crossing& c : crossings) {
        const Line& line = level.map.lines[c.line];
        const std::uint16_t here = c.from_right ? line.right : line.left, there = c.from_right ? line.left : line.right;
        if (here == no_side) return std::nullopt;
        const Opening room = opening_of(level.map, level.map.sides[here].sector);
        if (heights == Heights::Counted) {
            const double floor = (room.floor - ray.z) / ray.rise, ceiling = (room.ceiling - ray.z) / ray.rise;
            if (ray.rise < 0 && floor < c.distance) return Expected{floor, Barrier::Floor};
            if (ray.rise > 0 && ceiling < c.distance) return Expected{ceiling, Barrier::Ceiling};
        }
        if (there == no_side) return Expected{c.distance, Barrier::Wall};
        if (heights == Heights::Ignored) continue;
        const Opening next = opening_of(level.map, level.map.sides[there].sector);
        const double z = ray.z + ray.rise * c.distance;
        if (!next.is_open() || z < next.floor || z > next.ceiling)
            return Expected{c.distance, z < std::max(room.floor, next.floor) ? Barrier::Below : Barrier::Above};
    }
    return std::nullopt;
}

TEST(LevelRay, StopsAtTheLinesOfTheMap) {
    for (const Level& level : levels()) {
        const PlanBox box = box_of(level.bsp);
        Random random(4);
        std::map<Barrier, int> kinds;
        int tested = 0, wrong = 0;
        for (int i = 0; i < 3000; ++i) {
            const LevelRay ray = ray_inside(level, box, random);
            for (const Heights heights : {Heights::Ignored, Heights::Counted}) {
                const auto expected = stop_by_lines(level, ray, heights);
                if (!expected) continue;
                ++tested;
                const auto hit = cast_ray(level.bsp, level.map, ray, heights);
                ASSERT_TRUE(hit) << level.name;
                const bool same = std::abs(hit->distance - expected->distance) < 1e-6 * (1 + expected->distance) &&
                                  hit->barrier == expected->barrier;
                wrong += same ? 0 : 1;
                ++kinds[hit->barrier];
            }
        }
        EXPECT_GT(tested, 3000) << level.name;
        EXPECT_LE(wrong, level.name == "grid" ? 0 : tested / 200) << level.name;
        EXPECT_EQ(kinds.size(), 5u) << level.name;
    }
}

TEST(LevelRay, AgreesWithBruteForce) {
    for (const Level& level : levels()) {
        const PlanBox box = box_of(level.bsp);
        Random random(5);
        for (int i = 0; i < 1500; ++i) {
            LevelRay ray = ray_inside(level, box, random);
            if (i % 4 == 0) ray.from = point_in(box, random);
            if (i % 5 == 0) {  // straight at a corner
                const Point corner = level.bsp.vertices[random.below(level.bsp.vertices.size())];
                ray.direction = {corner.x - ray.from.x, corner.y - ray.from.y};
            }
            if (i % 7 == 0) ray.direction = {i % 2 == 0 ? 1.0 : 0.0, i % 2 == 0 ? 0.0 : -1.0};
            if (i % 11 == 0) ray.max_distance = 200;
            for (const Heights heights : {Heights::Ignored, Heights::Counted}) {
                const auto hit = cast_ray(level.bsp, level.map, ray, heights);
                const auto expected = cast_ray_brute_force(level.bsp, level.map, ray, heights);
                ASSERT_EQ(hit.has_value(), expected.has_value()) << level.name << " ray " << i;
                if (!hit) continue;
                EXPECT_EQ(hit->distance, expected->distance) << level.name << " ray " << i;
                EXPECT_EQ(hit->seg, expected->seg) << level.name << " ray " << i;
            }
        }
    }
}

TEST(LevelRay, NeverLeavesTheLevel) {
    for (const Level& level : levels()) {
        const PlanBox box = box_of(level.bsp);
        Random random(6);
        for (int i = 0; i < 5000; ++i) {
            LevelRay ray = ray_inside(level, box, random);
            const Point corner = level.bsp.vertices[random.below(level.bsp.vertices.size())];
            ray.direction = {corner.x - ray.from.x, corner.y - ray.from.y};
            EXPECT_TRUE(cast_ray(level.bsp, level.map, ray, Heights::Ignored)) << level.name;
        }
    }
}

TEST(LevelRay, PassesAWindowAndAStepButNotADoor) {
    // A row of squares: open, a window from 32 to 64, open, a step of 48, open, a closed door, open.
    const Map map = grid_map({"awasaca"}, [](char c) {
        return c == 'w'   ? std::pair{32, 64}
               : c == 's' ? std::pair{48, 128}
               : c == 'c' ? std::pair{0, 0}
                          : std::pair{0, 128};
    });
    const auto bsp = compile(map);
    ASSERT_TRUE(bsp);
    const auto cast = [&](double z, double rise) { return *cast_ray(*bsp, map, {{32, 32}, z, {1, 0}, rise}); };
    EXPECT_EQ(cast(20, 0).barrier, Barrier::Below);
    EXPECT_EQ(cast(20, 0).distance, 32);
    EXPECT_EQ(cast(70, 0).barrier, Barrier::Above);
    EXPECT_EQ(cast(40, 0).barrier, Barrier::Below);
    EXPECT_EQ(cast(40, 0).distance, 160);
    EXPECT_EQ(cast(50, 0).distance, 288);
    EXPECT_EQ(cast(50, 0).barrier, Barrier::Above);
    EXPECT_EQ(cast(50, -1).barrier, Barrier::Below);
    EXPECT_EQ(cast(50, -2).barrier, Barrier::Floor);
    EXPECT_EQ(cast(50, -2).distance, 25);
    EXPECT_EQ(cast(50, 4).barrier, Barrier::Ceiling);
    const auto free = cast_ray(*bsp, map, {{32, 32}, 50, {1, 0}, 0}, Heights::Ignored);
    ASSERT_TRUE(free);
    EXPECT_EQ(free->distance, 416);
    EXPECT_EQ(free->barrier, Barrier::Wall);
}

TEST(LevelRay, HandlesExtremeRays) {
    const Map map = grid_map({"aa"}, default_room);
    const auto bsp = compile(map);
    ASSERT_TRUE(bsp);
    const double nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    EXPECT_FALSE(cast_ray(*bsp, map, {{nan, 0}, 0, {1, 0}, 0}));
    EXPECT_FALSE(cast_ray(*bsp, map, {{32, 32}, 0, {inf, 0}, 0}));
    EXPECT_FALSE(cast_ray(*bsp, map, {{32, 32}, 64, {0, 0}, 0}));
    EXPECT_FALSE(cast_ray(*bsp, map, {{32, 32}, 64, {1, 0}, 0, 10}));
    const auto down = cast_ray(*bsp, map, {{32, 32}, 64, {0, 0}, -1});
    ASSERT_TRUE(down);
    EXPECT_EQ(down->barrier, Barrier::Floor);
    EXPECT_EQ(down->distance, 64);
}

}  // namespace
}  // namespace fase::level
