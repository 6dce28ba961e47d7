/// The command `fase impact`: compares times of impact with queries whose answer is known.
#include "cli/impact.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <vector>

#include "cli/common/arguments.hpp"
#include "cli/common/command_registry.hpp"
#include "cli/common/output.hpp"
#include "cli/impact_queries.hpp"

namespace fase::cli {
namespace {

/// How many answers are right.
struct Tally {
    std::size_t queries = 0, true_positives = 0, false_positives = 0, false_negatives = 0;
    double us = 0;

    [[nodiscard]] double us_per_query() const { return us / static_cast<double>(std::max<std::size_t>(queries, 1)); }
    void add(const Tally& other) {
        queries += other.queries;
        true_positives += other.true_positives;
        false_positives += other.false_positives;
        false_negatives += other.false_negatives;
        us += other.us;
    }
};

bool meets(const ImpactQuery& query, bool edges) {
    const auto& [p, q, r, s] = query.points;
    return edges ? narrow::find_edge_edge_impact({p, q}, {r, s}).has_value()
                 : narrow::find_vertex_face_impact(p, {q, r, s}).has_value();
}

Tally answer(const ImpactFile& file) {
    Tally tally;
    tally.queries = file.queries.size();
    const auto begin = std::chrono::steady_clock::now();
    for (const ImpactQuery& query : file.queries) {
        const bool found = meets(query, file.edges);
        tally.true_positives += found && query.meets ? 1 : 0;
        tally.false_positives += found && !query.meets ? 1 : 0;
        tally.false_negatives += !found && query.meets ? 1 : 0;
    }
    const std::chrono::duration<double, std::micro> taken = std::chrono::steady_clock::now() - begin;
    tally.us = taken.count();
    return tally;
}

std::string line_of(const std::string& name, const Tally& tally) {
    return fmt::format("{:<44} {:>7} {:>7} {:>7} {:>7} {:>9.2f}\n", printable(name), tally.queries,
                       tally.true_positives + tally.false_negatives, tally.false_negatives, tally.false_positives,
                       tally.us_per_query());
}

}  // namespace

int run_impact(const ImpactCommandOptions& options) {
    const auto files = read_impact_files(options.folder);
    if (!files) return refuse(files.error());
    Tally total;
    std::string text =
        fmt::format("{:<44} {:>7} {:>7} {:>7} {:>7} {:>9}\n", "file", "queries", "meet", "missed", "false", "us each");
    for (const ImpactFile& file : *files) {
        const Tally tally = answer(file);
        total.add(tally);
        text += line_of(file.name, tally);
    }
    text += line_of("all", total);
    if (options.json)
        text = fmt::format(
            "{{\"queries\": {}, \"true_positives\": {}, \"false_positives\": {}, "
            "\"false_negatives\": {}, \"us_per_query\": {:.3f}}}\n",
            total.queries, total.true_positives, total.false_positives, total.false_negatives, total.us_per_query());
    std::fwrite(text.data(), 1, text.size(), stdout);
    return total.false_negatives == 0 ? exit_ok : exit_check_failed;
}

void add_impact(Command& program, CommandRegistry& registry) {
    auto& impact = registry.options<ImpactCommandOptions>();
    Command command = program.add_command("impact", "Compare times of impact with queries whose answer is known");
    command.add_text("DIR", "The folder of the queries", impact.folder).required();
    add_json(command, impact.json);
    command.set_footer(
        "\nExample:\n  fase impact ccd-queries\n"
        "\nReads DIR/**/edge-edge/*.csv and DIR/**/vertex-face/*.csv. A query is eight rows: four points at time 0, "
        "then\n"
        "at time 1; they move on straight lines. Points of two edges: a0, a1, b0, b1; of a vertex and a face: the\n"
        "vertex, and the corners of the face. A row: x, y and z, each as numerator,denominator (integers), and 1 or "
        "0:\n"
        "whether they meet. This is the format of the queries of Wang et al. 2021.\n"
        "\nmissed: they meet, but Fase says that they do not; false: the other way round.\n"
        "\nExit code 1: a meeting was missed.");
    registry.on(command, [&impact] { return run_impact(impact); });
}

}  // namespace fase::cli
