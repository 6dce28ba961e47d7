#pragma once
/// Summary of a run over all its steps.
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fase/scene/scene.hpp"
#include "fase/world/stats.hpp"

namespace fase::cli {

/// Collects the reports of all steps of a run.
struct RunSummary {
    // The scene.
    std::string scene;  ///< its name on the command line
    std::size_t bodies = 0, dynamic_bodies = 0, shapes = 0, joints = 0;
    // The steps.
    std::vector<double> step_ms;                  ///< of each step
    std::array<double, stage_count> stage_sum{};  ///< ms
    std::uint32_t peak_contacts = 0, peak_points = 0, peak_awake = 0;
    std::uint64_t speed_clamped = 0, pairs_dropped = 0, quarantined = 0;  ///< summed over the steps
    StepReport last;
    // The end of the run.
    double simulated_seconds = 0;
    std::uint64_t hash = 0;
    bool show_hash = false;              ///< in the table
    std::optional<std::size_t> outside;  ///< of a level: bodies outside it
    std::uint64_t requested_steps = 0;
    int threads = 1;
    std::vector<std::string> warnings;  ///< the worst first
    std::string made;                   ///< what automatic colliders were added; empty: none
    std::size_t made_colliders = 0;
    std::string recording;  ///< file name; empty: none
    std::uint64_t recorded_frames = 0, recorded_bytes = 0;
    std::string trace;  ///< file name; empty: none
    std::uint64_t traced_frames = 0, traced_bytes = 0;

    void add(const StepReport& report);
    /// Puts warnings about limits that steps reached before all others.
    void add_step_warnings();
};

/// Peak resident memory of the program in bytes; 0 if the system does not report it.
[[nodiscard]] std::uint64_t peak_memory_bytes();

/// One JSON object with the keys that scripts rely on, and a few more.
[[nodiscard]] std::string to_json(const RunSummary& summary);
/// The same as aligned lines.
[[nodiscard]] std::string to_table(const RunSummary& summary);

}  // namespace fase::cli
