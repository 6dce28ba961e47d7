#pragma once
/// Steps of equal length in a game whose frames take varying time.
#include <algorithm>
#include <cmath>

#include "fase/math/interpolate.hpp"

namespace fase {

/// Counts how many steps of a fixed length a frame must do. Usage, once per frame:
///
///     for (int i = loop.advance(seconds_since_last_frame); i > 0; --i) world.step();
///     draw(interpolate(pose_before_last_step, pose_now, loop.alpha()));
///
/// Source: Fiedler 2004, Fix your timestep!
class FixedStep {
public:
    /// `step`: seconds, above 0. `max_steps`: of one frame, 1 or more; a slower machine then shows slow motion instead
    /// of needing ever more steps.
    explicit FixedStep(double step = 1.0 / 60, int max_steps = 4)
        : step_(step > 0 ? step : 1.0 / 60), max_steps_(std::max(max_steps, 1)) {}

    /// Adds the time that passed and returns the number of steps to do now, 0 to max_steps. Time that would need more
    /// steps is dropped; negative and infinite times and NaN count as 0.
    int advance(double seconds) {
        if (std::isfinite(seconds) && seconds > 0) waiting_ += seconds;
        const double due = std::floor(waiting_ / step_ + 1e-9);  // 1/60 s sixty times is 60 steps
        const int steps = static_cast<int>(std::min(due, static_cast<double>(max_steps_)));
        waiting_ -= static_cast<double>(steps) * step_;
        if (due > static_cast<double>(steps)) {
            const double rest = std::fmod(waiting_, step_);
            dropped_ += waiting_ - rest;
            waiting_ = rest;
        }
        waiting_ = std::max(waiting_, 0.0);
        return steps;
    }
    /// Returns how far the present lies between the last step and the next one, 0 to 1: draw
    /// interpolate(before the last step, after it, alpha()).
    [[nodiscard]] float alpha() const { return static_cast<float>(std::min(waiting_ / step_, 1.0)); }
    /// Seconds of a step.
    [[nodiscard]] double step() const { return step_; }
    /// Seconds that were dropped so far.
    [[nodiscard]] double dropped() const { return dropped_; }
    /// Forgets the time that waits: call it after a pause or a loading screen.
    void reset() { waiting_ = 0; }

private:
    double step_, waiting_ = 0, dropped_ = 0;
    int max_steps_;
};

}  // namespace fase
