/// Declares the options of commands and parses the command line, on CLI11.
#include "cli/common/arguments.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdio>

#include "cli/common/output.hpp"

namespace fase::cli {
namespace {

constexpr std::size_t max_shown = 60;

/// The name as the user writes it: "--steps" of "-s,--steps", "FILE" of a positional.
std::string shown(const std::string& name) { return name.substr(name.rfind(',') + 1); }

template <class Kind> bool is(const CLI::ParseError& error) { return dynamic_cast<const Kind*>(&error) != nullptr; }

[[noreturn]] void refuse_value(const std::string& name, const std::string& found, const std::string& need) {
    throw CLI::ValidationError(shown(name),
                               fmt::format("found \"{}\"; expected {}", printable(found, max_shown), need));
}

/// Why a command line was refused: one line that names the option and where to find help.
std::string usage_problem(const CLI::App& program, const CLI::ParseError& error) {
    std::string command = program.get_name();
    const CLI::App* inner = &program;
    while (!inner->get_subcommands().empty()) {
        inner = inner->get_subcommands().front();
        command += " " + inner->get_name();
    }
    std::string problem = printable(error.what(), 4 * max_shown);
    const bool no_command = inner->get_require_subcommand_min() > 0;
    const std::vector<std::string> left = program.remaining(true);
    if (!left.empty() && (no_command || is<CLI::ExtrasError>(error))) {
        // CLI11 lists all unknown arguments; the first is enough.
        const std::string first = printable(left.front(), max_shown);
        const bool is_option = first.size() > 1 && first[0] == '-';
        problem = fmt::format("{}: found an unknown {}", first,
                              is_option    ? "option"
                              : no_command ? "command"
                                           : "argument");
    } else if (no_command && is<CLI::RequiredError>(error)) {
        problem = "COMMAND: found none";
    } else if (const std::size_t at = problem.find(" requires "); is<CLI::RequiresError>(error) && at != problem.npos) {
        problem = fmt::format("{}: found no {}; expected both", problem.substr(0, at), problem.substr(at + 10));
    } else if (const std::size_t with = problem.find(" excludes ");
               is<CLI::ExcludesError>(error) && with != problem.npos) {
        problem = fmt::format("{}: found {} with it; expected one of the two", problem.substr(0, with),
                              problem.substr(with + 10));
    } else if (is<CLI::ArgumentMismatch>(error)) {
        // "--steps: At Most 1 required but received 2", "--steps: 1 required N missing"
        const bool missing = problem.ends_with("missing");
        problem = problem.substr(0, problem.find(": ")) +
                  (missing ? ": found no value; expected one" : ": found several times; expected once");
    }
    if (no_command) {
        std::string names;
        for (const CLI::App* one : inner->get_subcommands({})) names += (names.empty() ? "" : ", ") + one->get_name();
        problem += "; expected one of " + names;
    }
    return fmt::format("fase: error: {}; see '{} --help'\n", problem, command);
}

}  // namespace

void Option::required() { option_->required(); }
void Option::needs(Option other) { option_->needs(other.option_); }
void Option::excludes(Option other) { option_->excludes(other.option_); }

Command Command::add_command(const std::string& name, const std::string& help) {
    return Command(app_->add_subcommand(name, help));
}
void Command::require_command() { app_->require_subcommand(1); }
void Command::take_all_arguments() {
    app_->prefix_command();
    app_->set_help_flag();
}
void Command::set_footer(const std::string& text) { app_->footer(text); }
void Command::on_parsed(std::function<void()> action) { app_->callback(std::move(action)); }

Option Command::add_text(const std::string& name, const std::string& help, std::string& text) {
    const auto parse = [name, &text](const std::string& value) {
        if (value.empty()) refuse_value(name, value, "a text that is not empty");
        text = value;
    };
    return Option(app_->add_option_function<std::string>(name, parse, help));
}

Option Command::add_texts(const std::string& name, const std::string& help, std::vector<std::string>& texts) {
    return Option(app_->add_option(name, texts, help));
}

Option Command::add_flag(const std::string& name, const std::string& help, bool& flag) {
    return Option(app_->add_flag(name, flag, help));
}

Option Command::add_positive_number(const std::string& name, const std::string& help, double max,
                                    const std::function<void(double)>& store) {
    const auto parse = [=](const std::string& text) {
        double number = 0;
        const char* const end = text.data() + text.size();
        const auto [stop, code] = std::from_chars(text.data(), end, number);
        if (text.empty() || stop != end || code != std::errc{} || !(number > 0 && number <= max)) {
            refuse_value(name, text, fmt::format("a number above 0, at most {}", max));
        }
        store(number);
    };
    return Option(app_->add_option_function<std::string>(name, parse, help)->type_name("X"));
}

Option Command::add_whole_number(const std::string& name, const std::string& help, std::uint64_t min, std::uint64_t max,
                                 const std::function<void(std::uint64_t)>& store) {
    const auto parse = [=](const std::string& text) {
        std::uint64_t number = 0;
        const char* const end = text.data() + text.size();
        const auto [stop, code] = std::from_chars(text.data(), end, number);
        if (text.empty() || stop != end || code != std::errc{} || number < min || number > max) {
            refuse_value(name, text, fmt::format("a whole number from {} to {}", min, max));
        }
        store(number);
    };
    return Option(app_->add_option_function<std::string>(name, parse, help)->type_name("N"));
}

Option add_threads(Command& command, const std::string& help, std::uint64_t min, int& threads) {
    return command.add_whole_number("--threads", help, min, 1024, threads);
}

Option add_count(Command& command, const std::string& help, std::size_t& count) {
    return command.add_whole_number("--count", help, 1, 1'000'000, count);
}

Option add_seed(Command& command, const std::string& help, std::uint64_t& seed) {
    return command.add_whole_number("--seed", help, 0, ~0ull, seed);
}
Option add_seed(Command& command, const std::string& help, std::optional<std::uint64_t>& seed) {
    return command.add_whole_number("--seed", help, 0, ~0ull, seed);
}

Option add_json(Command& command, bool& json) {
    return command.add_flag("--json", "Print one JSON value and nothing else", json);
}

CommandLine::CommandLine(const std::string& program, const std::string& description, const std::string& version)
    : app_(std::make_unique<CLI::App>(description, program)) {
    app_->set_version_flag("--version", version);
}
CommandLine::~CommandLine() = default;

Command CommandLine::root() { return Command(app_.get()); }

std::optional<int> CommandLine::parse(int count, const char* const* arguments) {
    try {
        app_->parse(count, arguments);
    } catch (const CLI::Success& help) {
        app_->exit(help);  // prints help or version on stdout
        return exit_ok;
    } catch (const CLI::ParseError& error) {
        const std::string line = usage_problem(*app_, error);
        std::fwrite(line.data(), 1, line.size(), stderr);
        return exit_bad_input;
    }
    return std::nullopt;
}

}  // namespace fase::cli
