/// Runs cases and compares their figures with the limits.
#include "bench/checks/run.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace fase::checks {

std::string row_name(const Case& one, const Figure& figure) { return one.name + "/" + figure.name; }

std::vector<Row> run_case(std::string_view suite, const Case& one, Context context) {
    bool stopped = false;
    context.keep_going = [&stopped, ask = std::move(context.keep_going)] {
        stopped = stopped || !ask();
        return !stopped;
    };
    std::vector<double> measured = one.measure(context);
    std::vector<Row> rows;
    if (stopped) return rows;
    if (measured.size() != one.figures.size() && context.error.empty())
        context.error = "found " + std::to_string(measured.size()) + " values; expected one per figure";
    for (std::size_t i = 0; i < one.figures.size(); ++i) {
        const Figure& figure = one.figures[i];
        const double value = context.error.empty() ? measured[i] : std::numeric_limits<double>::quiet_NaN();
        const bool ok = std::isfinite(value) && value >= figure.low && value <= figure.high;
        rows.push_back({std::string(suite), row_name(one, figure), figure, value, ok, {}});
    }
    const auto failed = std::find_if(rows.begin(), rows.end(), [](const Row& row) { return !row.ok; });
    if (failed != rows.end()) failed->note = context.error.empty() ? context.note : context.error;
    return rows;
}

}  // namespace fase::checks
