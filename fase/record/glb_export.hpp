#pragma once
/// The motion of a recording as standard glTF 2.0 animation, which Blender and any viewer play.
#include <cstddef>
#include <vector>

#include "fase/core/result.hpp"
#include "fase/record/player.hpp"

namespace fase::record {

/// How exact the animation is.
struct GlbOptions {
    double metres = 0.001;  ///< keys are left out where interpolation stays this near the recording
    double degrees = 0.1;   ///< … and this near in turning
    int detail = 24;        ///< segments around round shapes
};

/// A whole .glb file: a node for each body (name, meshes of its visuals or else of its shapes, sensors left out), one
/// animation with translation and rotation of those that move, and steps of scale for those that come or go. Time
/// begins at 0 with the first frame. Recordings far from the origin stand under a root node that holds the offset.
/// Format or Io when a frame cannot be read, Capacity when it would be longer than the 4 GiB that the format allows.
/// Holds all keys in memory.
Result<std::vector<std::byte>> export_glb(Player& player, const GlbOptions& options = {});

}  // namespace fase::record
