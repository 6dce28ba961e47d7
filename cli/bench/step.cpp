/// The command `fase bench step`: times complete steps of benchmark scenes, in Fase and in other engines.
#include "cli/bench/step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "bench/engine.hpp"
#include "cli/bench/rows.hpp"
#include "cli/common/arguments.hpp"
#include "cli/common/command_registry.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/output.hpp"
#include "cli/common/progress.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase::cli {
namespace {

template <class List> std::string names_of(const List& list) {
    std::string names;
    for (const auto& item : list) names += (names.empty() ? "" : ", ") + std::string(item.name);
    return names;
}

std::string hash_text(const bench::StepRow& row) { return row.hash ? fmt::format("{:016x}", *row.hash) : ""; }

std::string to_json(const std::vector<bench::StepRow>& rows) {
    std::string text = "[";
    for (const bench::StepRow& row : rows) {
        text += text.size() == 1 ? "\n" : ",\n";
        text += fmt::format(
            "{{\"scene\": {}, \"engine\": {}, \"threads\": {}, \"steps\": {}, \"ms_per_step\": {{\"mean\": {:.6g}, "
            "\"median\": {:.6g}, \"worst\": {:.6g}, \"least\": {:.6g}}}, ",
            scene::quoted(row.scene), scene::quoted(row.engine), row.threads, row.steps, row.ms.mean, row.ms.median,
            row.ms.worst, row.min_ms);
        text += fmt::format(
            "\"bodies\": {}, \"contacts\": {}, \"hash\": {}, \"top_height\": {:.9g}, \"drift\": {:.9g}, ", row.bodies,
            row.contacts, row.hash ? scene::quoted(hash_text(row)) : "null", row.top_height, row.drift);
        text += fmt::format(
            "\"rounds\": {}, \"mean_low\": {:.6g}, \"mean_high\": {:.6g}, \"mean_height\": {:.9g}, "
            "\"repeats\": {}, \"settings\": {}}}",
            row.rounds, row.mean_low, row.mean_high, row.mean_height, row.repeats, scene::quoted(row.settings));
    }
    return text + "\n]\n";
}

/// The time and the heights of an engine relative to Fase on the same scene; "" when Fase was not run.
std::string compared_with_fase(const std::vector<bench::StepRow>& rows, const bench::StepRow& row) {
    const auto fase = std::find_if(rows.begin(), rows.end(), [&](const bench::StepRow& other) {
        return other.engine == "fase" && other.scene == row.scene;
    });
    if (fase == rows.end() || row.engine == "fase" || fase->ms.median <= 0 || fase->min_ms <= 0) return {};
    return fmt::format(
        "{:.2f} times the time of fase ({:.2f} by minimum times); relative to it: top {:+.3f} m, mean height {:+.3f} m",
        row.ms.median / fase->ms.median, row.min_ms / fase->min_ms, row.top_height - fase->top_height,
        row.mean_height - fase->mean_height);
}

std::string to_table(const std::vector<bench::StepRow>& rows, bool show_hash) {
    std::string text;
    for (const bench::StepRow& row : rows) {
        text += fmt::format(
            "{:<14} {:<7} {:8.3f} ms per step (rounds {:.3f} to {:.3f}; median {:.3f}, worst {:.3f}, min "
            "{:.3f})\n",
            row.scene, row.engine, row.ms.mean, row.mean_low, row.mean_high, row.ms.median, row.ms.worst, row.min_ms);
        text += fmt::format(
            "{:22} {} steps, {} rounds, {} thread{}, {} bodies, {} contacts; top {:.3f} m, mean height {:.3f} m, "
            "drift {:.3f} m\n",
            "", row.steps, row.rounds, row.threads, row.threads == 1 ? "" : "s", row.bodies, row.contacts,
            row.top_height, row.mean_height, row.drift);
        text += fmt::format("{:22} {}{}{}\n", "", row.settings, show_hash && row.hash ? ", hash " + hash_text(row) : "",
                            row.repeats ? "" : ", rounds DIFFER");
        const std::string comparison = compared_with_fase(rows, row);
        if (!comparison.empty()) text += fmt::format("{:22} {}\n", "", comparison);
    }
    return text;
}

Result<void> save(const std::string& file, const std::vector<bench::StepRow>& rows) {
    std::vector<std::vector<std::string>> lines;
    for (const bench::StepRow& row : rows) {
        lines.push_back(
            {row.scene, row.engine, row.settings, fmt::format("{}", row.threads), fmt::format("{}", row.steps),
             fmt::format("{}", row.rounds), fmt::format("{:.4f}", row.ms.mean), fmt::format("{:.4f}", row.ms.median),
             fmt::format("{:.4f}", row.ms.worst), fmt::format("{:.4f}", row.min_ms),
             fmt::format("{:.4f}", row.mean_low), fmt::format("{:.4f}", row.mean_high), fmt::format("{}", row.bodies),
             fmt::format("{}", row.contacts), hash_text(row), fmt::format("{:.4f}", row.top_height),
             fmt::format("{:.4f}", row.mean_height), fmt::format("{:.4f}", row.drift)});
    }
    static const std::vector<std::string> columns{"scene",       "engine",       "settings",  "threads",  "steps",
                                                  "rounds",      "mean_ms",      "median_ms", "worst_ms", "min_ms",
                                                  "mean_ms_low", "mean_ms_high", "bodies",    "contacts", "hash",
                                                  "top_height",  "mean_height",  "drift"};
    return append_rows(file, columns, std::move(lines));
}

}  // namespace

