#pragma once
/// Reads and writes trees in WAD files, in the formats that games read; also trees of other compilers.
#include <cstddef>
#include <string>

#include "fase/core/result.hpp"
#include "fase/level/level_bsp.hpp"
#include "fase/level/map.hpp"
#include "fase/level/wad.hpp"

namespace fase::level {

/// The format in which a tree is written.
struct LumpOptions {
    /// Writes NODES as "XNOD" instead of the classic lumps: 32-bit indices, split points in 1/65,536 of a unit. Most
    /// programs of today read it; the first ones did not.
    bool extended = false;
    /// Also writes GL nodes, with minisegs and partners: a marker GL_<map> and GL_VERT, GL_SEGS, GL_SSECT, GL_NODES
    /// after the map (version 2, or 5 if numbers do not fit 16 bits); with `extended`, "XGLN" in SSECTORS.
    bool gl = false;
};

/// Replaces the tree of a compiled map: VERTEXES, SEGS, SSECTORS, NODES and the GL lumps. Sorts the map's lumps into
/// the order of the format. The classic lumps round split points to whole units, so sub-sectors can bulge by up to one
/// unit, and the ends of a short seg can coincide.
/// Keeps an existing REJECT and BLOCKMAP; otherwise writes a REJECT of zeros and a new BLOCKMAP. Removes old GL lumps.
/// Errors: OutOfRange if numbers do not fit the format (65,536 vertices or segs, 32,768 nodes or sub-sectors); the WAD
/// is then unchanged.
Result<void> write_bsp(Wad& wad, std::size_t marker, const std::string& file, const Map& map, const LevelBsp& bsp,
                       const LumpOptions& options = {});

/// Which of a map's trees is read.
enum class BspLumps {
    Nodes,  ///< SEGS, SSECTORS and NODES, classic or "XNOD": sub-sectors have outliers only
    Gl,     ///< GL nodes of version 2 or 5, or "XGLN": sub-sectors have edges only
};

/// Reads a tree from lumps. Checks that every index is valid, that the segs of sub-sectors do not overlap, and that
/// each node and sub-sector is reached from the root exactly once. Does not check the geometry: see check_bsp().
/// Errors: Format, with lump and entry; Unsupported for compressed nodes and GL versions 1, 3 and 4.
/// Source of the formats: Fell and others 1994, The unofficial Doom specs; Apted 2000–2004, GL nodes specification;
/// ZDoom's extended nodes.
Result<LevelBsp> read_bsp(const std::string& file, const Wad& wad, std::size_t marker, const Map& map, BspLumps which);

/// Returns a BLOCKMAP: the lines that cross each square of 128 units. Empty if the lists do not fit its 16-bit
/// offsets; programs of today then build their own.
std::vector<std::byte> make_blockmap(const Map& map);

/// Returns the angle of a direction in units of 1/65,536 turn, 0 to the east, counterclockwise.
[[nodiscard]] std::uint16_t binary_angle(double dx, double dy);

}  // namespace fase::level
