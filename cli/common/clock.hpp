#pragma once
/// The clock that commands measure with.
#include <chrono>

namespace fase::cli {

using Clock = std::chrono::steady_clock;

/// Milliseconds since `begin`.
[[nodiscard]] inline double ms_since(Clock::time_point begin) {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
}

}  // namespace fase::cli
