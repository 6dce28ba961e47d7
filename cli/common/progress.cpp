/// Progress of a long command: a bar on a terminal, nothing elsewhere.
#include "cli/common/progress.hpp"

#include <fmt/format.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace fase::cli {
namespace {

constexpr auto bar_interval = std::chrono::milliseconds(100);

void write_to_stderr(const std::string& text) {
    std::fwrite(text.data(), 1, text.size(), stderr);
    std::fflush(stderr);
}

std::size_t terminal_width() {
    winsize size{};
    return ::ioctl(2, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 ? size.ws_col : 80;
}

bool stderr_is_terminal() {
    const char* terminal = std::getenv("TERM");
    return ::isatty(2) == 1 && (terminal == nullptr || std::strcmp(terminal, "dumb") != 0);
}

}  // namespace

Progress::Progress(std::string_view unit, std::uint64_t total)
    : shown_(stderr_is_terminal()),
      unit_(unit),
      total_(std::max<std::uint64_t>(total, 1)),
      begin_(Clock::now()),
      next_(begin_ + bar_interval) {}

Progress::~Progress() {
    if (drawn_) write_to_stderr("\r\x1b[K");
}

bool Progress::due() const { return shown_ && Clock::now() >= next_; }

void Progress::update(std::uint64_t done, std::string_view note) {
    if (!due()) return;
    const Clock::time_point now = Clock::now();
    next_ = now + bar_interval;
    draw_bar(done, note, std::chrono::duration<double>(now - begin_).count());
}

void Progress::draw_bar(std::uint64_t done, std::string_view note, double seconds) {
    constexpr std::size_t cells = 24;
    const double part = std::min(1.0, static_cast<double>(done) / static_cast<double>(total_));
    const auto full = static_cast<std::size_t>(part * cells);
    std::string line = fmt::format("[{}{}] {:3.0f} %  {} {}/{}", std::string(full, '#'), std::string(cells - full, '.'),
                                   100 * part, unit_, done, total_);
    if (!note.empty()) line += fmt::format("  {}", note);
    if (done > 0) line += fmt::format("  {:.0f} s left", seconds / part * (1 - part));
    if (line.size() >= terminal_width()) line.resize(terminal_width() - 1);  // ASCII only, so it can be cut anywhere
    write_to_stderr("\r" + line + "\x1b[K");
    drawn_ = true;
}

}  // namespace fase::cli
