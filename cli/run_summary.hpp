#pragma once
/// What a run was like, summed up over its steps.
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fase/scene/scene.hpp"
#include "fase/world/stats.hpp"

namespace fase::cli {

/// Collects the reports of a run's steps.
struct RunSummary {
    // Of the scene.
    std::string scene;  ///< as the user named it
    std::size_t bodies = 0, dynamic_bodies = 0, shapes = 0, joints = 0;
    // Of the steps.
    std::vector<double> step_ms;                  ///< each
    std::array<double, stage_count> stage_sum{};  ///< ms
    std::uint32_t peak_contacts = 0, peak_points = 0, peak_awake = 0;
    std::uint64_t speed_clamped = 0, pairs_dropped = 0, quarantined = 0;  ///< summed over the steps
    StepReport last;
    // Of the end.
    double simulated_seconds = 0;
    std::uint64_t hash = 0;
    std::optional<std::size_t> outside;  ///< of a level: bodies that are not in it
    std::uint64_t asked_steps = 0;
    int threads = 1;
    std::vector<std::string> warnings;  ///< each thing once
    std::string recording;              ///< its name; empty: none
    std::uint64_t recorded_frames = 0, recorded_bytes = 0;
    std::string trace;  ///< its name; empty: none
    std::uint64_t traced_frames = 0, traced_bytes = 0;

    void add(const StepReport& report);
    /// Says in `warnings` what the steps had to cut short.
    void add_step_warnings();
};

/// Most memory that the program ever held, in bytes; 0 when the system does not tell.
[[nodiscard]] std::uint64_t peak_memory_bytes();

/// One JSON object of the keys that scripts rely on, and some more.
[[nodiscard]] std::string to_json(const RunSummary& summary);
/// The same as aligned lines for people.
[[nodiscard]] std::string to_table(const RunSummary& summary);

}  // namespace fase::cli
