#pragma once
/// Turns Ctrl-C and SIGTERM into a flag that a loop checks, so that it can stop and keep its results.

namespace fase::cli {

/// While an object exists, the first SIGINT or SIGTERM is only recorded. A second one, or 0.95 s until the destructor
/// runs, ends the program immediately with 128 + signal. A signal that was ignored at program start stays ignored. At
/// most one object may exist at a time.
class Interrupts {
public:
    Interrupts();
    ~Interrupts();
    Interrupts(const Interrupts&) = delete;
    Interrupts& operator=(const Interrupts&) = delete;
    /// The signal that was received; 0: none.
    [[nodiscard]] static int signal();
};

}  // namespace fase::cli
