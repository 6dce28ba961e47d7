/// The command `fase bench pairs`: times how broad phases find the pairs of traces, Fase's and other libraries'.
#include "cli/bench/pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <utility>

#include "bench/pair_engine.hpp"
#include "cli/bench/rows.hpp"
#include "cli/common/arguments.hpp"
#include "cli/common/command_registry.hpp"
#include "cli/common/input.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/output.hpp"
#include "cli/common/progress.hpp"
#include "cli/common/table.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase::cli {
namespace {

using bench::PairBenchRow;

/// Times of wrong results are not reported.
bool is_timed(const PairBenchRow& row) { return row.correct && row.frames > 0; }

std::string to_json(const std::vector<PairBenchRow>& rows) {
    std::string text = "[";
    for (const PairBenchRow& row : rows) {
        text += text.size() == 1 ? "\n" : ",\n";
        text += fmt::format(
            "{{\"trace\": {}, \"engine\": {}, \"settings\": {}, \"boxes\": {}, \"static\": {}, \"asleep\": {}, "
            "\"frames\": {}, \"checked\": {}, ",
            scene::quoted(row.trace), scene::quoted(row.engine), scene::quoted(row.settings), row.boxes,
            row.static_count, row.asleep_count, row.frames, row.correct);
        text += is_timed(row) ? fmt::format(
                                    "\"build_ms\": {:.6g}, \"ms\": {{\"mean\": {:.6g}, \"median\": {:.6g}, \"worst\": "
                                    "{:.6g}, \"low\": {:.6g}, \"high\": {:.6g}}}, ",
                                    row.build_ms, row.ms.mean, row.ms.median, row.ms.worst, row.low, row.high)
                              : std::string("\"build_ms\": null, \"ms\": null, ");
        text += fmt::format("\"pairs\": {}, \"hash\": \"{:016x}\", \"bytes\": {}}}", row.pairs, row.hash,
                            row.bytes == 0 ? "null" : std::to_string(row.bytes));
    }
    return text + "\n]\n";
}

/// The time relative to the trace's first engine; "" for that engine.
std::string ratio_to_first(const std::vector<PairBenchRow>& rows, const PairBenchRow& row) {
    const auto first =
        std::find_if(rows.begin(), rows.end(), [&](const PairBenchRow& other) { return other.trace == row.trace; });
    if (&*first == &row || !is_timed(*first)) return {};
    return fmt::format("{:.1f}", row.ms.median / first->ms.median);
}

std::string to_table(const std::vector<PairBenchRow>& rows) {
    Table table({"trace", "engine", "median ms", "one in ten below", "above", "worst ms", "build ms", "times", "frames",
                 "pairs"});
    for (const PairBenchRow& row : rows) {
        if (!is_timed(row)) {
            table.add_note(row.trace + " " + row.engine, row.correct ? "skipped: would take longer than the limit"
                                                                     : "WRONG: other pairs than the first engine");
            continue;
        }
        table.add({row.trace, row.engine, fmt::format("{:.3f}", row.ms.median), fmt::format("{:.3f}", row.low),
                   fmt::format("{:.3f}", row.high), fmt::format("{:.3f}", row.ms.worst),
                   fmt::format("{:.2f}", row.build_ms), ratio_to_first(rows, row), std::to_string(row.frames),
                   std::to_string(row.pairs)});
    }
    return table.text();
}

Result<void> save(const std::string& file, const std::vector<PairBenchRow>& rows) {
    std::vector<std::vector<std::string>> lines;
    for (const PairBenchRow& row : rows) {
        if (!is_timed(row)) continue;
        lines.push_back(
            {row.trace, row.engine, row.settings, std::to_string(row.boxes), std::to_string(row.static_count),
             std::to_string(row.asleep_count), std::to_string(row.frames), fmt::format("{:.4f}", row.ms.median),
             fmt::format("{:.4f}", row.low), fmt::format("{:.4f}", row.high), fmt::format("{:.4f}", row.ms.mean),
             fmt::format("{:.4f}", row.ms.worst), fmt::format("{:.4f}", row.build_ms), std::to_string(row.pairs),
             fmt::format("{:016x}", row.hash), row.bytes == 0 ? "" : std::to_string(row.bytes)});
    }
    static const std::vector<std::string> columns{"trace",    "engine",    "settings", "boxes",   "static",  "asleep",
                                                  "frames",   "median_ms", "low_ms",   "high_ms", "mean_ms", "worst_ms",
                                                  "build_ms", "pairs",     "hash",     "bytes"};
    return append_rows(file, columns, std::move(lines));
}

}  // namespace

int run_bench_pairs(const BenchPairsOptions& options) {
    if (auto writable = check_csv(options.csv); !writable) return refuse(writable.error());
    for (const std::string& trace : options.traces)
        if (auto checked = check_input(trace, {"bench pairs", input::traces, input::trace_kinds}); !checked)
            return refuse(checked.error());
    const Interrupts interrupts;
    std::vector<PairBenchRow> rows;
    // One trace at a time, so that finished rows are saved even if a later trace fails.
    for (const std::string& trace : options.traces) {
        if (Interrupts::signal() != 0) break;
        std::optional<Progress> progress;
        const auto report = [&](std::uint64_t done, std::uint64_t total, std::string_view name,
                                std::string_view engine) {
            if (!progress) progress.emplace("frame", total);
            if (progress->due()) progress->update(done, fmt::format("{} {}", name, engine));
            return Interrupts::signal() == 0;
        };
        const auto measured = bench::measure_pair_engines(trace, options, report);
        if (!measured) return refuse(measured.error());
        if (auto saved = save(options.csv, *measured); !saved) return refuse(saved.error());
        rows.insert(rows.end(), measured->begin(), measured->end());
    }
    const std::string text = options.json ? to_json(rows) : to_table(rows);
    const bool all_correct = std::all_of(rows.begin(), rows.end(), [](const PairBenchRow& row) { return row.correct; });
    return print_rows(text, all_correct);
}

void add_bench_pairs(Command& group, CommandRegistry& registry) {
    auto& bench = registry.options<BenchPairsOptions>();
    Command command = group.add_command("pairs", "Time how broad phases find the pairs of traces");
    command.add_texts("TRACES", "Boxes frame by frame (.aabt)", bench.traces).required();
    std::string names;
    for (const bench::PairEngineInfo& info : bench::pair_engines()) names += ", " + info.name;
    command.add_text("--engine",
                     "Comma-separated list of: all, structures, peers" + names + " (default: row_grid,peers)",
                     bench.engine);
    command.add_whole_number("--frames", "The first N frames (default: all)", 2, 0xffffffff, bench.frames);
    command.add_positive_number("--limit", "Seconds; an engine that takes longer is skipped (default 30)", 1e6,
                                [&bench](double value) { bench.limit = value; });
    command.add_text("--csv", "Append the rows to this CSV file", bench.csv);
    add_json(command, bench.json);
    command.set_footer(
        "\nExamples:\n"
        "  fase generate rain --count 10000 -o rain.aabt && fase bench pairs rain.aabt\n"
        "  fase bench pairs rain.aabt --engine structures --json\n"
        "\nA frame's time is the processor time to update all boxes and to find all pairs, with one thread.\n"
        "Engines alternate every few frames in one run. The first frame is not timed; its pairs are compared with\n"
        "those of a plain sweep.\n"
        "Exit code 1: an engine found other pairs than the first one.");
    registry.on(command, [&bench] { return run_bench_pairs(bench); });
}

}  // namespace fase::cli
