#pragma once
/// Statistics of measured times for tables.
#include <algorithm>
#include <chrono>
#include <cstddef>
#include <ctime>
#include <span>
#include <utility>
#include <vector>

namespace fase::bench {

/// Processor time of this process so far, in milliseconds. For single-threaded code: excludes other programs.
[[nodiscard]] inline double cpu_ms() { return static_cast<double>(std::clock()) * (1000.0 / CLOCKS_PER_SEC); }

/// Time of the steady clock, in milliseconds. For code with threads.
[[nodiscard]] inline double wall_ms() {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Statistics of a set of times, in milliseconds.
struct Timing {
    double mean = 0, median = 0, worst = 0;
};

/// Returns the middle value, or the mean of the two middle ones; 0 for an empty list.
[[nodiscard]] inline double median_of(std::span<const double> values) {
    if (values.empty()) return 0;
    std::vector<double> sorted(values.begin(), values.end());
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    if (sorted.size() % 2 == 1) return *middle;
    return (*middle + *std::max_element(sorted.begin(), middle)) / 2;
}

/// Returns mean, median and maximum; all 0 for an empty list.
[[nodiscard]] inline Timing timing_of(std::span<const double> values) {
    Timing timing;
    if (values.empty()) return timing;
    for (const double value : values) {
        timing.mean += value;
        timing.worst = std::max(timing.worst, value);
    }
    timing.mean /= static_cast<double>(values.size());
    timing.median = median_of(values);
    return timing;
}

/// Returns the values that a tenth of all are below and above; 0 for an empty list.
[[nodiscard]] inline std::pair<double, double> tenths_of(std::span<const double> values) {
    if (values.empty()) return {};
    std::vector<double> sorted(values.begin(), values.end());
    std::sort(sorted.begin(), sorted.end());
    return {sorted[sorted.size() / 10], sorted[sorted.size() - 1 - sorted.size() / 10]};
}

}  // namespace fase::bench
