#pragma once
/// The WAD file of Doom and its kin: named lumps of bytes in a row.
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "fase/core/result.hpp"

namespace fase::level {

/// One entry of the directory, with its bytes.
struct Lump {
    std::string name;  ///< at most 8 characters, as it stands in the file
    std::vector<std::byte> bytes;
};

/// A whole WAD in memory. The order of the lumps counts: the data of a map are the lumps that follow its marker.
/// Source of the format: Fell and others 1994, The unofficial Doom specs, release 1.666, chapter 2.
class Wad {
public:
    enum class Kind {
        Whole,  ///< "IWAD": a game's own
        Patch,  ///< "PWAD": added to one
    };
    /// WADs larger than this are refused.
    static constexpr std::size_t max_bytes = std::size_t{1} << 30;

    Kind kind = Kind::Patch;
    std::vector<Lump> lumps;

    /// Takes a file's bytes apart. Format, with the byte's place after `name`, when the directory or a lump lies
    /// outside the file, a size is negative, or lumps together are larger than the file many times over.
    static Result<Wad> parse(const std::string& name, std::span<const std::byte> bytes);
    /// Reads and parses a file; errors of read_file() and of parse().
    static Result<Wad> read(const std::string& path);

    /// The bytes of a file. Lumps one after the other, the directory last; equal for equal lumps.
    /// OutOfRange when they do not fit a file of 2^31 bytes.
    [[nodiscard]] Result<std::vector<std::byte>> packed() const;

    /// Places of the maps' markers, in the order of the file: lumps that THINGS and LINEDEFS follow, or a TEXTMAP.
    [[nodiscard]] std::vector<std::size_t> map_markers() const;
    /// Place of the marker with that name, letters of either case; the last one counts, as in the game.
    [[nodiscard]] std::optional<std::size_t> find_map(std::string_view map) const;
    /// Place of a map's lump, by its name; searched behind the marker as far as the map's lumps go.
    [[nodiscard]] std::optional<std::size_t> find_in_map(std::size_t marker, std::string_view lump) const;
    /// How many lumps behind the marker are the map's.
    [[nodiscard]] std::size_t lumps_of_map(std::size_t marker) const;
    /// Puts a lump in the place of the map's one of that name, or behind its last.
    void set_in_map(std::size_t marker, std::string_view lump, std::vector<std::byte> bytes);
};

/// The names that lumps of a map may have, in the order of the format.
inline constexpr std::array<std::string_view, 12> map_lump_names = {"THINGS", "LINEDEFS", "SIDEDEFS", "VERTEXES",
                                                                    "SEGS",   "SSECTORS", "NODES",    "SECTORS",
                                                                    "REJECT", "BLOCKMAP", "BEHAVIOR", "SCRIPTS"};

}  // namespace fase::level
