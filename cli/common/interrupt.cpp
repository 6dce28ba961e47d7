/// Turns Ctrl-C, SIGTERM and SIGHUP into a flag that a loop checks, so that it can stop and keep its results.
#include "cli/common/interrupt.hpp"

#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <initializer_list>

#include "cli/common/output.hpp"

namespace fase::cli {
namespace {

/// Global: a signal handler has no other access to state.
volatile sig_atomic_t received = 0;
const char* late_text = "";
char unfinished_file[4096] = "";

constexpr timeval grace_period{0, 950000};

void exit_at_once() {
    if (unfinished_file[0] != '\0') ::unlink(unfinished_file);
    ::_exit(128 + received);
}

extern "C" void record_signal(int number) {
    if (received != 0) exit_at_once();
    received = number;
    const int before = errno;
    const itimerval once{{0, 0}, grace_period};
    ::setitimer(ITIMER_REAL, &once, nullptr);
    errno = before;
}

extern "C" void exit_after_grace_period(int) {
    for (const char* text : {"\nfase: ", late_text, "\n"})
        if (::write(2, text, std::strlen(text)) < 0) break;
    exit_at_once();
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

Interrupts::Interrupts(const char* late) {
    received = 0;
    late_text = late;
    handle(SIGALRM, exit_after_grace_period);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) handle(number, record_signal);
}

Interrupts::~Interrupts() {
    const itimerval never{};
    ::setitimer(ITIMER_REAL, &never, nullptr);
    for (const int number : {SIGINT, SIGTERM, SIGHUP, SIGALRM}) handle(number, SIG_DFL);
    unfinished_file[0] = '\0';
}

void Interrupts::remove_at_exit(const std::string& path) {
    unfinished_file[0] = '\0';  // first: a signal must not see a mixture of two names
    if (path.empty() || path.size() >= sizeof unfinished_file) return;
    std::memcpy(unfinished_file + 1, path.c_str() + 1, path.size());
    unfinished_file[0] = path[0];
}

int Interrupts::signal() { return received; }

int refuse_interrupted(const std::string& path) {
    print_line("interrupted", path + " is not written");
    return 128 + Interrupts::signal();
}

}  // namespace fase::cli
