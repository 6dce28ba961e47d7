#pragma once
/// Maps for tests: drawn by hand, random, and those of Freedoom if they are installed.
#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "fase/core/random.hpp"
#include "fase/level/detail/little_endian.hpp"
#include "fase/level/map.hpp"

namespace fase::level {

/// Builds a map line by line. Loops around a sector are clockwise.
class DrawnMap {
public:
    static constexpr int outside = -1;
    Map map;

    DrawnMap() { map.name = "MAP01"; }
    int sector(int floor = 0, int ceiling = 128) {
        Sector& s = map.sectors.emplace_back();
        s.floor = static_cast<std::int16_t>(floor);
        s.ceiling = static_cast<std::int16_t>(ceiling);
        s.floor_texture = s.ceiling_texture = "FLAT";
        return static_cast<int>(map.sectors.size()) - 1;
    }
    std::uint16_t vertex(int x, int y) {
        const Vertex v{static_cast<std::int16_t>(x), static_cast<std::int16_t>(y)};
        const auto known = std::find(map.vertices.begin(), map.vertices.end(), v);
        if (known != map.vertices.end()) return static_cast<std::uint16_t>(known - map.vertices.begin());
        map.vertices.push_back(v);
        return static_cast<std::uint16_t>(map.vertices.size() - 1);
    }
    void line(std::pair<int, int> from, std::pair<int, int> to, int right, int left = outside) {
        Line& l = map.lines.emplace_back();
        l.from = vertex(from.first, from.second);
        l.to = vertex(to.first, to.second);
        l.right = side(right);
        l.left = side(left);
        l.flags = left == outside ? Line::blocks : Line::two_sided;
    }
    void loop(const std::vector<std::pair<int, int>>& corners, int inside, int behind = outside) {
        for (std::size_t i = 0; i < corners.size(); ++i)
            line(corners[i], corners[(i + 1) % corners.size()], inside, behind);
    }

private:
    std::uint16_t side(int sector) {
        if (sector == outside) return no_side;
        Side& s = map.sides.emplace_back();
        s.upper = s.lower = s.middle = "-";
        s.sector = static_cast<std::uint16_t>(sector);
        return static_cast<std::uint16_t>(map.sides.size() - 1);
    }
};

/// Returns a square room.
inline Map room_map() {
    DrawnMap drawn;
    drawn.loop({{0, 0}, {0, 128}, {128, 128}, {128, 0}}, drawn.sector());
    return drawn.map;
}

/// Returns a room with a rotated square pool, and a pillar in the pool.
inline Map pool_map() {
    DrawnMap drawn;
    const int room = drawn.sector(), pool = drawn.sector(-32);
    drawn.loop({{0, 0}, {0, 512}, {640, 512}, {640, 0}}, room);
    drawn.loop({{320, 60}, {130, 250}, {310, 450}, {500, 270}}, pool, room);
    drawn.loop({{300, 240}, {340, 240}, {340, 280}, {300, 280}}, pool);  // counterclockwise: the pool is around it
    return drawn.map;
}

/// Returns an irregular grid of cells, some of them solid; each cell or row of cells is a sector.
inline Map grid_map(int columns, int rows, std::uint64_t seed) {
    Random random(seed);
    DrawnMap drawn;
    constexpr int pitch = 96;
    std::vector<std::pair<int, int>> corners;
    for (int y = 0; y <= rows; ++y)
        for (int x = 0; x <= columns; ++x)
            corners.emplace_back(x * pitch + static_cast<int>(random.below(47)) - 23,
                                 y * pitch + static_cast<int>(random.below(47)) - 23);
    std::vector<int> cells;
    for (int i = 0; i < columns * rows; ++i) {
        const bool solid = i > 0 && random.below(4) == 0;
        const bool as_before = i % columns > 0 && cells.back() >= 0 && random.below(3) == 0;
        cells.push_back(solid       ? DrawnMap::outside
                        : as_before ? cells.back()
                                    : drawn.sector(static_cast<int>(random.below(64))));
    }
    const auto cell = [&](int x, int y) {
        return x < 0 || y < 0 || x >= columns || y >= rows ? DrawnMap::outside
                                                           : cells[static_cast<std::size_t>(y * columns + x)];
    };
    const auto corner = [&](int x, int y) { return corners[static_cast<std::size_t>(y * (columns + 1) + x)]; };
    const auto wall = [&](std::pair<int, int> a, std::pair<int, int> b, int right, int left) {
        if (right == left) return;
        if (right == DrawnMap::outside) {
            drawn.line(b, a, left, right);
        } else {
            drawn.line(a, b, right, left);
        }
    };
    for (int y = 0; y <= rows; ++y)
        for (int x = 0; x < columns; ++x) wall(corner(x, y), corner(x + 1, y), cell(x, y - 1), cell(x, y));
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x <= columns; ++x) wall(corner(x, y), corner(x, y + 1), cell(x, y), cell(x - 1, y));
    return drawn.map;
}

