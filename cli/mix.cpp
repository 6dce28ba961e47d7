/// `fase pairs --mix`: which structure suits a program that finds pairs, casts rays and queries boxes.
#include "cli/mix.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <vector>

#include "cli/common/interrupt.hpp"
#include "cli/common/output.hpp"
#include "cli/common/table.hpp"
#include "cli/measure_mix.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase::cli {
namespace {

std::string json_of(const MixFigures& row) {
    if (!row.skipped.empty())
        return fmt::format(
            "{{\"structure\": {}, \"total_ms\": null, \"build_ms\": null, \"update_ms\": null, \"pairs_ms\": null, "
            "\"rays_ms\": null, \"boxes_ms\": null, \"bytes\": null, \"skipped\": {}}}",
            scene::quoted(row.structure), scene::quoted(row.skipped));
    return fmt::format(
        "{{\"structure\": {}, \"total_ms\": {:.6g}, \"build_ms\": {:.6g}, \"update_ms\": {:.6g}, \"pairs_ms\": {:.6g}, "
        "\"rays_ms\": {:.6g}, \"boxes_ms\": {:.6g}, \"bytes\": {}, \"skipped\": null}}",
        scene::quoted(row.structure), row.total_ms(), row.build_ms, row.update_ms, row.pairs_ms, row.rays_ms,
        row.boxes_ms, row.bytes);
}

/// Whether the rows begin with a structure that was measured; the sorted ones do if any was.
bool has_best(const std::vector<MixFigures>& rows) { return !rows.empty() && rows[0].skipped.empty(); }

std::string to_json(const std::vector<MixFigures>& rows, const QueryMix& mix, std::uint64_t frames, bool agree) {
    std::string text = fmt::format(
        "{{\"mix\": {{\"pairs\": {}, \"rays\": {}, \"boxes\": {}}}, \"frames\": {}, \"best\": {}, \"agree\": {}, "
        "\"all\": [",
        mix.pairs, mix.rays, mix.boxes, frames, has_best(rows) ? scene::quoted(rows[0].structure) : "null", agree);
    for (const MixFigures& row : rows) text += (&row == rows.data() ? "\n" : ",\n") + json_of(row);
    return text + "\n]}\n";
}

std::string to_table(const std::vector<MixFigures>& rows, const QueryMix& mix, bool agree) {
    std::string text = agree ? "" : "WRONG: structures gave different answers\n";
    if (has_best(rows)) text += fmt::format("recommended for {} per frame: {}\n", text_of(mix), rows[0].structure);
    Table table(
        {"structure", "total ms", "times", "update ms", "pairs ms", "rays ms", "boxes ms", "build ms", "bytes"});
    for (const MixFigures& row : rows) {
        if (!row.skipped.empty()) {
            table.add_note(row.structure, "skipped: " + row.skipped);
            continue;
        }
        const auto ms = [](double value) { return fmt::format("{:.4f}", value); };
        table.add({row.structure, ms(row.total_ms()), fmt::format("{:.2f}", row.total_ms() / rows[0].total_ms()),
                   ms(row.update_ms), ms(row.pairs_ms), ms(row.rays_ms), ms(row.boxes_ms),
                   fmt::format("{:.3f}", row.build_ms), std::to_string(row.bytes)});
    }
    return text + table.text();
}

}  // namespace

int run_mix(const PairsOptions& options, record::TraceReader& trace, const TraceSurvey& survey, TaskRunner& tasks,
            const ReportProgress& report) {
    const Result<QueryMix> mix = parse_mix(options.mix);
    if (!mix) return refuse(mix.error());
    const Result<std::vector<StructureChoice>> choices = structures_named("all");
    if (!choices) return refuse(choices.error());
    std::vector<MixFigures> rows;
    for (const StructureChoice& choice : *choices) {
        Result<MixFigures> row = measure_mix(trace, survey, choice, *mix, tasks, options.limit.value_or(60), report);
        if (!row) return refuse(row.error());
        if (Interrupts::signal() != 0) break;
        rows.push_back(*std::move(row));
    }
    std::stable_sort(rows.begin(), rows.end(), [](const MixFigures& a, const MixFigures& b) {
        if (a.skipped.empty() != b.skipped.empty()) return a.skipped.empty();
        return a.skipped.empty() && a.total_ms() < b.total_ms();
    });
    const bool agree = std::all_of(rows.begin(), rows.end(), [&](const MixFigures& row) {
        return !row.skipped.empty() || row.answers == rows[0].answers;
    });
    const std::string text = options.json ? to_json(rows, *mix, survey.frames, agree) : to_table(rows, *mix, agree);
    std::fwrite(text.data(), 1, text.size(), stdout);
    if (Interrupts::signal() != 0) return 128 + Interrupts::signal();
    return agree ? exit_ok : exit_check_failed;
}

}  // namespace fase::cli
