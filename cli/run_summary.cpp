/// Summary of a run over all its steps.
#include "cli/run_summary.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <string_view>

#include "bench/timing.hpp"
#include "cli/common/input.hpp"
#include "cli/common/output.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase::cli {
namespace {

std::string hex(std::uint64_t hash) { return fmt::format("{:016x}", hash); }

std::string bytes_text(std::uint64_t bytes) {
    constexpr std::array<std::string_view, 4> units{"bytes", "KiB", "MiB", "GiB"};
    auto value = static_cast<double>(bytes);
    std::size_t unit = 0;
    for (; value >= 1024 && unit + 1 < units.size(); ++unit) value /= 1024;
    return unit == 0 ? fmt::format("{} bytes", bytes) : fmt::format("{:.1f} {}", value, units[unit]);
}

double stage_mean(const RunSummary& s, std::size_t stage) {
    return s.step_ms.empty() ? 0 : s.stage_sum[stage] / static_cast<double>(s.step_ms.size());
}

}  // namespace

void RunSummary::add(const StepReport& report) {
    step_ms.push_back(report.total_ms);
    for (std::size_t i = 0; i < stage_count; ++i) stage_sum[i] += report.ms[i];
    peak_contacts = std::max(peak_contacts, report.manifolds);
    peak_points = std::max(peak_points, report.contact_points);
    peak_awake = std::max(peak_awake, report.awake);
    speed_clamped += report.speed_clamped;
    pairs_dropped += report.pairs_dropped;
    quarantined += report.quarantined;
    last = report;
}

void RunSummary::add_step_warnings() {
    std::vector<std::string> found;
    if (quarantined > 0)
        found.push_back(
            fmt::format("bodies disabled because their state became NaN or infinite ({} times)", quarantined));
    if (pairs_dropped > 0) found.push_back(fmt::format("pairs above the limit were dropped ({} times)", pairs_dropped));
    if (speed_clamped > 0)
        found.push_back(fmt::format("body speeds were clamped to the limit ({} times)", speed_clamped));
    warnings.insert(warnings.begin(), found.begin(), found.end());
}

std::uint64_t peak_memory_bytes() {
    std::ifstream status("/proc/self/status");
    for (std::string line; std::getline(status, line);) {
        if (line.rfind("VmHWM:", 0) == 0) return std::strtoull(line.c_str() + 6, nullptr, 10) * 1024;
    }
    return 0;
}

std::string to_json(const RunSummary& s) {
    const bench::Timing timing = bench::timing_of(s.step_ms);
    std::vector<std::string> stages, warnings;
    for (std::size_t i = 0; i < stage_count; ++i)
        stages.push_back(fmt::format("\"{}\": {:.6g}", stage_names[i], stage_mean(s, i)));
    for (const std::string& warning : s.warnings) warnings.push_back(scene::quoted(warning));
    std::string text = fmt::format(
        "{{\"scene\": {}, \"bodies\": {}, \"shapes\": {}, \"joints\": {}, \"steps\": {},\n \"ms_per_step\": "
        "{{\"mean\": {:.6g}, \"median\": {:.6g}, \"worst\": {:.6g}}},\n \"stages\": {{{}}},\n ",
        scene::quoted(s.scene), s.bodies, s.shapes, s.joints, s.step_ms.size(), timing.mean, timing.median,
        timing.worst, fmt::join(stages, ", "));
    text += fmt::format("\"contacts\": {}, \"awake\": {}, \"peak_bytes\": {}, \"hash\": \"{}\", \"warnings\": [{}],\n ",
                        s.peak_contacts, s.last.awake, peak_memory_bytes(), hex(s.hash), fmt::join(warnings, ", "));
    return text + fmt::format(
                      "\"seconds\": {:.9g}, \"structure\": {}, \"threads\": {}, \"contact_points\": {}, \"asleep\": "
                      "{}, \"world_bytes\": {}, \"frames\": {}, \"recording_bytes\": {}, \"trace_frames\": {}, "
                      "\"trace_bytes\": {}, \"outside\": {}, \"auto_colliders\": {}}}\n",
                      s.simulated_seconds, scene::quoted(s.last.structure), s.threads, s.peak_points, s.last.asleep,
                      s.last.bytes, s.recorded_frames, s.recorded_bytes, s.traced_frames, s.traced_bytes,
                      s.outside ? std::to_string(*s.outside) : "null", s.made_colliders);
}

std::string to_table(const RunSummary& s) {
    std::string text;
    const auto line = [&](std::string_view name, const std::string& value) {
        text += fmt::format("{:<10} {}\n", name, value);
    };
    const bench::Timing timing = bench::timing_of(s.step_ms);
    for (const std::string& warning : s.warnings) line("warning", printable(warning));
    line("scene", printable(s.scene));
    line("bodies", fmt::format("{}, {} of them dynamic, {} shapes", s.bodies, s.dynamic_bodies, s.shapes));
    if (!s.made.empty()) line("colliders", s.made);
    if (s.joints > 0) line("joints", fmt::format("{}, not simulated yet", s.joints));
    line("steps", fmt::format("{}{}, {:.6g} s simulated", s.step_ms.size(),
                              s.step_ms.size() < s.requested_steps ? fmt::format(" of {}", s.requested_steps) : "",
                              s.simulated_seconds));
    if (!s.step_ms.empty()) {
        line("ms/step",
             fmt::format("{:.3f} mean, {:.3f} median, {:.3f} worst, {} thread{}, {}", timing.mean, timing.median,
                         timing.worst, s.threads, s.threads == 1 ? "" : "s", s.last.structure));
        std::vector<std::string> stages;
        for (std::size_t i = 0; i < stage_count; ++i)
            stages.push_back(fmt::format("{} {:.3f}", stage_names[i], stage_mean(s, i)));
        line("stages", fmt::format("{}  (mean ms)", fmt::join(stages, ", ")));
    }
    line("contacts", fmt::format("at most {}, with {} points", s.peak_contacts, s.peak_points));
    line("awake", fmt::format("{} at the end, at most {}", s.last.awake, s.peak_awake));
    if (s.outside) line("outside", fmt::format("{} bodies at the end", *s.outside));
    line("memory",
         fmt::format("at most {}, {} of it the world", bytes_text(peak_memory_bytes()), bytes_text(s.last.bytes)));
    if (s.show_hash) line("hash", hex(s.hash));
    if (!s.recording.empty()) {
        line("recording",
             fmt::format("{}: {} frames, {}", printable(s.recording), s.recorded_frames, bytes_text(s.recorded_bytes)));
        line("", fmt::format("look at it: fase view {}", printable(shell_word(s.recording))));
    }
    if (!s.trace.empty()) {
        line("trace",
             fmt::format("{}: {} frames, {}", printable(s.trace), s.traced_frames, bytes_text(s.traced_bytes)));
        line("", fmt::format("measure it: fase pairs {}", printable(shell_word(s.trace))));
    }
    return text;
}

}  // namespace fase::cli
