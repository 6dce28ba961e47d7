/// Reads lumps into arrays and checks every index.
#include "fase/level/map.hpp"

#include <fmt/format.h>

#include "fase/level/detail/little_endian.hpp"

namespace fase::level {
namespace {

using Bytes = std::span<const std::byte>;

std::string name_at(Bytes bytes, std::size_t at) {
    std::string name;
    for (std::size_t i = at; i < at + 8 && bytes[i] != std::byte{0}; ++i) name += static_cast<char>(bytes[i]);
    return name;
}

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
    void check_index(std::string_view lump, std::size_t entry, std::string_view what, std::size_t index,
                     std::size_t count) {
        if (index < count || error_) return;
        fail(fmt::format("{}[{}]", lump, entry),
             fmt::format("found {} {}; expected one of the {}", what, index, count));
    }
    [[nodiscard]] const std::optional<Error>& error() const { return error_; }

private:
    const std::string& file_;
    const Wad& wad_;
    std::size_t marker_;
    std::optional<Error> error_;
};

void check_references(Reader& reader, const Map& map) {
    for (std::size_t i = 0; i < map.sides.size(); ++i)
        reader.check_index("SIDEDEFS", i, "sector", map.sides[i].sector, map.sectors.size());
    for (std::size_t i = 0; i < map.lines.size() && !reader.error(); ++i) {
        const Line& line = map.lines[i];
        reader.check_index("LINEDEFS", i, "vertex", line.from, map.vertices.size());
        reader.check_index("LINEDEFS", i, "vertex", line.to, map.vertices.size());
        if (line.right != no_side) reader.check_index("LINEDEFS", i, "side", line.right, map.sides.size());
        if (line.left != no_side) reader.check_index("LINEDEFS", i, "side", line.left, map.sides.size());
        if (reader.error()) return;
        const std::string entry = fmt::format("LINEDEFS[{}]", i);
        if (line.right == no_side) reader.fail(entry, "found a line without a right side; expected one");
        if (map.vertices[line.from] == map.vertices[line.to])
            reader.fail(entry, "found a line of zero length; expected two different corners");
    }
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
        map.sectors.push_back({read_i16(b, 0), read_i16(b, 2), name_at(b, 4), name_at(b, 12), read_i16(b, 20),
                               read_u16(b, 22), read_u16(b, 24)});
    });
    reader.each("SIDEDEFS", 30, [&](Bytes b) {
        map.sides.push_back(
            {read_i16(b, 0), read_i16(b, 2), name_at(b, 4), name_at(b, 12), name_at(b, 20), read_u16(b, 28)});
    });
    reader.each("LINEDEFS", 14, [&](Bytes b) {
        map.lines.push_back({read_u16(b, 0), read_u16(b, 2), read_u16(b, 4), read_u16(b, 6), read_u16(b, 8),
                             read_u16(b, 10), read_u16(b, 12)});
    });
    check_references(reader, map);
    if (reader.error()) return *reader.error();
    if (map.lines.empty())
        return Error{
            Status::Format, fmt::format("{}: {}", name, map.name), "found no lines; expected at least one", {}};
    return map;
}

}  // namespace fase::level
