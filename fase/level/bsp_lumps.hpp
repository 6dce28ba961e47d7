#pragma once
/// Trees in WAD files: written in the formats that games read, and read again, ours and those of other compilers.
#include <cstddef>
#include <string>

#include "fase/core/result.hpp"
#include "fase/level/level_bsp.hpp"
#include "fase/level/map.hpp"
#include "fase/level/wad.hpp"

namespace fase::level {

/// How a tree is written.
struct LumpOptions {
    /// NODES as "XNOD" instead of the classic lumps: 32-bit numbers, cut points to the 65,536th of a unit. What most
    /// programs of today read and the first ones did not.
    bool extended = false;
    /// GL nodes too, minisegs and partners with them: a marker GL_<map> and GL_VERT, GL_SEGS, GL_SSECT, GL_NODES behind
    /// the map (version 2, or 5 when numbers do not fit 16 bits); with `extended`, as "XGLN" in SSECTORS.
    bool gl = false;
};

/// Puts a compiled map's tree in the place of the old one: VERTEXES, SEGS, SSECTORS and NODES, and GL lumps; the map's
/// lumps are brought into their order. In the classic lumps cut points are rounded to whole units, so sub-sectors bulge
/// by up to one, and short segs may come to begin where they end. An old REJECT or
/// BLOCKMAP stays; where there is none, a REJECT of zeros and a new BLOCKMAP are made. Old GL lumps are taken away.
/// OutOfRange when numbers do not fit the format (65,536 vertices or segs, 32,768 nodes or sub-sectors); the WAD is
/// then unchanged.
Result<void> write_bsp(Wad& wad, std::size_t marker, const std::string& file, const Map& map, const LevelBsp& bsp,
                       const LumpOptions& options = {});

/// Which of a map's trees is read.
enum class BspLumps {
    Nodes,  ///< SEGS, SSECTORS and NODES, classic or "XNOD": sub-sectors have strays only
    Gl,     ///< GL nodes of version 2 or 5, or "XGLN": sub-sectors have edges only
};

/// Reads a tree back. Format, naming lump and entry, unless every index points to something, the segs of sub-sectors
/// do not overlap, and each node and sub-sector is reached from the root once. Unsupported: compressed nodes and GL
/// versions 1, 3 and 4. Whether it makes sense on the plan is for check_bsp() to say.
/// Source of the formats: Fell and others 1994, The unofficial Doom specs; Apted 2000–2004, GL nodes specification;
/// ZDoom's extended nodes.
Result<LevelBsp> read_bsp(const std::string& file, const Wad& wad, std::size_t marker, const Map& map, BspLumps which);

/// A BLOCKMAP: which lines cross each square of 128 units. Empty when the lists do not fit its 16-bit offsets; programs
/// of today then make one for themselves.
std::vector<std::byte> make_blockmap(const Map& map);

/// The angle of a direction, 65,536 for a full turn, 0 to the east, counterclockwise.
[[nodiscard]] std::uint16_t binary_angle(double dx, double dy);

}  // namespace fase::level
