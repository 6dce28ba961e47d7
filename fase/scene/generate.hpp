#pragma once
/// Scenes made by rule: the default castle, benchmark piles, things to look at.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "fase/scene/scene.hpp"

namespace fase::scene {

/// How much of a scene, and which of its kind.
struct GenerateOptions {
    std::size_t count =
        0;  ///< dynamic bodies, roughly (kinds of a fixed layout round it); 0: the kind's own number; at most 1e6
    std::uint64_t seed = 1;  ///< equal seeds give equal scenes, bit for bit, on every machine
};

/// One kind of scene that generate() makes.
struct Generator {
    std::string_view name;
    std::string_view description;                   ///< one sentence
    std::size_t default_count;                      ///< dynamic bodies when no count is given
    Scene (*make)(const GenerateOptions& options);  ///< count is above 0 here
};

/// THE list of kinds; help texts, docs and tests loop over it. The first is the default scene.
[[nodiscard]] std::span<const Generator> generators();

/// A scene of that kind. BadArgument with the known kinds when there is none of that name, OutOfRange for a count above
/// 1e6.
Result<Scene> generate(std::string_view kind, const GenerateOptions& options = {});

}  // namespace fase::scene
