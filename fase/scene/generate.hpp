#pragma once
/// Generated scenes: the default castle, benchmark scenes, demonstrations.
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include "fase/scene/scene.hpp"

namespace fase::scene {

/// Size and random seed of a generated scene.
struct GenerateOptions {
    /// Approximate number of dynamic bodies (kinds with a fixed layout round it); 0: the kind's default; at most 1e6.
    std::size_t count = 0;
    std::uint64_t seed = 1;  ///< the same seed gives the same scene, bit for bit, on every machine
};

/// One kind of scene for generate().
struct Generator {
    std::string_view name;
    std::string_view description;                   ///< one sentence
    std::size_t default_count;                      ///< dynamic bodies when no count is given
    Scene (*make)(const GenerateOptions& options);  ///< count is above 0 here
};

/// Returns the only list of kinds; help texts, docs and tests loop over it. The first is the default scene.
[[nodiscard]] std::span<const Generator> generators();

/// Generates a scene. BadArgument, with all known kinds, for an unknown kind; OutOfRange for a count above 1e6.
Result<Scene> generate(std::string_view kind, const GenerateOptions& options = {});

}  // namespace fase::scene