int run_bench_step(const BenchStepOptions& options) {
    if (auto writable = check_csv(options.csv); !writable) return refuse(writable.error());
    const Interrupts interrupts;
    std::vector<bench::StepRow> rows;
    std::vector<std::string> scenes;
    if (!options.scene.empty()) scenes.push_back(options.scene);
    for (const bench::StepScene& scene : bench::step_scenes()) {
        if (options.scene.empty()) scenes.emplace_back(scene.name);
    }
    // One scene at a time, so that finished rows are saved even if a later scene fails.
    for (std::size_t i = 0; i < scenes.size() && Interrupts::signal() == 0; ++i) {
        bench::StepOptions scene_options = options;
        scene_options.scene = scenes[i];
        std::optional<Progress> progress;
        const auto report = [&](std::uint64_t done, std::uint64_t total, std::string_view scene,
                                std::string_view engine) {
            if (!progress) progress.emplace("step", total);
            if (progress->due()) progress->update(done, fmt::format("{} {}", scene, engine));
            return Interrupts::signal() == 0;
        };
        const Result<std::vector<bench::StepRow>> measured = bench::measure_steps(scene_options, report);
        if (!measured) return refuse(measured.error());
        if (auto saved = save(options.csv, *measured); !saved) return refuse(saved.error());
        rows.insert(rows.end(), measured->begin(), measured->end());
    }
    const std::string text = options.json ? to_json(rows) : to_table(rows, options.hash);
    const bool all_repeat =
        std::all_of(rows.begin(), rows.end(), [](const bench::StepRow& row) { return row.repeats || !row.hash; });
    return print_rows(text, all_repeat);
}

void add_bench_step(Command& group, CommandRegistry& registry) {
    auto& bench = registry.options<BenchStepOptions>();
    Command command = group.add_command("step", "Time complete steps of benchmark scenes");
    command.add_text("--scene", "One of " + names_of(bench::step_scenes()) + " (default: all)", bench.scene);
    command.add_text("--engine", "all (default), or a comma-separated list of: " + names_of(bench::engines()),
                     bench.engine);
    add_threads(command, "Threads, for engines that use them (default 1)", 1, bench.threads);
    command.add_whole_number("--steps", "Steps (default: the scene's)", 1, 100000, bench.steps);
    command.add_whole_number("--rounds", "Repetitions of the whole measurement (default 3)", 1, 1000, bench.rounds);
    add_count(command, "Bodies, roughly (default: the scene's)", bench.count);
    command.add_text("--csv", "Append the rows to this CSV file", bench.csv);
    const Option hash = command.add_flag("--hash", "Print the hashes of the final states", bench.hash);
    add_json(command, bench.json).excludes(hash);
    command.set_footer(
        "\nExamples:\n"
        "  fase bench step --scene large_pyramid\n"
        "  fase bench step --engine fase --threads 4 --json\n"
        "\nEngines alternate every few steps in one run, so that noise of the machine affects all of them.\n"
        "Exit code 1: the rounds of a deterministic engine ended in different states.");
    registry.on(command, [&bench] { return run_bench_step(bench); });
}

}  // namespace fase::cli
