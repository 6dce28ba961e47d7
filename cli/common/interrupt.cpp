/// Turns Ctrl-C and SIGTERM into a flag that a loop checks, so that it can stop and keep its results.
#include "cli/common/interrupt.hpp"

#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <initializer_list>

namespace fase::cli {
namespace {

/// Global: a signal handler has no other access to state.
volatile sig_atomic_t received = 0;

constexpr timeval grace_period{0, 950000};

extern "C" void record_signal(int number) {
    if (received != 0) ::_exit(128 + received);
    received = number;
    const int before = errno;
    const itimerval once{{0, 0}, grace_period};
    ::setitimer(ITIMER_REAL, &once, nullptr);
    errno = before;
}

extern "C" void exit_after_grace_period(int) {
    constexpr char text[] = "\nfase: stopped during a step; the flushed part of a recording is kept\n";
    if (::write(2, text, sizeof text - 1) < 0) ::_exit(128 + received);
    ::_exit(128 + received);
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
    received = 0;
    handle(SIGALRM, exit_after_grace_period);
    handle(SIGINT, record_signal);
    handle(SIGTERM, record_signal);
}

Interrupts::~Interrupts() {
    const itimerval never{};
    ::setitimer(ITIMER_REAL, &never, nullptr);
    for (const int number : {SIGINT, SIGTERM, SIGALRM}) handle(number, SIG_DFL);
}

int Interrupts::signal() { return received; }

}  // namespace fase::cli
