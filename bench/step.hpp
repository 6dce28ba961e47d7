#pragma once
/// The benchmark behind `fase bench step`: full steps of the same scenes, in Fase and its peers.
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "bench/timing.hpp"
#include "fase/core/result.hpp"

namespace fase::bench {

/// A measured scene: a name in scene::generators(), stepped without sleep.
struct StepScene {
    std::string_view name;
    std::uint64_t steps;  ///< default number of steps
};
[[nodiscard]] std::span<const StepScene> step_scenes();

struct StepOptions {
    std::string scene;                   ///< a name of step_scenes(); empty: all
    std::string engine = "all";          ///< names of engines() separated by commas, or "all"
    int threads = 1;                     ///< for engines with threads
    std::optional<std::uint64_t> steps;  ///< nullopt: the scene's default
    int rounds = 3;                      ///< runs per scene and engine
    std::size_t count = 0;               ///< approximate number of bodies; 0: the scene's default
};

/// One engine on one scene. Each time is the median over the rounds, in milliseconds.
struct StepRow {
    std::string scene, engine;
    std::string settings;  ///< of the engine, in a few words
    int threads = 1;
    std::uint64_t steps = 0;
    int rounds = 0;
    Timing ms;
    double min_ms = 0;  ///< mean over the steps of each step's fastest round; least disturbed by other programs
    double mean_low = 0, mean_high = 0;      ///< smallest and largest mean of a round
    std::size_t bodies = 0, contacts = 0;    ///< dynamic bodies; touching pairs at the end
    std::optional<std::uint64_t> hash;       ///< at the end; nullopt: the engine has none
    bool repeats = true;                     ///< all rounds ended with equal hashes and heights
    double top_height = 0, mean_height = 0;  ///< of the bodies' centres at the end, metres
    double drift = 0;                        ///< mean distance of the bodies from their start, metres
};

/// Called before each step with steps done, steps in total, scene and engine. Returns false to stop.
using StepProgress =
    std::function<bool(std::uint64_t done, std::uint64_t total, std::string_view scene, std::string_view engine)>;

/// Measures the selected engines on the selected scenes. The engines alternate every few steps, so that noise affects
/// all of them. When stopped, returns the rows of the finished scenes. Errors: BadArgument for an unknown name; those
/// of the engines.
Result<std::vector<StepRow>> measure_steps(const StepOptions& options, const StepProgress& progress);

}  // namespace fase::bench
