/// Reads lumps into arrays and checks every index.
#include "fase/level/map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "fase/level/detail/little_endian.hpp"

namespace fase::level {
namespace {

using Bytes = std::span<const std::byte>;

/// Reads lumps of one map; keeps the first error.
class Reader {
public:
    Reader(const std::string& file, const Wad& wad, std::size_t marker) : file_(file), wad_(wad), marker_(marker) {}

    /// Calls read(bytes of one entry) for each entry of `size` bytes of the lump.
    template <class Read> void each(std::string_view lump, std::size_t size, Read&& read) {
        if (error_) return;
        const std::optional<std::size_t> place = wad_.find_in_map(marker_, lump);
        if (!place) return fail(lump, "no such lump; expected one in each map");
        const Bytes bytes = wad_.lumps[*place].bytes;
        if (bytes.size() % size != 0)
            return fail(lump, fmt::format("found {} bytes; expected a multiple of {}", bytes.size(), size));
        for (std::size_t at = 0; at < bytes.size(); at += size) read(bytes.subspan(at, size));
    }
    /// Stores an error unless there is one already.
    void fail(std::string_view where, std::string problem) {
        if (!error_) {
            error_ = Error{Status::Format,
                           fmt::format("{}: {} {}", file_, wad_.lumps[marker_].name, where),
                           std::move(problem),
                           {}};
        }
    }
    [[nodiscard]] const std::optional<Error>& error() const { return error_; }

private:
    const std::string& file_;
    const Wad& wad_;
    std::size_t marker_;
    std::optional<Error> error_;
};

/// The faults of lines, in the order in which they are looked for.
enum class Fault { Vertex, Length, NoSide, Side, Sector, Count };
constexpr std::array<std::string_view, static_cast<std::size_t>(Fault::Count)> fault_names{
    "with a vertex that does not exist", "of zero length", "without a side", "with a side that does not exist",
    "with a side whose sector does not exist"};

/// The fault that keeps a whole line from being used; a bad side is taken off it before.
std::optional<Fault> remove_bad_sides(const Map& map, Line& line) {
    if (line.from >= map.vertices.size() || line.to >= map.vertices.size()) return Fault::Vertex;
    if (map.vertices[line.from] == map.vertices[line.to]) return Fault::Length;
    if (line.has_no_side()) return Fault::NoSide;
    std::optional<Fault> fault;
    for (std::uint16_t* side : {&line.left, &line.right}) {
        if (*side == no_side) continue;
        if (*side < map.sides.size() && map.sides[*side].sector < map.sectors.size()) continue;
        fault = *side < map.sides.size() ? Fault::Sector : Fault::Side;
        *side = no_side;
    }
    return fault;
}

/// Makes all references valid, and notes what was left out.
void leave_out_faults(Map& map) {
    struct Found {
        std::size_t count = 0, first = 0;
    };
    std::array<Found, fault_names.size()> found;
    for (std::size_t i = 0; i < map.lines.size(); ++i) {
        Line& line = map.lines[i];
        const std::optional<Fault> fault = remove_bad_sides(map, line);
        if (!fault) continue;
        Found& kind = found[static_cast<std::size_t>(*fault)];
        if (kind.count++ == 0) kind.first = i;
        if (*fault == Fault::Vertex) line.from = line.to = 0;
        if (*fault == Fault::Vertex || *fault == Fault::Length) line.right = line.left = no_side;
    }
    for (std::size_t i = 0; i < found.size(); ++i) {
        const auto [count, first] = found[i];
        if (count == 0) continue;
        map.left_out.push_back(
            count == 1 ? fmt::format("a line {}, LINEDEFS[{}]", fault_names[i], first)
                       : fmt::format("{} lines {}, the first is LINEDEFS[{}]", count, fault_names[i], first));
    }
    for (Side& side : map.sides)  // those that are left belong to no line
        if (side.sector >= map.sectors.size()) side.sector = 0;
}

}  // namespace

Result<Map> read_map(const std::string& name, const Wad& wad, std::string_view map_name) {
    const std::optional<std::size_t> marker = wad.find_map(map_name);
    if (!marker) {
        std::string known;
        for (const std::size_t m : wad.map_markers()) known += (known.empty() ? "" : ", ") + wad.lumps[m].name;
        return Error{Status::BadArgument,
                     name,
                     fmt::format("no map \"{}\"; expected one of {}", map_name, known.empty() ? "none" : known),
                     {}};
    }
    Map map;
    map.name = wad.lumps[*marker].name;
    if (wad.find_in_map(*marker, "TEXTMAP") || wad.find_in_map(*marker, "BEHAVIOR")) {
        return Error{Status::Unsupported,
                     fmt::format("{}: {}", name, map.name),
                     "found a map in the format of Hexen or as text; expected Doom's own",
                     {}};
    }
    Reader reader(name, wad, *marker);
    reader.each("THINGS", 10, [&](Bytes b) {
        map.things.push_back({read_i16(b, 0), read_i16(b, 2), read_i16(b, 4), read_u16(b, 6), read_u16(b, 8)});
    });
    reader.each("VERTEXES", 4, [&](Bytes b) { map.vertices.push_back({read_i16(b, 0), read_i16(b, 2)}); });
    reader.each("SECTORS", 26, [&](Bytes b) {
        map.sectors.push_back({read_i16(b, 0), read_i16(b, 2), read_name(b, 4), read_name(b, 12), read_i16(b, 20),
                               read_u16(b, 22), read_u16(b, 24)});
    });
    reader.each("SIDEDEFS", 30, [&](Bytes b) {
        map.sides.push_back(
            {read_i16(b, 0), read_i16(b, 2), read_name(b, 4), read_name(b, 12), read_name(b, 20), read_u16(b, 28)});
    });
    reader.each("LINEDEFS", 14, [&](Bytes b) {
        map.lines.push_back({read_u16(b, 0), read_u16(b, 2), read_u16(b, 4), read_u16(b, 6), read_u16(b, 8),
                             read_u16(b, 10), read_u16(b, 12)});
    });
    if (reader.error()) return *reader.error();
    leave_out_faults(map);
    if (std::any_of(map.lines.begin(), map.lines.end(), [](const Line& line) { return !line.has_no_side(); }))
        return map;
    return Error{Status::Format,
                 fmt::format("{}: {}", name, map.name),
                 map.left_out.empty() ? "found no lines; expected at least one"
                                      : fmt::format("found {}; expected a line that can be used", map.left_out[0]),
                 {}};
}

}  // namespace fase::level
