#pragma once
/// One map of a WAD as its designer drew it: vertices, lines, sides, sectors, things.
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "fase/level/wad.hpp"

namespace fase::level {

/// A corner, in map units (about 1/32 m); x to the east, y to the north.
struct Vertex {
    std::int16_t x = 0, y = 0;
    friend constexpr bool operator==(Vertex, Vertex) = default;
};

/// The format's value for "no side".
inline constexpr std::uint16_t no_side = 0xffff;

/// A wall, or a border between two sectors, from one vertex to another; its right side faces the right of that
/// direction.
struct Line {
    std::uint16_t from = 0, to = 0;  ///< vertices
    std::uint16_t flags = 0, special = 0, tag = 0;
    std::uint16_t right = no_side, left = no_side;  ///< sides
    /// Bit of `flags`: players and monsters cannot cross the line.
    static constexpr std::uint16_t blocks = 1;
    /// Bit of `flags`: the line has two sides and is transparent.
    static constexpr std::uint16_t two_sided = 4;
    /// Whether the line has no side. A line of the file that cannot be used is kept like this, because others are named
    /// by their numbers.
    [[nodiscard]] bool has_no_side() const { return right == no_side && left == no_side; }
};

/// The textures on one side of a line, and the sector to which it belongs.
struct Side {
    std::int16_t x_offset = 0, y_offset = 0;
    std::string upper, lower, middle;  ///< names of textures; "-": none
    std::uint16_t sector = 0;
};

/// An area with one floor and one ceiling, heights in map units.
struct Sector {
    std::int16_t floor = 0, ceiling = 0;
    std::string floor_texture, ceiling_texture;
    std::int16_t light = 0;
    std::uint16_t special = 0, tag = 0;
};

/// A monster, a lamp, a player's start.
struct Thing {
    std::int16_t x = 0, y = 0, angle = 0;
    std::uint16_t type = 0, flags = 0;
};

/// A map with valid references: all vertices of lines exist, and all sides and sectors of lines.
struct Map {
    std::string name;
    std::vector<Vertex> vertices;
    std::vector<Line> lines;
    std::vector<Side> sides;
    std::vector<Sector> sectors;
    std::vector<Thing> things;
    /// What the file has and the map could not use, one text for each kind: "2 lines of zero length, the first is
    /// LINEDEFS[4]".
    std::vector<std::string> left_out;
};

/// Reads the lumps of a map in Doom's own format. `name` is the file, for errors.
/// Lines that cannot be used lose their sides, and Map::left_out names them: lines of zero length, without a side, with
/// a vertex, side or sector that does not exist. A side that no line uses is not looked at. Errors: Format for a lump
/// size that is not a multiple of the entry size, and for a map of which no line can be used. Unsupported for maps in
/// Hexen's format or as text. BadArgument if there is no such map; the message lists the maps of the file. Source of
/// the format: Fell and others 1994, The unofficial Doom specs, chapter 4.
Result<Map> read_map(const std::string& name, const Wad& wad, std::string_view map);

}  // namespace fase::level
