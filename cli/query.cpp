/// The command `fase query`: times and checks rays, boxes and frusta against the boxes of a scene or a trace.
#include "cli/query.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>

#include "cli/common/arguments.hpp"
#include "cli/common/command_registry.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/load_scene.hpp"
#include "cli/common/output.hpp"
#include "cli/common/progress.hpp"
#include "cli/common/table.hpp"
#include "cli/measure_queries.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase::cli {
namespace {

std::uint64_t hits_of(const QueryFigures& row) { return row.rays.hits + row.boxes.hits + row.frusta.hits; }

std::string to_json(const std::vector<QueryFigures>& rows) {
    const auto rate = [](const QueryRate& r) {
        return r.per_second ? fmt::format("{:.6g}", *r.per_second) : std::string("null");
    };
    std::string text = "[";
    for (const QueryFigures& row : rows) {
        text += text.size() == 1 ? "\n" : ",\n";
        text += fmt::format(
            "{{\"structure\": {}, \"build_ms\": {:.6g}, \"rays_per_second\": {}, \"boxes_per_second\": {}, "
            "\"frusta_per_second\": {}, \"hits\": {}, \"checked\": {}, ",
            scene::quoted(row.structure), row.build_ms, rate(row.rays), rate(row.boxes), rate(row.frusta),
            row.complete ? std::to_string(hits_of(row)) : "null",
            row.correct ? (*row.correct ? "true" : "false") : "null");
        text += fmt::format(
            "\"chosen\": {}, \"rays\": {}, \"ray_hits\": {}, \"boxes\": {}, \"box_hits\": {}, \"frusta\": {}, "
            "\"frustum_hits\": {}, \"complete\": {}, \"bytes\": {}}}",
            scene::quoted(row.chosen), row.rays.queries, row.rays.hits, row.boxes.queries, row.boxes.hits,
            row.frusta.queries, row.frusta.hits, row.complete, row.bytes);
    }
    return text + "\n]\n";
}

std::string to_table(const std::vector<QueryFigures>& rows) {
    Table table({"structure", "build ms", "rays/s", "boxes/s", "frusta/s", "rays hit", "boxes hit", "visible", "bytes",
                 "check"});
    const auto rate = [](const QueryRate& r) {
        return r.per_second ? fmt::format("{:.0f}", *r.per_second) : std::string("-");
    };
    for (const QueryFigures& row : rows) {
        const std::string name = row.structure == row.chosen ? row.structure : row.structure + ": " + row.chosen;
        table.add({name, fmt::format("{:.3f}", row.build_ms), rate(row.rays), rate(row.boxes), rate(row.frusta),
                   std::to_string(row.rays.hits), std::to_string(row.boxes.hits), std::to_string(row.frusta.hits),
                   std::to_string(row.bytes), row.correct ? (*row.correct ? "ok" : "WRONG") : "-"});
        if (!row.complete) {
            table.add_note("", fmt::format("stopped at its time limit: after {} rays, {} boxes, {} frusta",
                                           row.rays.queries, row.boxes.queries, row.frusta.queries));
        }
    }
    return table.text();
}

}  // namespace

int run_query(const QueryOptions& options) {
    const Result<std::vector<StructureChoice>> choices = structures_named(options.structure);
    if (!choices) return refuse(choices.error());
    const Result<std::vector<Aabb>> boxes = load_boxes(options.file);
    if (!boxes) return refuse(boxes.error());

    const Interrupts interrupts;
    const QuerySet set = random_queries(*boxes, options.counts, options.seed);
    std::optional<ReferenceAnswers> reference;
    if (options.check) reference = reference_answers(*boxes, set);
    std::vector<QueryFigures> rows;
    {
        Progress progress("structure", choices->size());
        for (const StructureChoice& choice : *choices) {
            const auto go_on = [&] {
                if (progress.due()) progress.update(rows.size(), choice.requested);
                return Interrupts::signal() == 0;
            };
            if (!go_on()) break;
            QueryFigures row =
                measure_queries(*boxes, set, reference ? &*reference : nullptr, choice, options.limit, go_on);
            if (Interrupts::signal() == 0) rows.push_back(std::move(row));
        }
    }
    const std::string head =
        fmt::format("{}: {} box{}; {} rays, {} boxes, {} frusta\n", printable(options.file), boxes->size(),
                    boxes->size() == 1 ? "" : "es", set.rays.size(), set.boxes.size(), set.frusta.size());
    const std::string text = options.json ? to_json(rows) : head + to_table(rows);
    std::fwrite(text.data(), 1, text.size(), stdout);
    if (Interrupts::signal() != 0) return 128 + Interrupts::signal();
    const bool all_correct =
        std::all_of(rows.begin(), rows.end(), [](const QueryFigures& row) { return row.correct.value_or(true); });
    return all_correct ? exit_ok : exit_check_failed;
}

void add_query(Command& program, CommandRegistry& registry) {
    constexpr std::uint64_t max_count = 10'000'000;
    auto& query = registry.options<QueryOptions>();
    Command command = program.add_command("query", "Time and check how structures answer rays, boxes and frusta");
    command
        .add_text("SCENE_OR_TRACE", "A .gltf or .glb file, a kind of 'fase generate', or a trace (its first frame)",
                  query.file)
        .required();
    add_structure(command, "auto (default), all, ", query.structure);
    command.add_whole_number("--rays", "Rays that find their nearest box (default 10000)", 0, max_count,
                             query.counts.rays);
    command.add_whole_number("--boxes", "Boxes that find all boxes they overlap (default 10000)", 0, max_count,
                             query.counts.boxes);
    command.add_whole_number("--frusta", "Frusta that find all visible boxes (default 100)", 0, max_count,
                             query.counts.frusta);
    add_seed(command, "Seed of the random queries (default 1)", query.seed);
    command.add_positive_number("--limit", "Time limit per structure, seconds (default 60)", 1e6,
                                [&query](double value) { query.limit = value; });
    command.add_flag("--check", "Compare the first 64 answers of each kind with brute force", query.check);
    add_json(command, query.json);
    command.set_footer(
        "\nExamples:\n"
        "  fase query castle.glb\n"
        "  fase query uniform.aabt --structure all --check\n"
        "  fase query castle --rays 100000 --boxes 0 --frusta 0 --json\n"
        "\nExit code 1: a structure gave a wrong answer.");
    registry.on(command, [&query] { return run_query(query); });
}

}  // namespace fase::cli
