#pragma once
/// How far a long command has come: a bar on a terminal, now and then a line elsewhere.
#include <chrono>
#include <cstdint>
#include <string>
#include <string_view>

namespace fase::cli {

/// Where progress goes.
enum class ProgressForm {
    None,
    Bar,    ///< redrawn in place, up to 10 times a second
    Lines,  ///< one every 2 s, for logs
};
/// Bar when stderr is a terminal; else lines, or nothing when only results are wanted.
[[nodiscard]] ProgressForm progress_form(bool results_only);

/// Shows progress on stderr. Cheap enough to be told of every step.
class Progress {
public:
    /// @param total what `done` of update() counts up to; above 0
    Progress(ProgressForm form, std::string_view unit, std::uint64_t total);
    /// Takes the bar off the screen.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    /// @param note a few words on what is going on
    void update(std::uint64_t done, std::string_view note);
    /// Whether update() would show anything now: asks before a note is written.
    [[nodiscard]] bool due() const;

private:
    using Clock = std::chrono::steady_clock;
    void draw_bar(std::uint64_t done, std::string_view note, double seconds);
    ProgressForm form_;
    std::string unit_;
    std::uint64_t total_;
    bool drawn_ = false;
    Clock::time_point begin_, next_;
};

}  // namespace fase::cli