/// Returns random lines: they cross, overlap, end anywhere, some have zero length.
inline Map soup_map(int lines, int reach, std::uint64_t seed) {
    Random random(seed);
    DrawnMap drawn;
    for (int i = 0; i < 4; ++i) drawn.sector(8 * i);
    const auto point = [&] {
        const auto one = [&] {
            return static_cast<int>(random.below(static_cast<std::uint32_t>(2 * reach + 1))) - reach;
        };
        const int x = one();
        return std::pair(std::max(x, -32768), one());
    };
    for (int i = 0; i < lines; ++i)
        drawn.line(point(), point(), static_cast<int>(random.below(4)),
                   random.below(2) == 0 ? DrawnMap::outside : static_cast<int>(random.below(4)));
    return drawn.map;
}

/// Returns a WAD with the lumps of a map, without a tree.
inline Wad wad_of(const Map& map) {
    Wad wad;
    std::vector<std::byte> things, lines, sides, vertices, sectors;
    for (const Line& l : map.lines)
        for (const std::uint16_t value : {l.from, l.to, l.flags, l.special, l.tag, l.right, l.left})
            append_u16(lines, value);
    for (const Side& s : map.sides) {
        append_i16(sides, s.x_offset);
        append_i16(sides, s.y_offset);
        for (const std::string* name : {&s.upper, &s.lower, &s.middle}) append_name(sides, *name);
        append_u16(sides, s.sector);
    }
    for (const Vertex v : map.vertices) {
        append_i16(vertices, v.x);
        append_i16(vertices, v.y);
    }
    for (const Sector& s : map.sectors) {
        append_i16(sectors, s.floor);
        append_i16(sectors, s.ceiling);
        append_name(sectors, s.floor_texture);
        append_name(sectors, s.ceiling_texture);
        append_i16(sectors, s.light);
        append_u16(sectors, s.special);
        append_u16(sectors, s.tag);
    }
    wad.lumps = {{map.name, {}},      {"THINGS", things},     {"LINEDEFS", lines},
                 {"SIDEDEFS", sides}, {"VERTEXES", vertices}, {"SECTORS", sectors}};
    return wad;
}

/// A map of Freedoom.
struct GivenMap {
    std::string file;
    Wad wad;
    std::size_t marker = 0;
    Map map;
};
/// Returns the maps in FASE_SHARED_DATA; empty if there are none.
inline std::vector<GivenMap> freedoom_maps() {
    std::vector<GivenMap> maps;
    const auto folder = std::filesystem::path(FASE_SHARED_DATA) / "freedoom";
    if (!std::filesystem::exists(folder)) return maps;
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == ".wad") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    for (const auto& file : files) {
        const auto wad = Wad::read(file.string());
        if (!wad || wad->map_markers().empty()) continue;
        const std::size_t marker = wad->map_markers()[0];
        const auto map = read_map(file.string(), *wad, wad->lumps[marker].name);
        if (map) maps.push_back({file.string(), *wad, marker, *map});
    }
    return maps;
}

}  // namespace fase::level
