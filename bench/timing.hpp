#pragma once
/// Many measured times as the few numbers that tables show.
#include <algorithm>
#include <cstddef>
#include <ctime>
#include <span>
#include <vector>

namespace fase::bench {

/// Milliseconds that the processor has worked for this program: for what one thread does, so that other programs do not
/// count.
[[nodiscard]] inline double ms_worked() { return static_cast<double>(std::clock()) * (1000.0 / CLOCKS_PER_SEC); }

/// Of many times; milliseconds.
struct Timing {
    double mean = 0, median = 0, worst = 0;
};

/// The middle one, or the mean of the two in the middle; 0 of none.
[[nodiscard]] inline double median_of(std::span<const double> values) {
    if (values.empty()) return 0;
    std::vector<double> sorted(values.begin(), values.end());
    const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
    std::nth_element(sorted.begin(), middle, sorted.end());
    if (sorted.size() % 2 == 1) return *middle;
    return (*middle + *std::max_element(sorted.begin(), middle)) / 2;
}

/// All zero of none.
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

}  // namespace fase::bench
