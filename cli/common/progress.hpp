#pragma once
/// Progress of a long command: a bar on a terminal, nothing elsewhere.
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace fase::cli {

/// Shows progress as a bar on stderr if that is a terminal, up to 10 times a second. update() is cheap enough to call
/// in every step.
class Progress {
public:
    /// @param total the final value of `done` in update(); above 0
    Progress(std::string_view unit, std::uint64_t total);
    /// Clears the bar from the screen.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    /// @param note a few words about the current work
    void update(std::uint64_t done, std::string_view note);
    /// Whether update() would show anything now. Check it before you format a note.
    [[nodiscard]] bool due() const;

private:
    using Clock = std::chrono::steady_clock;
    void draw_bar(std::uint64_t done, std::string_view note, double seconds);
    bool shown_;
    std::string unit_;
    std::uint64_t total_;
    bool drawn_ = false;
    Clock::time_point begin_, next_;
};

}  // namespace fase::cli
