#pragma once
/// WAD files, as used by Doom and related games: an ordered list of named lumps of bytes.
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
    std::string name;  ///< at most 8 characters, as in the file
    std::vector<std::byte> bytes;
};

/// A complete WAD in memory. The order of the lumps matters: the data of a map are the lumps after its marker.
/// Source of the format: Fell and others 1994, The unofficial Doom specs, release 1.666, chapter 2.
class Wad {
public:
    enum class Kind {
        Whole,  ///< "IWAD": the complete data of a game
        Patch,  ///< "PWAD": additions to it
    };
    /// Larger WADs are rejected.
    static constexpr std::size_t max_bytes = std::size_t{1} << 30;

    Kind kind = Kind::Patch;
    std::vector<Lump> lumps;

    /// Parses the bytes of a file. Errors: Format, with the byte offset after `name`, if the directory or a lump is
    /// outside the file, a size is negative, or the lumps together are many times larger than the file.
    static Result<Wad> parse(const std::string& name, std::span<const std::byte> bytes);
    /// Reads and parses a file; errors of read_file() and of parse().
    static Result<Wad> read(const std::string& path);

    /// Returns the bytes of a file: the lumps in order, then the directory. Equal lumps give equal bytes.
    /// Errors: OutOfRange if the file would have 2^31 bytes or more.
    [[nodiscard]] Result<std::vector<std::byte>> to_bytes() const;

    /// Returns the indices of the maps' markers, in the order of the file: lumps before THINGS and LINEDEFS, or before
    /// a TEXTMAP.
    [[nodiscard]] std::vector<std::size_t> map_markers() const;
    /// Returns the index of the marker with that name, ignoring case; the last one if there are several, as in the
    /// game.
    [[nodiscard]] std::optional<std::size_t> find_map(std::string_view map) const;
    /// Returns the index of a map's lump by name, among the lumps of that map.
    [[nodiscard]] std::optional<std::size_t> find_in_map(std::size_t marker, std::string_view lump) const;
    /// Returns the number of lumps after the marker that belong to the map.
    [[nodiscard]] std::size_t lumps_of_map(std::size_t marker) const;
    /// Replaces the map's lump of that name, or adds it after the map's last lump.
    void set_in_map(std::size_t marker, std::string_view lump, std::vector<std::byte> bytes);
};

/// The possible names of a map's lumps, in the order of the format.
inline constexpr std::array<std::string_view, 12> map_lump_names = {"THINGS", "LINEDEFS", "SIDEDEFS", "VERTEXES",
                                                                    "SEGS",   "SSECTORS", "NODES",    "SECTORS",
                                                                    "REJECT", "BLOCKMAP", "BEHAVIOR", "SCRIPTS"};

}  // namespace fase::level
