/// Builds a BLOCKMAP: a grid of lists of lines, in which equal lists are shared.
#include <algorithm>
#include <map>

#include "fase/level/bsp_lumps.hpp"
#include "fase/level/detail/little_endian.hpp"

namespace fase::level {

std::vector<std::byte> make_blockmap(const Map& map) {
    if (map.lines.empty()) return {};
    constexpr std::int32_t side = 128;
    std::int32_t west = 32767, south = 32767, east = -32768, north = -32768;
    for (const Line& line : map.lines) {
        for (const Vertex v : {map.vertices[line.from], map.vertices[line.to]}) {
            west = std::min<std::int32_t>(west, v.x);
            east = std::max<std::int32_t>(east, v.x);
            south = std::min<std::int32_t>(south, v.y);
            north = std::max<std::int32_t>(north, v.y);
        }
    }
    const std::int32_t columns = (east - west) / side + 1, rows = (north - south) / side + 1;
    std::vector<std::vector<std::uint16_t>> cells(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
    for (std::size_t i = 0; i < map.lines.size() && i < 0xffff; ++i) {
        const Vertex a = map.vertices[map.lines[i].from], b = map.vertices[map.lines[i].to];
        const std::int64_t dx = b.x - a.x, dy = b.y - a.y;
        for (std::int32_t row = (std::min(a.y, b.y) - south) / side; row <= (std::max(a.y, b.y) - south) / side;
             ++row) {
            for (std::int32_t column = (std::min(a.x, b.x) - west) / side; column <= (std::max(a.x, b.x) - west) / side;
                 ++column) {
                bool left = false, right = false;  // corners of the cell on either side of the line
                for (const std::int32_t corner : {0, 1, 2, 3}) {
                    const std::int64_t x = west + (column + (corner & 1)) * side, y = south + (row + corner / 2) * side;
                    const std::int64_t value = dx * (y - a.y) - dy * (x - a.x);
                    left |= value >= 0;
                    right |= value <= 0;
                }
                if (left && right)
                    cells[static_cast<std::size_t>(row * columns + column)].push_back(static_cast<std::uint16_t>(i));
            }
        }
    }
    std::vector<std::byte> out, lists;
    for (const std::int32_t value : {west, south, columns, rows}) append_i16(out, static_cast<std::int16_t>(value));
    std::map<std::vector<std::uint16_t>, std::size_t> offsets;
    for (const std::vector<std::uint16_t>& cell : cells) {
        const auto [offset, is_new] = offsets.try_emplace(cell, 4 + cells.size() + lists.size() / 2);
        if (offset->second > 0xffff) return {};
        append_u16(out, static_cast<std::uint16_t>(offset->second));
        if (!is_new) continue;
        append_u16(lists, 0);
        for (const std::uint16_t line : cell) append_u16(lists, line);
        append_u16(lists, 0xffff);
    }
    out.insert(out.end(), lists.begin(), lists.end());
    return out;
}

}  // namespace fase::level
