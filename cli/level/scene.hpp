#pragma once
/// Builds a scene from a level of a WAD file: static solids, and dynamic bodies in its rooms.
#include <cstddef>
#include <span>
#include <string>

#include "fase/core/result.hpp"
#include "fase/level/level_bsp.hpp"
#include "fase/level/map.hpp"
#include "fase/scene/generate.hpp"

namespace fase::cli {

/// A compiled level and its scene.
struct LevelScene {
    level::Map map;
    level::LevelBsp bsp;
    scene::Scene scene;  ///< first the level as one static body, then the dynamic bodies
};

/// Metres per map unit.
inline constexpr double level_scale = 1.0 / 32;
/// Bodies in a level when no count is given.
inline constexpr std::size_t default_level_bodies = 300;

/// Whether a file starts with the magic bytes of a WAD file. False for files that cannot be read.
[[nodiscard]] bool is_wad(const std::string& path);

/// Reads and compiles a map (empty: the first of the file), builds its solids, and places `count` bodies (0: 300; at
/// most 100,000) of all shapes at random, disjoint positions in the air of its sectors. If they do not all fit, adds
/// fewer and a warning. Errors of Wad::read(), read_map() and compile(), with the file's name.
Result<LevelScene> load_level_scene(const std::string& path, const std::string& map,
                                    const scene::GenerateOptions& options);

/// Number of dynamic bodies whose centre is outside the level by more than 5 mm.
[[nodiscard]] std::size_t bodies_outside(const LevelScene& level, const World& world, std::span<const BodyId> ids);

}  // namespace fase::cli
