/// Ctrl-C and SIGTERM as a question that a loop asks, so that it can end with all it has done.
#include "cli/common/interrupt.hpp"

#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <initializer_list>

namespace fase::cli {
namespace {

/// A signal handler can reach nothing else.
volatile sig_atomic_t came = 0;

constexpr timeval patience{0, 950000};

extern "C" void note_signal(int number) {
    if (came != 0) ::_exit(128 + came);
    came = number;
    const int before = errno;
    const itimerval once{{0, 0}, patience};
    ::setitimer(ITIMER_REAL, &once, nullptr);
    errno = before;
}

extern "C" void lose_patience(int) {
    constexpr char text[] = "\nfase: stopped in the middle of a step; what was flushed of a recording is kept\n";
    if (::write(2, text, sizeof text - 1) < 0) ::_exit(128 + came);
    ::_exit(128 + came);
}

void handle(int number, void (*handler)(int)) {
    struct sigaction now {};
    if (::sigaction(number, nullptr, &now) == 0 && now.sa_handler == SIG_IGN && handler != SIG_DFL) return;
    struct sigaction action {};
    action.sa_handler = handler;
    action.sa_flags = SA_RESTART;
    ::sigemptyset(&action.sa_mask);
    if (now.sa_handler != SIG_IGN) ::sigaction(number, &action, nullptr);
}

}  // namespace

Interrupts::Interrupts() {
    came = 0;
    handle(SIGALRM, lose_patience);
    handle(SIGINT, note_signal);
    handle(SIGTERM, note_signal);
}

Interrupts::~Interrupts() {
    const itimerval never{};
    ::setitimer(ITIMER_REAL, &never, nullptr);
    for (const int number : {SIGINT, SIGTERM, SIGALRM}) handle(number, SIG_DFL);
}

int Interrupts::signal() { return came; }

}  // namespace fase::cli
