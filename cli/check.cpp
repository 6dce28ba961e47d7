/// The command `fase check`: Fase's promises, measured on this machine.
#include "cli/check.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <regex>
#include <vector>

#include "bench/checks/run.hpp"
#include "bench/checks/suites.hpp"
#include "cli/common/arguments.hpp"
#include "cli/common/command_registry.hpp"
#include "cli/common/interrupt.hpp"
#include "cli/common/output.hpp"
#include "cli/common/progress.hpp"
#include "fase/scene/detail/json.hpp"

namespace fase::cli {
namespace {

/// A case that was chosen, with its suite.
struct Chosen {
    std::string suite;
    checks::Case one;
};

std::string suite_names(const char* separator) {
    std::string names;
    for (const checks::Suite* suite : checks::suites()) names += std::string(suite->name) + separator;
    return names + "all";
}

Result<std::vector<Chosen>> chosen_cases(const CheckOptions& options) {
    std::optional<std::regex> pattern;
    try {
        if (!options.cases.empty()) pattern.emplace(options.cases);
    } catch (const std::regex_error&) {
        return Error{Status::BadArgument,
                     "--case",
                     "found " + scene::quoted_short(options.cases) + "; expected a regular expression",
                     {}};
    }
    std::vector<Chosen> chosen;
    bool known = options.suite == "all";
    for (const checks::Suite* suite : checks::suites()) {
        if (options.suite != "all" && options.suite != suite->name) continue;
        known = true;
        for (checks::Case& one : suite->cases()) {
            if (options.quick && one.slow) continue;
            // "suite/case", or the name of a figure as the table prints it: "suite/case/figure".
            const std::string name = std::string(suite->name) + "/" + one.name;
            const auto named = [&](const checks::Figure& figure) {
                return std::regex_search(name + "/" + figure.name, *pattern);
            };
            if (pattern && !std::regex_search(name, *pattern) &&
                std::none_of(one.figures.begin(), one.figures.end(), named))
                continue;
            chosen.push_back({std::string(suite->name), std::move(one)});
        }
    }
    if (!known)
        return Error{Status::BadArgument,
                     "SUITE",
                     "found " + scene::quoted_short(options.suite) + "; expected one of " + suite_names(", "),
                     {}};
    if (chosen.empty())
        return Error{Status::BadArgument, "--case", "found no case that matches " + scene::quoted_short(options.cases),
                     "see fase check " + options.suite + " --list"};
    return chosen;
}

std::string number(double value) { return std::isfinite(value) ? fmt::format("{:.6g}", value) : "null"; }

/// The limit in JSON: one number for a figure whose size is limited, else [low, high] with null for none.
std::string limit_json(const checks::Figure& figure) {
    if (!std::isfinite(figure.low) && !std::isfinite(figure.high)) return "null";
    if (figure.low == -figure.high) return number(figure.high);
    return fmt::format("[{}, {}]", number(figure.low), number(figure.high));
}

std::string limit_text(const checks::Figure& figure) {
    const bool low = std::isfinite(figure.low), high = std::isfinite(figure.high);
    if (!low && !high) return "-";
    if (figure.low == figure.high) return fmt::format("{:.4g}", figure.high);
    if (figure.low == -figure.high || !low) return fmt::format("<= {:.4g}", figure.high);
    if (!high) return fmt::format(">= {:.4g}", figure.low);
    return fmt::format("{:.4g} .. {:.4g}", figure.low, figure.high);
}

std::string to_json(const std::vector<checks::Row>& rows) {
    std::string text = "[";
    for (const checks::Row& row : rows) {
        text += text.size() == 1 ? "\n" : ",\n";
        text += fmt::format(
            R"({{"suite": {}, "case": {}, "unit": {}, "expected": {}, "measured": {}, "limit": {}, "ok": {}, "note": {}}})",
            scene::quoted(row.suite), scene::quoted(row.name), scene::quoted(row.figure.unit),
            number(row.figure.expected), number(row.measured), limit_json(row.figure), row.ok ? "true" : "false",
            row.note.empty() ? "null" : scene::quoted(row.note));
    }
    return text + "\n]\n";
}

/// Cells of a table: the first and the last column are left-aligned, the others right-aligned.
std::string aligned(const std::vector<std::vector<std::string>>& lines) {
    std::vector<std::size_t> widths(lines.front().size(), 0);
    for (const auto& line : lines)
        for (std::size_t i = 0; i < line.size(); ++i) widths[i] = std::max(widths[i], line[i].size());
    std::string text;
    for (const auto& line : lines) {
        text += fmt::format("{:<{}}", line[0], widths[0]);
        for (std::size_t i = 1; i + 1 < line.size(); ++i) text += fmt::format("  {:>{}}", line[i], widths[i]);
        text += "  " + line.back() + "\n";
    }
    return text;
}

/// How far a command came until a signal; "" if it came to the end.
std::string interruption(std::size_t finished, std::size_t cases) {
    return finished == cases ? "" : fmt::format("interrupted after {} of {} cases", finished, cases);
}

std::string to_table(const std::vector<checks::Row>& rows, const std::string& interrupted) {
    std::vector<std::vector<std::string>> lines{{"case", "expected", "measured", "limit", "unit", ""}};
    std::string notes;
    std::size_t failed = 0;
    for (const checks::Row& row : rows) {
        if (!row.ok) ++failed;
        lines.push_back({row.suite + "/" + row.name, fmt::format("{:.4g}", row.figure.expected),
                         std::isfinite(row.measured) ? fmt::format("{:.4g}", row.measured) : "none",
                         limit_text(row.figure), std::string(row.figure.unit), row.ok ? "ok" : "FAILED"});
        if (!row.note.empty()) notes += fmt::format("{}/{}: {}\n", row.suite, row.name, row.note);
    }
    return aligned(lines) + notes + (interrupted.empty() ? "" : interrupted + ": ") +
           fmt::format("{} of {} {}figures are within their limits\n", rows.size() - failed, rows.size(),
                       interrupted.empty() ? "" : "measured ");
}

std::string to_list(const std::vector<Chosen>& cases, bool json) {
    if (json) {
        std::string text = "[";
        for (const Chosen& chosen : cases)
            for (const checks::Figure& figure : chosen.one.figures) {
                text += text.size() == 1 ? "\n" : ",\n";
                text += fmt::format(
                    R"({{"suite": {}, "case": {}, "unit": {}, "expected": {}, "limit": {}, "slow": {}}})",
                    scene::quoted(chosen.suite), scene::quoted(checks::row_name(chosen.one, figure)),
                    scene::quoted(figure.unit), number(figure.expected), limit_json(figure), chosen.one.slow);
            }
        return text + "\n]\n";
    }
    std::vector<std::vector<std::string>> lines{{"case", "expected", "limit", "unit", ""}};
    for (const Chosen& chosen : cases)
        for (const checks::Figure& figure : chosen.one.figures)
            lines.push_back({chosen.suite + "/" + checks::row_name(chosen.one, figure),
                             fmt::format("{:.4g}", figure.expected), limit_text(figure), std::string(figure.unit),
                             chosen.one.slow ? "slow" : ""});
    return aligned(lines);
}

}  // namespace

int run_check(const CheckOptions& options) {
    const Result<std::vector<Chosen>> cases = chosen_cases(options);
    if (!cases) return refuse(cases.error());
    std::string text;
    if (options.list) {
        text = to_list(*cases, options.json);
        std::fwrite(text.data(), 1, text.size(), stdout);
        return exit_ok;
    }
    std::vector<checks::Row> rows;
    std::size_t finished = 0;
    const Interrupts interrupts("interrupted during a case");
    {
        Progress progress("case", cases->size());
        for (std::size_t i = 0; i < cases->size() && Interrupts::signal() == 0; ++i) {
            const Chosen& chosen = (*cases)[i];
            const auto keep_going = [&] {
                if (progress.due()) progress.update(i, chosen.suite + "/" + chosen.one.name);
                return Interrupts::signal() == 0;
            };
            checks::Context context;
            context.seed = options.seed;
            context.runs = options.runs.value_or(options.quick ? 20 : 100);
            context.threads = options.threads;
            context.quick = options.quick;
            context.keep_going = keep_going;
            const std::vector<checks::Row> measured = checks::run_case(chosen.suite, chosen.one, context);
            rows.insert(rows.end(), measured.begin(), measured.end());
            finished += measured.empty() ? 0 : 1;
        }
    }
    const std::string interrupted = Interrupts::signal() == 0 ? std::string() : interruption(finished, cases->size());
    text = options.json ? to_json(rows) : to_table(rows, interrupted);
    std::fwrite(text.data(), 1, text.size(), stdout);
    if (options.json && !interrupted.empty()) print_line("warning", interrupted);
    if (Interrupts::signal() != 0) return 128 + Interrupts::signal();
    const bool all_ok = std::all_of(rows.begin(), rows.end(), [](const checks::Row& row) { return row.ok; });
    return all_ok ? exit_ok : exit_check_failed;
}

void add_check(Command& program, CommandRegistry& registry) {
    auto& check = registry.options<CheckOptions>();
    Command command = program.add_command("check", "Measure on this machine what Fase promises");
    command.add_text("SUITE", "One of " + suite_names(", "), check.suite).required();
    command.add_text("--case", "Only cases of which \"suite/case/figure\" matches this regular expression",
                     check.cases);
    add_seed(command, "Seed of random scenes (default 1)", check.seed);
    command.add_whole_number("--runs", "Repetitions of random cases (default 100, or 20 with --quick)", 1, 1000000,
                             check.runs);
    add_threads(command, "Threads of each world (default 1; 0: all cores)", 0, check.threads);
    command.add_flag("--quick", "Shorten long simulations and leave out slow cases", check.quick);
    command.add_flag("--list", "Print the cases and their limits without running them", check.list);
    add_json(command, check.json);
    std::string suites;
    for (const checks::Suite* suite : checks::suites())
        suites += fmt::format("  {:<12} {}\n", suite->name, suite->description);
    command.set_footer("\nSuites:\n" + suites +
                       "\nExamples:\n"
                       "  fase check all --quick\n"
                       "  fase check stacks --case 'crooked_40' --seed 7\n"
                       "\nExit code 1: a figure is outside its limit.");
    registry.on(command, [&check] { return run_check(check); });
}

}  // namespace fase::cli
