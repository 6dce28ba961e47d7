/// The command `fase pairs`: plays a trace of boxes to structures, times how they find its pairs, and checks these.
#include "cli/pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "cli/common/arguments.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/output.hpp"
#include "cli/common/progress.hpp"
#include "cli/common/start.hpp"
#include "cli/common/table.hpp"
#include "cli/measure_pairs.hpp"
#include "fase/core/simd.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase::cli {
namespace {

std::string json_of(const PairFigures& row) {
    std::string text = fmt::format("{{\"structure\": {}, \"threads\": {}, \"simd\": {}, ", scene::quoted(row.structure),
                                   row.threads, scene::quoted(simd_level()));
    if (row.skipped.empty()) {
        text += fmt::format(
            "\"frames\": {}, \"build_ms\": {:.6g}, \"ms\": {{\"mean\": {:.6g}, \"median\": {:.6g}, \"worst\": "
            "{:.6g}, \"least\": {:.6g}}}, "
            "\"pairs_first\": {}, \"pairs_last\": {}, \"pairs_sum\": {}, \"hash\": \"{:016x}\", \"bytes\": {}, "
            "\"depth\": {}, \"nodes\": {}, \"boxes_per_leaf\": {:.4g}, \"checked\": {}, \"begun_sum\": {}, "
            "\"ended_sum\": {}, ",
            row.frames, row.build_ms, row.ms.mean, row.ms.median, row.ms.worst, row.min_ms, row.pairs_first,
            row.pairs_last, row.pairs_sum, row.hash, row.stats.bytes, row.stats.depth, row.stats.nodes,
            row.stats.occupancy(), row.right ? (*row.right ? "true" : "false") : "null", row.begun_sum, row.ended_sum);
    } else {
        for (const char* key : {"frames", "build_ms", "ms", "pairs_first", "pairs_last", "pairs_sum", "hash", "bytes",
                                "depth", "nodes", "boxes_per_leaf", "checked", "begun_sum", "ended_sum"})
            text += fmt::format("\"{}\": null, ", key);
    }
    return text + fmt::format("\"chosen\": {}, \"reason\": {}, \"skipped\": {}}}", scene::quoted(row.chosen),
                              row.reason.empty() ? "null" : scene::quoted(row.reason),
                              row.skipped.empty() ? "null" : scene::quoted(row.skipped));
}

std::string to_json(const std::vector<PairFigures>& rows) {
    std::string text = "[";
    for (const PairFigures& row : rows) text += (text.size() == 1 ? "\n" : ",\n") + json_of(row);
    return text + "\n]\n";
}

std::string to_table(const std::vector<PairFigures>& rows) {
    Table table({"structure", "build ms", "mean ms", "median ms", "worst ms", "pairs first", "pairs last", "pairs sum",
                 "bytes", "depth", "a leaf", "hash", "check"});
    for (const PairFigures& row : rows) {
        const std::string name = row.structure == row.chosen ? row.structure : row.structure + ": " + row.chosen;
        if (!row.skipped.empty()) {
            table.add_note(name, "skipped: " + row.skipped);
            continue;
        }
        table.add({name, fmt::format("{:.3f}", row.build_ms), fmt::format("{:.3f}", row.ms.mean),
                   fmt::format("{:.3f}", row.ms.median), fmt::format("{:.3f}", row.ms.worst),
                   std::to_string(row.pairs_first), std::to_string(row.pairs_last), std::to_string(row.pairs_sum),
                   std::to_string(row.stats.bytes), std::to_string(row.stats.depth),
                   fmt::format("{:.1f}", row.stats.occupancy()), fmt::format("{:016x}", row.hash),
                   row.right ? (*row.right ? "ok" : "WRONG") : "-"});
    }
    std::string text = table.text();
    for (const PairFigures& row : rows)
        if (row.begun_sum + row.ended_sum != 0)
            text += fmt::format("{}: {} pairs began, {} ended\n", row.structure, row.begun_sum, row.ended_sum);
    for (const PairFigures& row : rows)
        if (!row.reason.empty()) text += fmt::format("{}: {}\n", row.structure, row.reason);
    return text;
}

std::string head_of(const record::TraceReader& trace, const TraceSurvey& seen, int threads) {
    const auto plural = [](std::uint64_t count, const char* one, const char* many) {
        return fmt::format("{} {}", count, count == 1 ? one : many);
    };
    return fmt::format("{}: {}, {} static, {} asleep; {} of {}; {}\n", printable(trace.path()),
                       plural(trace.boxes(), "box", "boxes"), seen.static_boxes, seen.asleep_boxes, seen.frames,
                       plural(trace.frames(), "frame", "frames"),
                       plural(static_cast<std::uint64_t>(threads), "thread", "threads"));
}

}  // namespace

