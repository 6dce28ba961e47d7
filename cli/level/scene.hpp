#pragma once
/// A level of a WAD as a scene: solid, with bodies thrown into it.
#include <cstddef>
#include <span>
#include <string>

#include "fase/core/result.hpp"
#include "fase/level/level_bsp.hpp"
#include "fase/level/map.hpp"
#include "fase/scene/generate.hpp"

namespace fase::cli {

/// A compiled level, and the scene made of it.
struct LevelScene {
    level::Map map;
    level::LevelBsp bsp;
    scene::Scene scene;  ///< first the level, one static body; then what was thrown in
};

/// Metres a map unit.
inline constexpr double level_scale = 1.0 / 32;
/// Bodies in a level when no count is given.
inline constexpr std::size_t default_level_bodies = 300;

/// Does a file begin as WAD files do? False for files that cannot be read.
[[nodiscard]] bool is_wad(const std::string& path);

/// Reads and compiles a map (empty: the first of the file), makes it solid, and puts `count` bodies (0: 300; at most
/// 100,000) of all shapes into the air of its sectors, all over it, none in another; where no room is left, fewer, with
/// a warning. Errors of Wad::read(), read_map() and compile(), with the file's name.
Result<LevelScene> load_level_scene(const std::string& path, const std::string& map,
                                    const scene::GenerateOptions& options);

/// How many of the dynamic bodies have their centre outside the level, by more than a few millimetres.
[[nodiscard]] std::size_t bodies_outside(const LevelScene& level, const World& world, std::span<const BodyId> ids);

}  // namespace fase::cli
