/// Solid shapes of levels: free interiors, closed walls, bodies that stay inside.
#include "fase/level/level_solids.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "fase/geometry/bounds.hpp"
#include "fase/level/level_room.hpp"
#include "fase/world/world.hpp"
#include "tests/level/freedoom.hpp"

namespace fase::level {
namespace {

constexpr double scale = 1.0 / 32;

/// A ring of squares around a pillar, with a step, a pit and a low gap.
Level ring() {
    Level level{"ring",
                grid_map({"aaaaa", "a   a", "a s a", "a   l", "aapaa"},
                         [](char c) {
                             return c == 's'   ? std::pair{0, 128}
                                    : c == 'p' ? std::pair{-64, 128}
                                    : c == 'l' ? std::pair{24, 72}
                                               : std::pair{0, 128};
                         }),
                {}};
    level.bsp = *compile(level.map);
    return level;
}

/// Returns whether a point is inside a solid, deeper than `depth` metres.
bool in_solid(const LevelSolid& solid, Vec3d point, double depth) {
    const Vec3 p = rotate_back(solid.pose.rotation, to_float(point - to_double(solid.pose.position)));
    if (const Box* box = std::get_if<Box>(&solid.shape)) {
        const Vec3 inside = box->half - abs(p);
        return std::min({inside.x, inside.y, inside.z}) > depth;
    }
    for (const ConvexHull::Face& face : std::get<ConvexHull>(solid.shape).faces)
        if (signed_distance(face.plane, p) > -depth) return false;
    return true;
}

LevelSolids solids_of(const Level& level) {
    auto solids = make_solids(level.bsp, level.map);
    EXPECT_TRUE(solids);
    return *std::move(solids);
}

TEST(LevelSolids, LeaveTheInteriorFreeAndFillTheRest) {
    auto levels = freedoom_levels({"e1m1.wad"});
    levels.push_back(ring());
    for (const Level& level : levels) {
        const LevelSolids solids = solids_of(level);
        const PlanBox box = box_of(level.bsp);
        Random random(3);
        int free = 0, filled = 0;
        for (int i = 0; i < 3000; ++i) {
            const Point p = point_inside(level.bsp, box, random);
            const std::uint32_t sector = *sector_at(level.bsp, p);
            const Opening room = opening_of(level.map, sector);
            const double z = room.floor - 100 + (room.ceiling - room.floor + 200) * double(random.unit());
            const Vec3d place = to_world(p, z, scale);
            bool solid = false, deep = false;
            for (const LevelSolid& one : solids.solids) {
                solid = solid || in_solid(one, place, -0.003);
                deep = deep || in_solid(one, place, 0.003);
            }
            const bool in_room = z > room.floor && z < room.ceiling;
            if (in_room) {
                EXPECT_FALSE(deep) << level.name << " " << p.x << ", " << p.y << ", " << z;
                ++free;
            } else if (!is_under_sky(level.map, sector) || z < room.floor) {
                EXPECT_TRUE(solid) << level.name << " " << p.x << ", " << p.y << ", " << z;
                ++filled;
            }
        }
        EXPECT_GT(free, 500);
        EXPECT_GT(filled, 500);
    }
}

TEST(LevelSolids, HaveAWallBehindEachOneSidedLine) {
    auto levels = freedoom_levels({"e1m1.wad"});
    levels.push_back(ring());
    for (const Level& level : levels) {
        const LevelSolids solids = solids_of(level);
        for (const Line& line : level.map.lines) {
            if (line.left != no_side) continue;
            const Vertex a = level.map.vertices[line.from], b = level.map.vertices[line.to];
            const double dx = b.x - a.x, dy = b.y - a.y, length = std::sqrt(dx * dx + dy * dy);
            const Point behind{(a.x + b.x) / 2.0 - dy / length * 0.5, (a.y + b.y) / 2.0 + dx / length * 0.5};
            const Opening room = opening_of(level.map, level.map.sides[line.right].sector);
            const Vec3d place = to_world(behind, (room.floor + room.ceiling) / 2, scale);
            EXPECT_TRUE(std::any_of(solids.solids.begin(), solids.solids.end(),
                                    [&](const LevelSolid& one) { return in_solid(one, place, 0); }));
        }
    }
}

TEST(LevelSolids, HaveMeshesOfFloorsFromAboveAndWallsFromInside) {
    const Level level = ring();
    const LevelSolids solids = solids_of(level);
    ASSERT_EQ(solids.floors.size(), 1u);
    const TriangleMesh& floors = solids.floors.begin()->second;
    float area = 0;
    for (std::size_t t = 0; t < floors.indices.size(); t += 3) {
        const Vec3 a = floors.positions[floors.indices[t]];
        area +=
            0.5f * cross(floors.positions[floors.indices[t + 1]] - a, floors.positions[floors.indices[t + 2]] - a).y;
    }
    EXPECT_FLOAT_EQ(area, 17 * 4);  // squares of 2 m
    // The four walls of the closed chamber face its middle.
    const TriangleMesh& walls = solids.walls.begin()->second;
    const Vec3 middle = to_float(to_world({160, 160}, 64, scale));
    int near = 0;
    for (std::size_t t = 0; t < walls.indices.size(); t += 3) {
        const Vec3 a = walls.positions[walls.indices[t]];
        const Vec3 normal =
            normalized(cross(walls.positions[walls.indices[t + 1]] - a, walls.positions[walls.indices[t + 2]] - a));
        if (std::abs(dot(normal, middle - a)) > 1.01f || std::abs(a.x - middle.x) > 1.01f ||
            std::abs(a.z - middle.z) > 1.01f)
            continue;
        ++near;
        EXPECT_FLOAT_EQ(dot(normal, middle - a), 1);
    }
    EXPECT_EQ(near, 8);
}

TEST(LevelSolids, KeepBodiesInsideForAMinute) {
    const Level level = ring();
    const LevelSolids solids = solids_of(level);
    auto world = World::create();
    ASSERT_TRUE(world);
    const auto ground = world->add_body({.kind = BodyKind::Static});
    ASSERT_TRUE(ground);
    for (const LevelSolid& solid : solids.solids)
        ASSERT_TRUE(world->add_collider(*ground, solid.shape, {.pose = solid.pose}));
    const PlanBox box = box_of(level.bsp);
    Random random(8);
    std::vector<BodyId> bodies;
    while (bodies.size() < 40) {
        const Point p = point_in(box, random);
        const auto room = clearance_around(level.bsp, level.map, p, 13);
        if (!room || room->ceiling - room->floor < 30) continue;
        const double z = room->floor + 14 + (room->ceiling - room->floor - 28) * double(random.unit());
        const Shape shapes[] = {Sphere{0.25f}, Box{{0.2f, 0.2f, 0.2f}}, Capsule{0.15f, 0.2f}};
        const auto body = world->add_body(
            {.position = to_world(p, z, scale), .linear_velocity = {random.between(-6, 6), 0, random.between(-6, 6)}},
            shapes[bodies.size() % 3]);
        ASSERT_TRUE(body);
        bodies.push_back(*body);
    }
    for (int second = 0; second < 60; ++second) {
        for (int step = 0; step < 60; ++step) ASSERT_TRUE(world->step());
        for (const BodyId body : bodies) {
            const auto state = world->body(body);
            ASSERT_TRUE(state);
            EXPECT_TRUE(is_inside(level.bsp, level.map, state->centre, scale, 0.005)) << "second " << second;
        }
    }
}

TEST(LevelSolids, SeparateInsideFromOutside) {
    const Level level = ring();
    const auto inside = [&](double x, double y, double z) {
        return is_inside(level.bsp, level.map, to_world({x, y}, z, scale), scale, 0.01);
    };
    EXPECT_TRUE(inside(32, 32, 64));
    EXPECT_FALSE(inside(32, 32, -2));
    EXPECT_FALSE(inside(32, 32, 130));
    EXPECT_FALSE(inside(-2, 32, 64));
    EXPECT_TRUE(inside(-0.2, 32, 64));
    EXPECT_TRUE(inside(160, 32, -60));
    EXPECT_FALSE(inside(96, 96, 64));
    EXPECT_FALSE(inside(std::numeric_limits<double>::quiet_NaN(), 0, 0));
}

TEST(LevelRoom, HasTheClearanceOfACylinder) {
    const Level level = ring();
    const auto room = [&](double x, double y, double radius) {
        return clearance_around(level.bsp, level.map, {x, y}, radius);
    };
    ASSERT_TRUE(room(32, 32, 20));
    EXPECT_EQ(room(32, 32, 20)->floor, 0);
    EXPECT_EQ(room(32, 32, 20)->ceiling, 128);
    EXPECT_FALSE(room(32, 32, 33));
    EXPECT_FALSE(room(-5, 32, 1));
    ASSERT_TRUE(room(110, 32, 20));  // overlaps the edge of the pit: the higher floor counts
    EXPECT_EQ(room(160, 32, 20)->floor, -64);
    EXPECT_EQ(room(135, 32, 20)->floor, 0);
    EXPECT_EQ(room(288, 96, 20)->floor, 24);
    EXPECT_EQ(room(288, 96, 20)->ceiling, 72);
}

TEST(LevelSolids, AreMadeFromMapsThatAreNotClosed) {
    auto levels = freedoom_levels({"e1m1.wad"});
    levels.push_back(ring());
    for (Level& level : levels) {
        for (std::size_t drop = 0; drop < 6; ++drop) {
            Level open{level.name, level.map, {}};
            open.map.lines.erase(open.map.lines.begin() +
                                 static_cast<std::ptrdiff_t>(drop * open.map.lines.size() / 6));
            auto bsp = compile(open.map);
            ASSERT_TRUE(bsp);
            open.bsp = *std::move(bsp);
            const LevelSolids solids = solids_of(open);
            EXPECT_GT(solids.solids.size(), open.map.lines.size() / 2);
            for (const LevelSolid& solid : solids.solids) EXPECT_TRUE(check(solid.shape));
        }
    }
}

TEST(LevelSolids, RejectInvalidOptions) {
    const Level level = ring();
    for (const double bad :
         {0.0, -1.0, std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        const auto solids = make_solids(level.bsp, level.map, {.scale = bad});
        ASSERT_FALSE(solids);
        EXPECT_EQ(solids.error().where, "SolidOptions.scale");
        EXPECT_FALSE(make_solids(level.bsp, level.map, {.wall = bad}));
        EXPECT_FALSE(make_solids(level.bsp, level.map, {.depth = bad}));
    }
}

}  // namespace
}  // namespace fase::level