int run_pairs(const PairsOptions& options) {
    if (Result<void> limited = limit_simd(options.simd); !limited) {
        Error error = limited.error();
        error.where = "--simd";
        return refuse(error);
    }
    const Result<std::vector<StructureChoice>> choices = structures_named(options.structure);
    if (!choices) return refuse(choices.error());
    Result<record::TraceReader> trace = record::TraceReader::open(options.trace);
    if (!trace) return refuse(trace.error());

    const Interrupts interrupts;
    std::optional<Progress> progress;
    std::string begun;
    const Tell tell = [&](std::uint64_t done, std::uint64_t total, std::string_view what) {
        if (begun != what) {
            progress.emplace(progress_form(true), "frame", total);
            begun = what;
        }
        if (progress->due()) progress->update(done, what);
        return Interrupts::signal() == 0;
    };
    const Result<TraceSurvey> seen = survey(*trace, options.frames, options.check, tell);
    if (!seen) return refuse(seen.error());
    const std::unique_ptr<TaskRunner> tasks = make_thread_runner(options.threads);
    const bool bounded = options.structure == "all";
    std::vector<PairFigures> rows;
    for (const StructureChoice& choice : *choices) {
        if (Interrupts::signal() != 0) break;
        Result<PairFigures> row = measure_pairs(*trace, *seen, choice, *tasks, options.changes,
                                                bounded ? std::optional<double>(options.limit) : std::nullopt, tell);
        if (!row) return refuse(row.error());
        if (Interrupts::signal() == 0) rows.push_back(*std::move(row));
    }
    const std::string text = options.json ? to_json(rows) : head_of(*trace, *seen, tasks->threads()) + to_table(rows);
    std::fwrite(text.data(), 1, text.size(), stdout);
    if (Interrupts::signal() != 0) return 128 + Interrupts::signal();
    const bool all_right =
        std::all_of(rows.begin(), rows.end(), [](const auto& row) { return row.right.value_or(true); });
    return all_right ? exit_ok : exit_check_failed;
}

void add_pairs(CLI::App& app, Start& start) {
    auto& pairs = start.options<PairsOptions>();
    CLI::App& command = *app.add_subcommand("pairs", "Time and check how structures find the pairs of a trace");
    add_text(command, "TRACE", "Boxes frame by frame (.aabt): of 'fase generate' or 'fase run --trace'", pairs.trace)
        ->required();
    add_structure(command, "auto (default), all, ", pairs.structure);
    add_threads(command, "0: all cores (default 1)", 0, pairs.threads);
    add_text(command, "--simd", "Widest instructions to use: " + simd_levels() + " (default best)", pairs.simd);
    add_whole_number(command, "--frames", "The first N frames (default: all)", 1, 0xffffffff, pairs.frames);
    add_positive_number(command, "--limit", "Seconds; of all, those that take longer are skipped (default 60)", 1e6,
                        [&pairs](double value) { pairs.limit = value; });
    command.add_flag("--check", pairs.check, "Hold the pairs of each frame against a plain sweep's");
    command.add_flag("--changes", pairs.changes, "Tell which pairs began, stay and ended, instead of listing all");
    add_json(command, pairs.json);
    command.footer(
        "\nExamples:\n"
        "  fase pairs rain.aabt\n"
        "  fase pairs rain.aabt --structure all --check\n"
        "  fase pairs rain.aabt --structure brute_force --frames 10 --threads 4 --json\n"
        "\nA frame's time is that of taking its boxes and finding all its pairs: of two that overlap or touch, unless\n"
        "both are static. The hash is of the pair sets of all frames; the order in which pairs are found does not "
        "count.\nExit code 1: a structure found other pairs than it should have.");
    start.on(command, [&pairs] { return run_pairs(pairs); });
}

}  // namespace fase::cli
