/// The command `fase bench pairs`: times how broad phases find the pairs of traces, beside those of other libraries.
#include "cli/bench/pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "bench/pair_engine.hpp"
#include "bench/table_file.hpp"
#include "cli/common/arguments.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/output.hpp"
#include "cli/common/progress.hpp"
#include "cli/common/start.hpp"
#include "cli/common/table.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase::cli {
namespace {

using bench::PairBenchRow;

/// Wrong answers have no times.
bool is_timed(const PairBenchRow& row) { return row.right && row.frames > 0; }

std::string to_json(const std::vector<PairBenchRow>& rows) {
    std::string text = "[";
    for (const PairBenchRow& row : rows) {
        text += text.size() == 1 ? "\n" : ",\n";
        text += fmt::format(
            "{{\"trace\": {}, \"engine\": {}, \"settings\": {}, \"boxes\": {}, \"static\": {}, \"asleep\": {}, "
            "\"frames\": {}, \"checked\": {}, ",
            scene::quoted(row.trace), scene::quoted(row.engine), scene::quoted(row.settings), row.boxes, row.still,
            row.asleep, row.frames, row.right);
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

/// How much longer than the trace's first engine it took; "" for that one.
std::string times_of_first(const std::vector<PairBenchRow>& rows, const PairBenchRow& row) {
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
            table.add_note(row.trace + " " + row.engine, row.right ? "skipped: would take longer than the limit"
                                                                   : "WRONG: other pairs than the first engine");
            continue;
        }
        table.add({row.trace, row.engine, fmt::format("{:.3f}", row.ms.median), fmt::format("{:.3f}", row.low),
                   fmt::format("{:.3f}", row.high), fmt::format("{:.3f}", row.ms.worst),
                   fmt::format("{:.2f}", row.build_ms), times_of_first(rows, row), std::to_string(row.frames),
                   std::to_string(row.pairs)});
    }
    return table.text();
}

Result<void> save(const std::string& file, const std::vector<PairBenchRow>& rows) {
    const bench::Origin origin = bench::origin_of_figures();
    std::vector<std::vector<std::string>> lines;
    for (const PairBenchRow& row : rows) {
        if (!is_timed(row)) continue;
        lines.push_back({origin.date, origin.commit, origin.machine, row.trace, row.engine, row.settings,
                         std::to_string(row.boxes), std::to_string(row.still), std::to_string(row.asleep),
                         std::to_string(row.frames), fmt::format("{:.4f}", row.ms.median),
                         fmt::format("{:.4f}", row.low), fmt::format("{:.4f}", row.high),
                         fmt::format("{:.4f}", row.ms.mean), fmt::format("{:.4f}", row.ms.worst),
                         fmt::format("{:.4f}", row.build_ms), std::to_string(row.pairs),
                         fmt::format("{:016x}", row.hash), row.bytes == 0 ? "" : std::to_string(row.bytes)});
    }
    static const std::vector<std::string> columns{
        "date",      "commit", "machine", "trace",   "engine",   "settings", "boxes", "static", "asleep", "frames",
        "median_ms", "low_ms", "high_ms", "mean_ms", "worst_ms", "build_ms", "pairs", "hash",   "bytes"};
    return lines.empty() ? Result<void>{} : bench::append_to_table(file, columns, lines);
}

}  // namespace

int run_bench_pairs(const BenchPairsOptions& options) {
    if (!options.csv.empty()) {
        if (auto writable = check_output(options.csv); !writable) return refuse(writable.error());
    }
    const Interrupts interrupts;
    std::vector<PairBenchRow> rows;
    // Trace by trace, so that what is measured is kept whatever comes.
    for (const std::string& trace : options.traces) {
        if (Interrupts::signal() != 0) break;
        std::optional<Progress> progress;
        const auto tell = [&](std::uint64_t done, std::uint64_t total, std::string_view name, std::string_view engine) {
            if (!progress) progress.emplace(progress_form(true), "frame", total);
            if (progress->due()) progress->update(done, fmt::format("{} {}", name, engine));
            return Interrupts::signal() == 0;
        };
        const auto measured = bench::measure_pair_engines(trace, options, tell);
        if (!measured) return refuse(measured.error());
        if (!options.csv.empty()) {
            if (auto saved = save(options.csv, *measured); !saved) return refuse(saved.error());
        }
        rows.insert(rows.end(), measured->begin(), measured->end());
    }
    const std::string text = options.json ? to_json(rows) : to_table(rows);
    std::fwrite(text.data(), 1, text.size(), stdout);
    if (Interrupts::signal() != 0) return 128 + Interrupts::signal();
    const bool all_right = std::all_of(rows.begin(), rows.end(), [](const PairBenchRow& row) { return row.right; });
    return all_right ? exit_ok : exit_check_failed;
}

void add_bench_pairs(CLI::App& bench_group, Start& start) {
    auto& bench = start.options<BenchPairsOptions>();
    CLI::App& command = *bench_group.add_subcommand("pairs", "Time how broad phases find the pairs of traces");
    command.add_option("TRACES", bench.traces, "Boxes frame by frame (.aabt)")->required();
    std::string names;
    for (const bench::PairEngineInfo& info : bench::pair_engines()) names += ", " + info.name;
    add_text(command, "--engine",
             "Some of all, structures, peers" + names + ", commas between (default: row_grid,peers)", bench.engine);
    add_whole_number(command, "--frames", "The first N frames (default: all)", 2, 0xffffffff, bench.frames);
    add_positive_number(command, "--limit", "Seconds; an engine that has taken longer drops out (default 30)", 1e6,
                        [&bench](double value) { bench.limit = value; });
    add_text(command, "--csv", "Add the rows to this table", bench.csv);
    add_json(command, bench.json);
    command.footer(
        "\nExamples:\n"
        "  fase generate gas --count 10000 -o gas.aabt && fase bench pairs gas.aabt\n"
        "  fase bench pairs gas.aabt --engine structures --json\n"
        "\nA frame's time is what the processor works to take its boxes and to find all its pairs, with one thread.\n"
        "Engines take turns of a few frames in one run. The first frame is not timed; its pairs are held against a\n"
        "plain sweep's.\n"
        "Exit code 1: an engine found other pairs than the first one did.");
    start.on(command, [&bench] { return run_bench_pairs(bench); });
}

}  // namespace fase::cli
