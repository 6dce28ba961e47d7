#pragma once
/// Exports a recording as a standard glTF 2.0 animation, for Blender and other viewers.
#include <cstddef>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/record/player.hpp"

namespace fase::record {

/// The precision of the animation.
struct GlbOptions {
    double metres = 0.001;  ///< position tolerance: keys that interpolation restores within it are omitted
    double degrees = 0.1;   ///< rotation tolerance
    int detail = 24;        ///< segments around round shapes; 3 to 1000
};

/// Returns a complete .glb file: one node per body (its name, and the meshes of its visuals or else of its shapes,
/// without sensors), and one animation with translation and rotation of moving bodies and with step-wise scale (0 or 1)
/// of bodies that are added or removed. Time is 0 at the first frame. For recordings far from the origin, the root node
/// contains the offset. Errors: Format or Io if there is no frame or one cannot be read; BadArgument for options out of
/// range; Capacity if the file would exceed the 4 GiB that the format allows. Keeps all keys in memory.
Result<std::vector<std::byte>> export_glb(Player& player, const GlbOptions& options = {});

}  // namespace fase::record
