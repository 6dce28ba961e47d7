/// The command `fase pairs`: times how structures find the pairs of a trace of boxes, and checks the pairs.
#include "cli/pairs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "cli/common/arguments.hpp"
#include "cli/common/command_registry.hpp"
#include "cli/common/input.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/output.hpp"
#include "cli/common/progress.hpp"
#include "cli/common/table.hpp"
#include "cli/measure_mix.hpp"
#include "cli/measure_pairs.hpp"
#include "cli/mix.hpp"
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
            row.stats.occupancy(), row.correct ? (*row.correct ? "true" : "false") : "null", row.begun_sum,
            row.ended_sum);
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
                 "bytes", "depth", "per leaf", "hash", "check"});
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
                   row.correct ? (*row.correct ? "ok" : "WRONG") : "-"});
    }
    std::string text = table.text();
    for (const PairFigures& row : rows)
        if (row.begun_sum + row.ended_sum != 0)
            text += fmt::format("{}: {} pairs began, {} ended\n", row.structure, row.begun_sum, row.ended_sum);
    for (const PairFigures& row : rows)
        if (!row.reason.empty()) text += fmt::format("{}: {}\n", row.structure, row.reason);
    return text;
}

std::string head_of(const record::TraceReader& trace, const TraceSurvey& survey, int threads) {
    const auto plural = [](std::uint64_t count, const char* one, const char* many) {
        return fmt::format("{} {}", count, count == 1 ? one : many);
    };
    return fmt::format("{}: {}, {} static, {} asleep; {} of {}; {}\n", printable(trace.path()),
                       plural(trace.boxes(), "box", "boxes"), survey.static_boxes, survey.asleep_boxes, survey.frames,
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
    if (!options.mix.empty())
        if (auto parsed = parse_mix(options.mix); !parsed) return refuse(parsed.error());
    const bool is_bounded = options.structure == "all" || !options.mix.empty();
    if (options.limit && !is_bounded)
        return refuse(
            {Status::BadArgument, "--limit", "found a single structure; expected --structure all or --mix", {}});
    if (auto checked = check_input(options.trace, {"pairs", input::traces, input::trace_kinds}); !checked)
        return refuse(checked.error());
    Result<record::TraceReader> trace = record::TraceReader::open(options.trace);
    if (!trace) return refuse(trace.error());

    const Interrupts interrupts;
    std::optional<Progress> progress;
    std::string current;
    const ReportProgress report = [&](std::uint64_t done, std::uint64_t total, std::string_view what) {
        if (current != what) {
            progress.emplace("frame", total);
            current = what;
        }
        if (progress->due()) progress->update(done, what);
        return Interrupts::signal() == 0;
    };
    const Result<TraceSurvey> surveyed = survey(*trace, options.frames, options.check, report);
    if (!surveyed) return refuse(surveyed.error());
    const std::unique_ptr<TaskRunner> tasks = make_thread_runner(options.threads);
    if (!options.mix.empty()) {
        if (!options.json) fmt::print("{}", head_of(*trace, *surveyed, tasks->threads()));
        return run_mix(options, *trace, *surveyed, *tasks, report);
    }
    std::vector<PairFigures> rows;
    for (const StructureChoice& choice : *choices) {
        if (Interrupts::signal() != 0) break;
        Result<PairFigures> row =
            measure_pairs(*trace, *surveyed, choice, *tasks, options.changes,
                          is_bounded ? std::optional(options.limit.value_or(60)) : std::nullopt, report);
        if (!row) return refuse(row.error());
        if (Interrupts::signal() == 0) rows.push_back(*std::move(row));
    }
    const std::string text =
        options.json ? to_json(rows) : head_of(*trace, *surveyed, tasks->threads()) + to_table(rows);
    std::fwrite(text.data(), 1, text.size(), stdout);
    if (Interrupts::signal() != 0) return 128 + Interrupts::signal();
    const bool all_correct =
        std::all_of(rows.begin(), rows.end(), [](const auto& row) { return row.correct.value_or(true); });
    return all_correct ? exit_ok : exit_check_failed;
}

void add_pairs(Command& program, CommandRegistry& registry) {
    auto& pairs = registry.options<PairsOptions>();
    Command command = program.add_command("pairs", "Time and check how structures find the pairs of a trace");
    command.add_text("TRACE", "A trace (.aabt) from 'fase generate' or 'fase run --trace'", pairs.trace).required();
    const Option structure = add_structure(command, "auto (default), all, ", pairs.structure);
    Option mix = command.add_text(
        "--mix", "Recommend a structure for so many searches per frame, for example \"1 pairs, 200 rays, 50 boxes\"",
        pairs.mix);
    mix.excludes(structure);
    add_threads(command, "0: all cores (default 1)", 0, pairs.threads);
    command.add_text("--simd", "Widest instructions to use: " + simd_levels() + " (default best)", pairs.simd);
    command.add_whole_number("--frames", "The first N frames (default: all)", 1, 0xffffffff, pairs.frames);
    command.add_positive_number("--limit",
                                "Seconds; with all or --mix, structures that take longer are skipped (default 60)", 1e6,
                                [&pairs](double value) { pairs.limit = value; });
    const Option check =
        command.add_flag("--check", "Compare the pairs of each frame with those of a plain sweep", pairs.check);
    const Option changes =
        command.add_flag("--changes", "Report which pairs begin, stay and end, instead of listing all", pairs.changes);
    mix.excludes(check);
    mix.excludes(changes);
    add_json(command, pairs.json);
    command.set_footer(
        "\nExamples:\n"
        "  fase pairs rain.aabt\n"
        "  fase pairs rain.aabt --structure all --check\n"
        "  fase pairs rain.aabt --structure brute_force --frames 10 --threads 4 --json\n"
        "  fase pairs rain.aabt --mix '1 pairs, 200 rays, 50 boxes'\n"
        "\nA frame's time is the time to update its boxes and to find all pairs of boxes that overlap or touch, "
        "except\n"
        "pairs of two static boxes. The hash covers the pair sets of all frames; the order of pairs does not matter.\n"
        "With --mix one structure answers everything: pairs of awake boxes with all others, random rays and boxes as\n"
        "those of 'fase query'. Times are means per frame; above 1000 rays or boxes they are extrapolated.\n"
        "Exit code 1: a structure found wrong pairs, or gave other answers than the first.");
    registry.on(command, [&pairs] { return run_pairs(pairs); });
}

}  // namespace fase::cli
