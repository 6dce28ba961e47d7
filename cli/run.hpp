#pragma once
/// The command `fase run`: simulates a scene, prints a summary, and records the motion on request.
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace fase::cli {

class Command;
class CommandRegistry;

/// Limit of steps in one run: their times are all stored for the medians.
inline constexpr std::uint64_t max_steps = 10'000'000;

struct RunOptions {
    std::string scene;      ///< a glTF file, a WAD, or a name of scene::generators()
    std::string map;        ///< of a WAD file; empty: its first map
    std::size_t count = 0;  ///< of a generated scene or a level: approximate number of bodies; 0: its default
    std::optional<std::uint64_t> seed;   ///< of a generated scene or a level; default: 1
    std::optional<double> seconds;       ///< simulated time; without seconds and steps: 10 s
    std::optional<std::uint64_t> steps;  ///< instead of seconds
    std::string structure = "auto";      ///< name of the broad phase
    int threads = 0;                     ///< 0: all cores
    std::optional<double> time_step;     ///< s; default: the scene's
    std::optional<int> sub_steps;        ///< default: the scene's
    bool keep_awake = false;             ///< no body falls asleep
    std::string auto_colliders;          ///< hull or box: give meshes without a collider one; empty: none
    std::string static_nodes;            ///< with auto_colliders: a regular expression of names; empty: none
    std::string record;                  ///< a recording to write; empty: none
    bool record_contacts = false;        ///< include all contact points
    bool durable = false;                ///< force each block of the recording to the disk
    std::string trace;                   ///< a trace of the colliders' boxes to write; empty: none
    bool hash = false;                   ///< print the world's hash in the table
    bool json = false;                   ///< one JSON value on stdout instead of a table
};

/// Runs the scene and prints warnings, times and counts. SIGINT and SIGTERM end the run after the current step:
/// the recording is complete up to there and the summary is printed. Returns the exit code: 0; 1 nothing in the scene
/// has physics; 2 the scene or an option is invalid; 3 a file cannot be read or written; 4 too little memory; 130 or
/// 143 when a signal ended the run.
int run_scene(const RunOptions& options);

/// Adds the command to the program.
void add_run(Command& program, CommandRegistry& registry);

}  // namespace fase::cli
