/// Turns Ctrl-C, SIGTERM and SIGHUP into a flag that a loop checks, so that it can stop and keep its results.
#include "cli/common/interrupt.hpp"

#include <signal.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <cstddef>
#include <cstring>
#include <initializer_list>

#include "cli/common/output.hpp"
#include "fase/core/detail/files.hpp"

namespace fase::cli {
namespace {

/// Global: a signal handler has no other access to state.
volatile sig_atomic_t received = 0;
const char* late_text = "";
/// A file name that signal handlers read. Assigned by one thread.
struct FileName {
    char text[4096] = "";

    void assign(const char* name) {
        text[0] = '\0';  // first: a signal must not see a mixture of two names
        const std::size_t size = std::strlen(name) + 1;
        if (size == 1 || size > sizeof text) return;
        std::memcpy(text + 1, name + 1, size - 1);
        text[0] = name[0];
    }
    void unlink() const {
        if (text[0] != '\0') ::unlink(text);
    }
};
FileName unfinished_file;  // of remove_at_exit()
FileName temporary_file;   // of write_file()

constexpr timeval grace_period{0, 950000};

void exit_at_once() {
    unfinished_file.unlink();
    temporary_file.unlink();
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

extern "C" void end_program(int number) {
    temporary_file.unlink();
    ::signal(number, SIG_DFL);
    ::raise(number);
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
    handle(SIGALRM, SIG_DFL);
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) handle(number, end_program);
    unfinished_file.assign("");
}

void Interrupts::remove_at_exit(const std::string& path) { unfinished_file.assign(path.c_str()); }

void remove_temporary_files_on_signals() {
    observe_parts([](const char* part) { temporary_file.assign(part); });
    for (const int number : {SIGINT, SIGTERM, SIGHUP}) handle(number, end_program);
}

int Interrupts::signal() { return received; }

int refuse_interrupted(const std::string& path) {
    print_line("interrupted", path + " is not written");
    return 128 + Interrupts::signal();
}

}  // namespace fase::cli
