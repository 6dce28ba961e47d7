/// The command `fase bench sudden`: the worst frames of broad phases when many boxes change at the same time.
#include "cli/bench/sudden.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <utility>

#include "cli/bench/rows.hpp"
#include "cli/common/arguments.hpp"
#include "cli/common/command_registry.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/output.hpp"
#include "cli/common/progress.hpp"
#include "cli/common/table.hpp"
#include "fase/broad/any_structure.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase::cli {
namespace {

using bench::SuddenRow;

std::string to_json(const std::vector<SuddenRow>& rows) {
    std::string text = "[";
    for (const SuddenRow& row : rows)
        text += fmt::format(
            "{}\n{{\"event\": {}, \"structure\": {}, \"boxes\": {}, \"frames\": {}, \"checked\": {}, \"build_ms\": "
            "{:.6g}, \"ms\": {{\"mean\": {:.6g}, \"median\": {:.6g}, \"worst\": {:.6g}}}, \"worst_frame\": {}, "
            "\"pairs\": {}}}",
            text.size() == 1 ? "" : ",", scene::quoted(row.event), scene::quoted(row.structure), row.boxes, row.frames,
            row.correct, row.build_ms, row.ms.mean, row.ms.median, row.ms.worst, row.worst_frame, row.pairs);
    return text + "\n]\n";
}

std::string to_table(const std::vector<SuddenRow>& rows) {
    Table table(
        {"event", "structure", "median ms", "mean ms", "worst ms", "in frame", "worst / mean", "build ms", "pairs"});
    std::string text;
    for (const SuddenRow& row : rows) {
        if (!row.correct) {
            table.add_note(row.event + " " + row.structure, "WRONG: other pairs than a plain sweep");
            continue;
        }
        table.add({row.event, row.structure, fmt::format("{:.3f}", row.ms.median), fmt::format("{:.3f}", row.ms.mean),
                   fmt::format("{:.3f}", row.ms.worst), std::to_string(row.worst_frame),
                   fmt::format("{:.2f}", row.ms.worst / row.ms.mean), fmt::format("{:.2f}", row.build_ms),
                   std::to_string(row.pairs)});
        const std::string about = row.event + ": " + row.about + "\n";
        if (text.find(about) == std::string::npos) text += about;
    }
    return table.text() + text;
}

Result<void> save(const std::string& file, const std::vector<SuddenRow>& rows) {
    std::vector<std::vector<std::string>> lines;
    for (const SuddenRow& row : rows)
        if (row.correct)
            lines.push_back({row.event, row.structure, std::to_string(row.boxes), std::to_string(row.frames),
                             fmt::format("{:.4f}", row.ms.median), fmt::format("{:.4f}", row.ms.mean),
                             fmt::format("{:.4f}", row.ms.worst), std::to_string(row.worst_frame),
                             fmt::format("{:.4f}", row.build_ms), std::to_string(row.pairs)});
    static const std::vector<std::string> columns{"event",   "structure", "boxes",       "frames",   "median_ms",
                                                  "mean_ms", "worst_ms",  "worst_frame", "build_ms", "pairs"};
    return append_rows(file, columns, std::move(lines));
}

}  // namespace

int run_bench_sudden(const BenchSuddenOptions& options) {
    if (auto writable = check_csv(options.csv); !writable) return refuse(writable.error());
    const Interrupts interrupts;
    std::optional<Progress> progress;
    std::string current;
    const auto report = [&](std::uint64_t done, std::uint64_t total, std::string_view what) {
        if (current != what) {
            progress.emplace("frame", total);
            current = what;
        }
        if (progress->due()) progress->update(done, what);
        return Interrupts::signal() == 0;
    };
    const auto rows = bench::measure_sudden(options, report);
    progress.reset();
    if (!rows) return refuse(rows.error());
    if (auto saved = save(options.csv, *rows); !saved) return refuse(saved.error());
    const std::string text = options.json ? to_json(*rows) : to_table(*rows);
    const bool all_correct = std::all_of(rows->begin(), rows->end(), [](const SuddenRow& row) { return row.correct; });
    return print_rows(text, all_correct);
}

void add_bench_sudden(Command& group, CommandRegistry& registry) {
    auto& bench = registry.options<BenchSuddenOptions>();
    Command command = group.add_command("sudden", "Time frames in which many boxes change");
    command.add_text(
        "--structure",
        "Comma-separated list of: auto, " + broad::AnyStructure::names() + " (default: " + bench.structures + ")",
        bench.structures);
    add_count(command, "Boxes (default 100,000)", bench.boxes);
    command.add_whole_number("--frames", "Frames of each event (default 60)", 2, 100000, bench.frames);
    command.add_text("--csv", "Append the rows to this CSV file", bench.csv);
    add_json(command, bench.json);
    command.set_footer(
        "\nExamples:\n"
        "  fase bench sudden\n"
        "  fase bench sudden --structure auto --count 1000000\n"
        "\nA frame's time is the processor time to update all boxes and to find all pairs, with one thread.\n"
        "Exit code 1: a structure found other pairs than a plain sweep, in the middle frame or in the last one.");
    registry.on(command, [&bench] { return run_bench_sudden(bench); });
}

}  // namespace fase::cli
