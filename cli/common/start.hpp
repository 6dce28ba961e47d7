#pragma once
/// Between the command line and the commands: whose options are whose, and what is to be done.
#include <CLI/CLI.hpp>
#include <any>
#include <functional>
#include <list>
#include <string>
#include <utility>

#include "cli/common/output.hpp"

namespace fase::cli {

/// What the command line asks for. Each command keeps its options here and says what it would do with them; the one
/// that is named is done.
class Start {
public:
    Start() = default;
    Start(const Start&) = delete;
    Start& operator=(const Start&) = delete;

    /// A command's options as they are when nothing is told; they stay where they are as long as this lives.
    template <class Options> Options& options() { return kept_.emplace_back().emplace<Options>(); }
    /// `work()` returns an exit code; it is done when the command line names `command`. `work` may refer to options().
    void on(CLI::App& command, std::function<int()> work) {
        command.callback([this, work = std::move(work)] { work_ = work; });
    }
    /// Does what was asked for. To be called once the command line is read.
    [[nodiscard]] int operator()() const { return work_ ? work_() : exit_bug; }

private:
    std::list<std::any> kept_;
    std::function<int()> work_;
};

}  // namespace fase::cli
