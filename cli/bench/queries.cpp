/// The command `fase bench queries`: times rays, overlaps and cameras in each structure and in other libraries.
#include "cli/bench/queries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>
#include <utility>

#include "cli/bench/rows.hpp"
#include "cli/common/arguments.hpp"
#include "cli/common/command_registry.hpp"
#include "cli/common/input.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/output.hpp"
#include "cli/common/progress.hpp"
#include "cli/common/table.hpp"
#include "fase/broad/any_structure.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase::cli {
namespace {

std::string to_json(const std::vector<bench::QueryRow>& rows) {
    std::string text = "[";
    for (const bench::QueryRow& row : rows) {
        text += text.size() == 1 ? "\n" : ",\n";
        text += fmt::format(
            "{{\"scene\": {}, \"contender\": {}, \"kind\": \"{}\", \"things\": {}, \"rounds\": {}, \"asked\": {}, "
            "\"per_second\": {:.6g}, \"low\": {:.6g}, \"high\": {:.6g}, \"hits\": {}, \"compared\": {}, \"differ\": "
            "{}, ",
            scene::quoted(row.scene), scene::quoted(row.contender), row.kind, row.items, row.rounds, row.queries,
            row.per_second, row.low, row.high, row.hits, row.compared, row.differ);
        text += fmt::format("\"build_ms\": {:.6g}, \"bytes\": {}, \"settings\": {}}}", row.build_ms,
                            row.bytes == 0 ? "null" : std::to_string(row.bytes), scene::quoted(row.settings));
    }
    return text + "\n]\n";
}

std::string to_table(const std::vector<bench::QueryRow>& rows) {
    Table table({"contender", "kind", "per second", "low", "high", "queries", "hits", "differ", "build ms", "scene"});
    for (const bench::QueryRow& row : rows) {
        table.add({row.contender, row.kind, fmt::format("{:.0f}", row.per_second), fmt::format("{:.0f}", row.low),
                   fmt::format("{:.0f}", row.high), std::to_string(row.queries), std::to_string(row.hits),
                   std::to_string(row.differ), fmt::format("{:.1f}", row.build_ms), printable(row.scene)});
    }
    return table.text();
}

Result<void> save(const std::string& file, const std::vector<bench::QueryRow>& rows) {
    std::vector<std::vector<std::string>> lines;
    for (const bench::QueryRow& row : rows) {
        lines.push_back({row.scene, row.contender, row.settings, row.kind, std::to_string(row.items),
                         std::to_string(row.rounds), std::to_string(row.queries), fmt::format("{:.1f}", row.per_second),
                         fmt::format("{:.1f}", row.low), fmt::format("{:.1f}", row.high), std::to_string(row.hits),
                         std::to_string(row.compared), std::to_string(row.differ), fmt::format("{:.2f}", row.build_ms),
                         row.bytes == 0 ? "" : std::to_string(row.bytes)});
    }
    static const std::vector<std::string> columns{"scene",  "contender", "settings",   "kind",     "things",
                                                  "rounds", "asked",     "per_second", "low",      "high",
                                                  "hits",   "compared",  "differ",     "build_ms", "bytes"};
    return append_rows(file, columns, std::move(lines));
}

/// Structures of the registry must give identical answers; other libraries may round differently.
bool is_wrong(const bench::QueryRow& row) {
    return row.differ != 0 && broad::AnyStructure::named(row.contender).has_value();
}

}  // namespace

int run_bench_queries(const BenchQueriesOptions& options) {
    if (!options.meshes.empty() && !options.scene.empty() && options.scene != "level")
        return refuse({Status::BadArgument, "--mesh", "found another --scene with it; expected level", {}});
    if (options.counts.items > 0 && options.scene == "level")
        return refuse({Status::BadArgument, "--count", "found --scene level with it; expected static or pile", {}});
    static constexpr FileKind mesh_kinds[]{FileKind::Obj};
    for (const std::string& mesh : options.meshes)
        if (auto checked = check_input(mesh, {"bench queries --mesh", "OBJ meshes", mesh_kinds}); !checked)
            return refuse(checked.error());
    if (auto writable = check_csv(options.csv); !writable) return refuse(writable.error());
    const Result<std::vector<bench::QueryScene>> scenes = bench::query_scenes(options);
    if (!scenes) return refuse(scenes.error());
    const Interrupts interrupts;
    std::vector<bench::QueryRow> rows;
    for (const bench::QueryScene& scene : *scenes) {
        std::optional<Progress> progress;
        const auto report = [&](std::uint64_t done, std::uint64_t total, std::string_view name,
                                std::string_view contender) {
            if (!progress) progress.emplace("part", total);
            if (progress->due()) progress->update(done, fmt::format("{} {}", name, contender));
            return Interrupts::signal() == 0;
        };
        const Result<std::vector<bench::QueryRow>> measured = bench::measure_queries(scene, options, report);
        if (!measured) return refuse(measured.error());
        if (auto saved = save(options.csv, *measured); !saved) return refuse(saved.error());
        rows.insert(rows.end(), measured->begin(), measured->end());
        if (Interrupts::signal() != 0) break;
    }
    const std::string text = options.json ? to_json(rows) : to_table(rows);
    return print_rows(text, std::none_of(rows.begin(), rows.end(), is_wrong));
}

void add_bench_queries(Command& group, CommandRegistry& registry) {
    auto& bench = registry.options<BenchQueriesOptions>();
    Command command = group.add_command("queries", "Time rays, overlaps and cameras");
    std::string names;
    for (const bench::QueryContenderInfo& info : bench::query_contenders()) names += ", " + info.name;
    command.add_text("--scene", "level, static or pile (default: all)", bench.scene);
    command.add_texts("--mesh", "OBJ files for the scene level (default: a generated mesh)", bench.meshes);
    command.add_text("--contender", "all (default), or a comma-separated list of: " + names.substr(2), bench.contender);
    command.add_whole_number("--count", "Boxes of the scene static (default 1000000); pile has 1/50 of it", 1,
                             100000000, [&bench](std::uint64_t count) { bench.counts.items = count; });
    command.add_whole_number("--rays", "Rays (default 100000)", 1, 100000000,
                             [&bench](std::uint64_t count) { bench.counts.rays = count; });
    command.add_whole_number("--boxes", "Overlap queries (default 100000)", 1, 100000000,
                             [&bench](std::uint64_t count) { bench.counts.boxes = count; });
    command.add_whole_number("--frusta", "Cameras (default 200)", 1, 1000000,
                             [&bench](std::uint64_t count) { bench.counts.frusta = count; });
    command.add_whole_number("--rounds", "Repetitions of the whole measurement (default 3)", 1, 1000, bench.rounds);
    command.add_positive_number("--seconds", "Time limit for each kind, contender and round (default 1)", 3600,
                                [&bench](double seconds) { bench.seconds = seconds; });
    command.add_text("--csv", "Append the rows to this CSV file", bench.csv);
    add_json(command, bench.json);
    command.set_footer(
        "\nExamples:\n"
        "  fase bench queries --scene static --contender wide_bvh,dynamic_bvh\n"
        "  fase bench queries --scene level --mesh building.obj --json\n"
        "\nAll contenders alternate in one run, so that noise of the machine affects all of them. Processor time is\n"
        "measured. In the scene pile all boxes move in each frame, and the updates are included. Before the timing,\n"
        "each answer is compared with Fase's, and a part of Fase's answers with brute force.\n"
        "Exit code 1: one of Fase's structures gave a wrong answer.");
    registry.on(command, [&bench] { return run_bench_queries(bench); });
}

}  // namespace fase::cli
