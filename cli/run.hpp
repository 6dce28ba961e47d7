#pragma once
/// The command `fase run`: simulates a scene, tells how it went, records it when asked.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace CLI {
class App;
}

namespace fase::cli {

class Start;

/// The most steps of one run: their times are all kept for the medians.
inline constexpr std::uint64_t max_steps = 10'000'000;

struct RunOptions {
    std::string scene;                   ///< a glTF file, a WAD, or a name of scene::generators()
    std::string map;                     ///< of a WAD; empty: its first
    std::size_t count = 0;               ///< of a generated scene or a level: bodies, roughly; 0: its own number
    std::uint64_t seed = 1;              ///< of a generated scene or a level
    std::optional<double> seconds;       ///< of simulated time; without both: 10 s
    std::optional<std::uint64_t> steps;  ///< instead of seconds
    std::string structure = "auto";      ///< the broad phase, by its name
    int threads = 0;                     ///< 0: all cores
    std::optional<double> time_step;     ///< s; without: the scene's
    std::optional<int> sub_steps;        ///< without: the scene's
    bool keep_awake = false;             ///< nothing falls asleep
    std::string record;                  ///< a recording to write; empty: none
    bool record_contacts = false;        ///< with all contact points
    bool durable = false;                ///< each block of it is forced to the disk
    std::string trace;                   ///< a trace of the colliders' boxes to write; empty: none
    bool json = false;                   ///< one JSON value on stdout instead of a table
};

/// Runs the scene and prints times, counts and the world's hash. SIGINT and SIGTERM end it after the step in hand, with
/// the recording whole and the table of what was done. Returns the exit code: 0; 2 the scene or an option cannot be
/// meant; 3 a file cannot be read or written; 4 too little memory; 130 or 143 when a signal ended it.
int run_scene(const RunOptions& options);

/// Adds the command to the program.
void add_run(CLI::App& app, Start& start);

}  // namespace fase::cli
