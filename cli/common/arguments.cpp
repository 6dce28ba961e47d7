/// Options that take only what they say: whole texts, whole numbers, in their range, once.
#include "cli/common/arguments.hpp"

#include <fmt/format.h>

#include <charconv>
#include <cmath>

#include "cli/common/output.hpp"
#include "fase/broad/any_structure.hpp"

namespace fase::cli {
namespace {

constexpr std::size_t max_shown = 60;

/// The name as the user writes it: "--steps" of "-s,--steps", "FILE" of a positional.
std::string shown(const std::string& name) { return name.substr(name.rfind(',') + 1); }

template <class Kind> bool is(const CLI::ParseError& error) { return dynamic_cast<const Kind*>(&error) != nullptr; }

[[noreturn]] void refuse_value(const std::string& name, const std::string& found, const std::string& need) {
    throw CLI::ValidationError(shown(name), fmt::format("found \"{}\", need {}", printable(found, max_shown), need));
}

}  // namespace

CLI::Option* add_whole_number(CLI::App& app, const std::string& name, const std::string& what, std::uint64_t least,
                              std::uint64_t most, const std::function<void(std::uint64_t)>& take) {
    const auto parse = [=](const std::string& text) {
        std::uint64_t number = 0;
        const char* const end = text.data() + text.size();
        const auto [stop, code] = std::from_chars(text.data(), end, number);
        if (text.empty() || stop != end || code != std::errc{} || number < least || number > most) {
            refuse_value(name, text, fmt::format("a whole number from {} to {}", least, most));
        }
        take(number);
    };
    return app.add_option_function<std::string>(name, parse, what)->type_name("N");
}

CLI::Option* add_positive_number(CLI::App& app, const std::string& name, const std::string& what, double most,
                                 const std::function<void(double)>& take) {
    const auto parse = [=](const std::string& text) {
        double number = 0;
        const char* const end = text.data() + text.size();
        const auto [stop, code] = std::from_chars(text.data(), end, number);
        if (text.empty() || stop != end || code != std::errc{} || !(number > 0 && number <= most)) {
            refuse_value(name, text, fmt::format("a number above 0, at most {}", most));
        }
        take(number);
    };
    return app.add_option_function<std::string>(name, parse, what)->type_name("X");
}

CLI::Option* add_text(CLI::App& app, const std::string& name, const std::string& what, std::string& text) {
    const auto parse = [=, &text](const std::string& value) {
        if (value.empty()) refuse_value(name, value, "a text that is not empty");
        text = value;
    };
    return app.add_option_function<std::string>(name, parse, what);
}

CLI::Option* add_threads(CLI::App& app, const std::string& what, std::uint64_t least, int& threads) {
    return add_whole_number(app, "--threads", what, least, 1024, threads);
}

CLI::Option* add_structure(CLI::App& app, const std::string& what, std::string& structure) {
    return add_text(app, "--structure", what + broad::AnyStructure::names(), structure);
}

CLI::Option* add_count(CLI::App& app, const std::string& what, std::size_t& count) {
    return add_whole_number(app, "--count", what, 1, 1'000'000, count);
}

CLI::Option* add_seed(CLI::App& app, const std::string& what, std::uint64_t& seed) {
    return add_whole_number(app, "--seed", what, 0, ~0ull, seed);
}

CLI::Option* add_json(CLI::App& app, bool& json) {
    return app.add_flag("--json", json, "Print one JSON value and nothing else");
}

std::string usage_problem(const CLI::App& app, const CLI::ParseError& error) {
    std::string command = app.get_name();
    const CLI::App* inner = &app;
    while (!inner->get_subcommands().empty()) {
        inner = inner->get_subcommands().front();
        command += " " + inner->get_name();
    }
    std::string problem = printable(error.what(), 4 * max_shown);
    const bool no_command = inner->get_require_subcommand_min() > 0;
    const std::vector<std::string> left = app.remaining(true);
    if (!left.empty() && (no_command || is<CLI::ExtrasError>(error))) {
        // CLI11 lists all that is left over; the first says enough.
        const std::string first = printable(left.front(), max_shown);
        const bool is_option = first.size() > 1 && first[0] == '-';
        problem = fmt::format("{}: found an unknown {}", first,
                              is_option    ? "option"
                              : no_command ? "command"
                                           : "argument");
    } else if (no_command && is<CLI::RequiredError>(error)) {
        problem = "COMMAND: found none";
    } else if (is<CLI::ArgumentMismatch>(error)) {
        // "--steps: At Most 1 required but received 2", "--steps: 1 required N missing"
        const bool missing = problem.ends_with("missing");
        problem = problem.substr(0, problem.find(": ")) +
                  (missing ? ": found no value, need one" : ": found more than once, need it once");
    }
    if (no_command) {
        std::string names;
        for (const CLI::App* one : inner->get_subcommands({})) names += (names.empty() ? "" : ", ") + one->get_name();
        problem += ", need one of " + names;
    }
    return fmt::format("fase: error: {}; see '{} --help'\n", problem, command);
}

}  // namespace fase::cli
