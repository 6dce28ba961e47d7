#pragma once
/// Compiled levels for tests, and random points and rays in them.
#include <algorithm>
#include <filesystem>
#include <string>
#include <vector>

#include "fase/core/random.hpp"
#include "fase/level/bsp_compiler.hpp"
#include "fase/level/level_place.hpp"
#include "fase/level/level_ray.hpp"
#include "fase/level/wad.hpp"

namespace fase::level {

struct Level {
    std::string name;
    Map map;
    LevelBsp bsp;
};

/// Returns the Freedoom levels with these file names; skips files that do not exist.
inline std::vector<Level> freedoom_levels(const std::vector<std::string>& files) {
    std::vector<Level> levels;
    for (const std::string& file : files) {
        const auto path = std::filesystem::path(FASE_SHARED_DATA) / "freedoom" / file;
        if (!std::filesystem::exists(path)) continue;
        const auto wad = Wad::read(path.string());
        if (!wad) continue;
        auto map = read_map(file, *wad, wad->lumps[wad->map_markers()[0]].name);
        if (!map) continue;
        auto bsp = compile(*map);
        if (bsp) levels.push_back({file, *std::move(map), *std::move(bsp)});
    }
    return levels;
}

inline PlanBox box_of(const LevelBsp& bsp) {
    PlanBox box;
    for (const Point& p : bsp.vertices) box.add(p);
    return box;
}
/// Returns a random point in a box.
inline Point point_in(const PlanBox& box, Random& random) {
    return {box.lo.x + (box.hi.x - box.lo.x) * double(random.unit()),
            box.lo.y + (box.hi.y - box.lo.y) * double(random.unit())};
}
/// Returns a random point inside the level.
inline Point point_inside(const LevelBsp& bsp, const PlanBox& box, Random& random) {
    for (;;) {
        const Point p = point_in(box, random);
        if (sub_sector_at(bsp, p)) return p;
    }
}
/// Returns a random ray from a point and height inside the level.
inline LevelRay ray_inside(const Level& level, const PlanBox& box, Random& random) {
    const Point from = point_inside(level.bsp, box, random);
    const Opening room = opening_of(level.map, *sector_at(level.bsp, from));
    const double z = room.floor + (room.ceiling - room.floor) * double(random.unit());
    const Point direction{double(random.between(-1, 1)), double(random.between(-1, 1))};
    return {from, z, direction, double(random.between(-0.3f, 0.3f))};
}

/// Returns a map on a grid, from rows of letters: each letter is a square of 64 units with its own sector, ' ' is
/// solid. `room(letter)` returns floor and ceiling.
template <class Room> Map grid_map(const std::vector<std::string>& rows, Room&& room) {
    Map map;
    map.name = "MAP01";
    const int height = static_cast<int>(rows.size()), width = static_cast<int>(rows[0].size());
    const auto at = [&](int x, int y) {
        const bool within = x >= 0 && y >= 0 && x < width && y < height;
        return within ? rows[static_cast<std::size_t>(height - 1 - y)][static_cast<std::size_t>(x)] : ' ';
    };
    std::vector<int> sector(static_cast<std::size_t>(width * height), -1);
    for (int y = 0; y < height; ++y) {
        for (int x = 0; x < width; ++x) {
            if (at(x, y) == ' ') continue;
            sector[static_cast<std::size_t>(y * width + x)] = static_cast<int>(map.sectors.size());
            Sector s;
            const auto [floor, ceiling] = room(at(x, y));
            s.floor = static_cast<std::int16_t>(floor);
            s.ceiling = static_cast<std::int16_t>(ceiling);
            map.sectors.push_back(s);
        }
    }
    for (int y = 0; y <= height; ++y)
        for (int x = 0; x <= width; ++x)
            map.vertices.push_back({static_cast<std::int16_t>(64 * x), static_cast<std::int16_t>(64 * y)});
    const auto vertex = [&](int x, int y) { return static_cast<std::uint16_t>(y * (width + 1) + x); };
    const auto add_side = [&](int x, int y) {
        if (at(x, y) == ' ') return no_side;
        Side side;
        side.sector = static_cast<std::uint16_t>(sector[static_cast<std::size_t>(y * width + x)]);
        map.sides.push_back(side);
        return static_cast<std::uint16_t>(map.sides.size() - 1);
    };
    // Adds a line between the square on its right and the one on its left.
    const auto add_line = [&](std::uint16_t from, std::uint16_t to, int rx, int ry, int lx, int ly) {
        if (at(rx, ry) == ' ' && at(lx, ly) == ' ') return;
        if (at(rx, ry) == ' ') {
            std::swap(from, to);
            std::swap(rx, lx);
            std::swap(ry, ly);
        }
        Line line;
        line.from = from;
        line.to = to;
        line.right = add_side(rx, ry);
        line.left = add_side(lx, ly);
        line.flags = line.left == no_side ? Line::blocks : Line::two_sided;
        map.lines.push_back(line);
    };
    for (int y = 0; y <= height; ++y) {
        for (int x = 0; x <= width; ++x) {
            if (x < width) add_line(vertex(x, y), vertex(x + 1, y), x, y - 1, x, y);
            if (y < height) add_line(vertex(x, y), vertex(x, y + 1), x, y, x - 1, y);
        }
    }
    return map;
}

}  // namespace fase::level
