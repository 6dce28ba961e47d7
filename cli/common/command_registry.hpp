#pragma once
/// Keeps the options of all commands and the action of the one that the command line names.
#include <any>
#include <functional>
#include <list>
#include <utility>

#include "cli/common/arguments.hpp"
#include "cli/common/output.hpp"

namespace fase::cli {

/// Stores each command's options while the command line is parsed, and then runs the named command.
class CommandRegistry {
public:
    CommandRegistry() = default;
    CommandRegistry(const CommandRegistry&) = delete;
    CommandRegistry& operator=(const CommandRegistry&) = delete;

    /// Adds a command's options with their default values. The reference stays valid while the registry exists.
    template <class Options> Options& options() { return options_.emplace_back().emplace<Options>(); }
    /// Sets the action of `command`; it returns an exit code and may refer to options().
    void on(Command& command, std::function<int()> action) {
        command.on_parsed([this, action = std::move(action)] { action_ = action; });
    }
    /// Runs the action of the named command and returns its exit code. Call after the command line is parsed.
    [[nodiscard]] int run() const { return action_ ? action_() : exit_bug; }

private:
    std::list<std::any> options_;
    std::function<int()> action_;
};

}  // namespace fase::cli
