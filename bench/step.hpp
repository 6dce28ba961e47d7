#pragma once
/// What `fase bench step` measures: whole steps of the same scenes, in Fase and in its peers.
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

/// A scene that is measured: a kind of scene::generators(), without sleep.
struct StepScene {
    std::string_view name;
    std::uint64_t steps;  ///< when not told otherwise
};
[[nodiscard]] std::span<const StepScene> step_scenes();

struct StepOptions {
    std::string scene;                   ///< a name of step_scenes(); empty: all
    std::string engine = "all";          ///< names of engines() with commas between, or "all"
    int threads = 1;                     ///< for engines that have threads
    std::optional<std::uint64_t> steps;  ///< without: the scene's
    int rounds = 3;                      ///< how often each scene is run in each engine
    std::size_t count = 0;               ///< bodies, roughly; 0: the scene's own number
};

/// One engine on one scene. Each time is taken from each round; what is shown is the median of the rounds.
struct StepRow {
    std::string scene, engine;
    std::string settings;  ///< of the engine, in words
    int threads = 1;
    std::uint64_t steps = 0;
    int rounds = 0;
    Timing ms;
    double least = 0;                      ///< mean of each step's quickest round: what remains without other programs
    double mean_low = 0, mean_high = 0;    ///< the rounds' means: from, to
    std::size_t bodies = 0, contacts = 0;  ///< dynamic bodies; touching pairs at the end
    std::optional<std::uint64_t> hash;     ///< at the end; nullopt: the engine has none
    bool repeats = true;                   ///< the rounds ended with equal hashes and heights
    double top_height = 0, mean_height = 0;  ///< of the bodies' centres at the end, metres
    double drift = 0;                        ///< mean way from where the bodies began, metres
};

/// Told before each step: steps done, of so many, and whose turn it is. Returns false to stop.
using StepProgress =
    std::function<bool(std::uint64_t done, std::uint64_t total, std::string_view scene, std::string_view engine)>;

/// Runs all that the options name. In a round the engines take turns of a few steps each, all in the same minutes of
/// the same machine. Errors: BadArgument for a name that is not there; what an engine says. Stopped: the rows of the
/// scenes that were done.
Result<std::vector<StepRow>> measure_steps(const StepOptions& options, const StepProgress& progress);

}  // namespace fase::bench
