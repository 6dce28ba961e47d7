#pragma once
/// The command `fase check`: Fase's promises, measured on this machine.
#include <cstdint>
#include <optional>
#include <string>

namespace fase::cli {

class Command;
class CommandRegistry;

struct CheckOptions {
    std::string suite;  ///< a name of checks::suites(), or "all"
    std::string cases;  ///< a regular expression for "suite/case"; empty: all
    std::uint64_t seed = 1;
    std::optional<int> runs;  ///< of random cases; nullopt: 100, or 20 with `quick`
    int threads = 1;
    bool quick = false;  ///< shortens long simulations and leaves out slow cases
    bool list = false;   ///< prints the cases without running them
    bool json = false;
};

/// Runs the cases and prints a row per figure. Exit code 1: one is outside its limit.
int run_check(const CheckOptions& options);

void add_check(Command& program, CommandRegistry& registry);

}  // namespace fase::cli
