/// The command `fase bench index`: times a frame of many units and its questions in Fase's index, in grids, in peers.
#include "cli/bench/index.hpp"

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
#include "fase/scene/detail/json.hpp"

namespace fase::cli {
namespace {

using bench::IndexRow;

std::string to_json(const std::vector<IndexRow>& rows) {
    std::string text = "[";
    for (const IndexRow& row : rows)
        text += fmt::format(
            "{}\n{{\"question\": \"{}\", \"contender\": {}, \"settings\": {}, \"units\": {}, \"threads\": {}, "
            "\"rounds\": {}, \"ms\": {{\"median\": {:.6g}, \"low\": {:.6g}, \"high\": {:.6g}, \"worst\": {:.6g}}}, "
            "\"found\": {}, \"compared\": {}, \"differ\": {}}}",
            text.size() == 1 ? "" : ",", row.question, scene::quoted(row.contender), scene::quoted(row.settings),
            row.units, row.threads, row.rounds, row.median_ms, row.low_ms, row.high_ms, row.worst_ms, row.found,
            row.compared, row.differ);
    return text + "\n]\n";
}

std::string cell_of(const IndexRow& row) {
    if (row.differ != 0) return "WRONG";
    const int digits = row.worst_ms < 10 ? 2 : row.worst_ms < 100 ? 1 : 0;
    return fmt::format("{:.{}f} ({:.{}f})", row.median_ms, digits, row.worst_ms, digits);
}

/// A row for each question, a column for each contender.
std::string to_table(const std::vector<IndexRow>& rows) {
    std::vector<std::string> heading{"ms"}, questions;
    for (const IndexRow& row : rows) {
        if (std::find(heading.begin(), heading.end(), row.contender) == heading.end()) heading.push_back(row.contender);
        if (std::find(questions.begin(), questions.end(), row.question) == questions.end())
            questions.push_back(row.question);
    }
    Table table(heading);
    for (const std::string& question : questions) {
        std::vector<std::string> cells{question};
        for (std::size_t i = 1; i < heading.size(); ++i) {
            const auto row = std::find_if(rows.begin(), rows.end(), [&](const IndexRow& one) {
                return one.question == question && one.contender == heading[i];
            });
            cells.push_back(row == rows.end() ? "–" : cell_of(*row));
        }
        table.add(std::move(cells));
    }
    return table.text() + "Median of the rounds, the worst one in brackets.\n";
}

Result<void> save(const std::string& file, const std::vector<IndexRow>& rows) {
    std::vector<std::vector<std::string>> lines;
    for (const IndexRow& row : rows)
        if (row.differ == 0)
            lines.push_back({row.question, row.contender, row.settings, std::to_string(row.units),
                             std::to_string(row.threads), std::to_string(row.rounds),
                             fmt::format("{:.4f}", row.median_ms), fmt::format("{:.4f}", row.low_ms),
                             fmt::format("{:.4f}", row.high_ms), fmt::format("{:.4f}", row.worst_ms),
                             std::to_string(row.found), std::to_string(row.compared)});
    static const std::vector<std::string> columns{"question", "contender", "settings",  "units",
                                                  "threads",  "rounds",    "median_ms", "low_ms",
                                                  "high_ms",  "worst_ms",  "found",     "compared"};
    return append_rows(file, columns, std::move(lines));
}

}  // namespace

int run_bench_index(const BenchIndexOptions& options) {
    if (auto writable = check_csv(options.csv); !writable) return refuse(writable.error());
    const Interrupts interrupts;
    std::optional<Progress> progress;
    const auto report = [&](std::uint64_t done, std::uint64_t total, std::string_view contender) {
        if (!progress) progress.emplace("part", total);
        if (progress->due()) progress->update(done, contender);
        return Interrupts::signal() == 0;
    };
    const auto rows = bench::measure_index(options, report);
    progress.reset();
    if (!rows) return refuse(rows.error());
    if (auto saved = save(options.csv, *rows); !saved) return refuse(saved.error());
    const std::string text = options.json ? to_json(*rows) : to_table(*rows);
    const bool all_right = std::all_of(rows->begin(), rows->end(), [](const IndexRow& row) { return row.differ == 0; });
    return print_rows(text, all_right);
}

void add_bench_index(Command& group, CommandRegistry& registry) {
    auto& bench = registry.options<BenchIndexOptions>();
    Command command = group.add_command("index", "Time an index of many moving units");
    std::string names;
    for (const bench::IndexContenderInfo& info : bench::index_contenders()) names += ", " + std::string(info.name);
    command.add_text("--contender", "all (default), or a comma-separated list of: " + names.substr(2), bench.contender);
    add_count(command, "Units (default 200,000)", bench.units);
    add_seed(command, "Seed of places and moves (default 1)", bench.seed);
    command.add_whole_number("--rounds", "Measured rounds (default 11)", 1, 1000, bench.rounds);
    add_threads(command, "Threads, for contenders that use them (default 1)", 1, bench.threads);
    command.add_text("--csv", "Append the rows to this CSV file", bench.csv);
    add_json(command, bench.json);
    command.set_footer(
        "\nExamples:\n"
        "  fase bench index\n"
        "  fase bench index --contender index,flat_grid --threads 2 --json\n"
        "\nUnits of 1 x 2 x 1 m on a square with 31 m² for each. In a round all move by up to 0.2 m; then come the\n"
        "questions: pairs of boxes within 5 m, the units in 10 rectangles of 100 m, the nearest unit and the nearest\n"
        "eight of 2,000 places, 1,000 rays of 100 m. \"moved\": the first question of its kind after the moves.\n"
        "frame: moves and the first neighbours. grown_pairs: the boxes, larger by half of the radius, that overlap.\n"
        "All contenders alternate in one run. Processor time is measured, with several threads elapsed time.\n"
        "In each round all answers are compared, in the first one with brute force.\n"
        "Exit code 1: a contender gave a wrong answer.");
    registry.on(command, [&bench] { return run_bench_index(bench); });
}

}  // namespace fase::cli
