#pragma once
/// Turns Ctrl-C, SIGTERM and SIGHUP into a flag that a loop checks, so that it can stop and keep its results.
#include <string>

namespace fase::cli {

/// While an object exists, the first SIGINT, SIGTERM or SIGHUP is only recorded. A second one, or 0.95 s until the
/// destructor runs, ends the program immediately with 128 + signal. A signal that was ignored at program start stays
/// ignored. At most one object may exist at a time.
class Interrupts {
public:
    /// @param late printed when those 0.95 s are over; lives as long as the program
    explicit Interrupts(const char* late = "stopped during a step; the flushed part of a recording is kept");
    ~Interrupts();
    Interrupts(const Interrupts&) = delete;
    Interrupts& operator=(const Interrupts&) = delete;
    /// The signal that was received; 0: none.
    [[nodiscard]] static int signal();
    /// Names an unfinished file that is removed if a signal ends the program immediately; empty: none.
    void remove_at_exit(const std::string& path);
};

/// Call once, at the start of the program: SIGINT, SIGTERM and SIGHUP remove the temporary file of a file that is being
/// written, and end the program. Those of an Interrupts object go before.
void remove_temporary_files_on_signals();

/// Prints that a signal stopped the command and that `path` is not written; returns 128 + signal.
int refuse_interrupted(const std::string& path);

}  // namespace fase::cli
