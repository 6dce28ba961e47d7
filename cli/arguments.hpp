#pragma once
/// Options that take only what they say: whole texts, whole numbers, in their range, once.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>

namespace fase::cli {

/// A whole number from `least` to `most`. Refused: empty, signs and blanks, "12abc", "1e3".
CLI::Option* add_whole_number(CLI::App& app, const std::string& name, const std::string& what, std::uint64_t least,
                              std::uint64_t most, const std::function<void(std::uint64_t)>& take);

/// A decimal number above 0 and at most `most`. Refused: empty, "12abc", "1e999", "nan", hexadecimal.
CLI::Option* add_positive_number(CLI::App& app, const std::string& name, const std::string& what, double most,
                                 const std::function<void(double)>& take);

/// A text that is not empty: a file or a name.
CLI::Option* add_text(CLI::App& app, const std::string& name, const std::string& what, std::string& text);

/// Why a command line was refused: one line that names the option and where to find help. `app` is the whole program.
[[nodiscard]] std::string usage_problem(const CLI::App& app, const CLI::ParseError& error);

}  // namespace fase::cli
