#pragma once
/// Options that take only what they say: whole texts, whole numbers, in their range, once.
#include <CLI/CLI.hpp>
#include <concepts>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>

namespace fase::cli {

/// A whole number from `least` to `most`. Refused: empty, signs and blanks, "12abc", "1e3".
CLI::Option* add_whole_number(CLI::App& app, const std::string& name, const std::string& what, std::uint64_t least,
                              std::uint64_t most, const std::function<void(std::uint64_t)>& take);

/// The same into `number`, which must be able to hold `most`.
template <std::integral T>
CLI::Option* add_whole_number(CLI::App& app, const std::string& name, const std::string& what, std::uint64_t least,
                              std::uint64_t most, T& number) {
    return add_whole_number(app, name, what, least, most,
                            [&number](std::uint64_t value) { number = static_cast<T>(value); });
}
template <std::integral T>
CLI::Option* add_whole_number(CLI::App& app, const std::string& name, const std::string& what, std::uint64_t least,
                              std::uint64_t most, std::optional<T>& number) {
    return add_whole_number(app, name, what, least, most,
                            [&number](std::uint64_t value) { number = static_cast<T>(value); });
}

/// A decimal number above 0 and at most `most`. Refused: empty, "12abc", "1e999", "nan", hexadecimal.
CLI::Option* add_positive_number(CLI::App& app, const std::string& name, const std::string& what, double most,
                                 const std::function<void(double)>& take);

/// A text that is not empty: a file or a name.
CLI::Option* add_text(CLI::App& app, const std::string& name, const std::string& what, std::string& text);

// Options that several commands have; `what` where it differs from one to the other.

/// `--threads N`, `least` to 1024.
CLI::Option* add_threads(CLI::App& app, const std::string& what, std::uint64_t least, int& threads);
/// `--structure NAME`, with the names that there are at the end of `what`.
CLI::Option* add_structure(CLI::App& app, const std::string& what, std::string& structure);
/// `--count N`, 1 to 1,000,000.
CLI::Option* add_count(CLI::App& app, const std::string& what, std::size_t& count);
/// `--seed N`.
CLI::Option* add_seed(CLI::App& app, const std::string& what, std::uint64_t& seed);
/// `--json`.
CLI::Option* add_json(CLI::App& app, bool& json);

/// Why a command line was refused: one line that names the option and where to find help. `app` is the whole program.
[[nodiscard]] std::string usage_problem(const CLI::App& app, const CLI::ParseError& error);

}  // namespace fase::cli
