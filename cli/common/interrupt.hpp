#pragma once
/// Ctrl-C and SIGTERM as a question that a loop asks, so that it can end with all it has done.

namespace fase::cli {

/// While it lives, the first SIGINT or SIGTERM is only noted; a second one, or 0.95 s without an end, ends the program
/// at once with 128 + signal. A signal that was ignored when the program began stays so. At most one lives at a time.
class Interrupts {
public:
    Interrupts();
    ~Interrupts();
    Interrupts(const Interrupts&) = delete;
    Interrupts& operator=(const Interrupts&) = delete;
    /// The signal that came; 0: none.
    [[nodiscard]] static int signal();
};

}  // namespace fase::cli
