#pragma once
/// Declares the options of commands and parses the command line. Values are strict: complete texts, whole numbers, in
/// range, each option once. Hides CLI11, which takes seconds to compile: only arguments.cpp includes it.
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace fase::cli {

/// Handle of a declared option; valid while its CommandLine exists.
class Option {
public:
    explicit Option(CLI::Option* option) : option_(option) {}
    /// Refuses a command line without this option.
    void required();
    /// Refuses this option without `other`.
    void needs(Option other);
    /// Refuses this option together with `other`.
    void excludes(Option other);

private:
    CLI::Option* option_;
};

/// Handle of a command; valid while its CommandLine exists. An option is named as in "-o,--output", a positional
/// argument as in "FILE". `help` is its line in the help text.
class Command {
public:
    explicit Command(CLI::App* app) : app_(app) {}

    /// Adds a command below this one.
    Command add_command(const std::string& name, const std::string& help);
    /// Refuses a command line that names no command below this one.
    void require_command();
    /// Accepts, and ignores, whatever follows this command, `--help` included.
    void take_all_arguments();
    /// Sets the text at the end of the help.
    void set_footer(const std::string& text);
    /// Calls `action` once the command line is parsed, if it names this command.
    void on_parsed(std::function<void()> action);

    /// A text that is not empty: a file or a name.
    Option add_text(const std::string& name, const std::string& help, std::string& text);
    /// Any number of texts.
    Option add_texts(const std::string& name, const std::string& help, std::vector<std::string>& texts);
    /// An option without a value.
    Option add_flag(const std::string& name, const std::string& help, bool& flag);
    /// A decimal number above 0 and at most `max`. Refused: empty, "12abc", "1e999", "nan", hexadecimal.
    Option add_positive_number(const std::string& name, const std::string& help, double max,
                               const std::function<void(double)>& store);
    /// A whole number from `min` to `max`. Refused: empty, signs and blanks, "12abc", "1e3".
    Option add_whole_number(const std::string& name, const std::string& help, std::uint64_t min, std::uint64_t max,
                            const std::function<void(std::uint64_t)>& store);
    /// The same into `number`, whose type must be able to hold `max`.
    template <std::integral T>
    Option add_whole_number(const std::string& name, const std::string& help, std::uint64_t min, std::uint64_t max,
                            T& number) {
        return add_whole_number(name, help, min, max,
                                [&number](std::uint64_t value) { number = static_cast<T>(value); });
    }
    template <std::integral T>
    Option add_whole_number(const std::string& name, const std::string& help, std::uint64_t min, std::uint64_t max,
                            std::optional<T>& number) {
        return add_whole_number(name, help, min, max,
                                [&number](std::uint64_t value) { number = static_cast<T>(value); });
    }

private:
    CLI::App* app_;
};

// Options that several commands share, with the same name and range. `help` may differ.

/// `--threads N`, `min` to 1024.
Option add_threads(Command& command, const std::string& help, std::uint64_t min, int& threads);
/// `--count N`, 1 to 1,000,000.
Option add_count(Command& command, const std::string& help, std::size_t& count);
/// `--seed N`, any 64-bit number.
Option add_seed(Command& command, const std::string& help, std::uint64_t& seed);
Option add_seed(Command& command, const std::string& help, std::optional<std::uint64_t>& seed);
/// `--json`.
Option add_json(Command& command, bool& json);

/// The command line of a program: declared options, then one call of parse().
class CommandLine {
public:
    CommandLine(const std::string& program, const std::string& description, const std::string& version);
    ~CommandLine();
    CommandLine(const CommandLine&) = delete;
    CommandLine& operator=(const CommandLine&) = delete;

    /// The program itself; its commands are below it.
    [[nodiscard]] Command root();
    /// Parses the arguments and calls the action of the named command. nullopt: they are accepted. Otherwise the exit
    /// code, after help or version were printed on stdout, or on stderr one line that names the refused option.
    [[nodiscard]] std::optional<int> parse(int count, const char* const* arguments);

private:
    std::unique_ptr<CLI::App> app_;
};

}  // namespace fase::cli
