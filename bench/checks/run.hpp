#pragma once
/// Runs cases and compares their figures with the limits.
#include <string>
#include <vector>

#include "bench/checks/case.hpp"

namespace fase::checks {

/// One figure of a case that was run.
struct Row {
    std::string suite;
    std::string name;  ///< "case/figure"
    Figure figure;
    double measured = 0;  ///< NaN when the case could not be run
    bool ok = false;
    std::string note;  ///< why; in the first row of a case that is not ok
};

[[nodiscard]] std::string row_name(const Case& one, const Figure& figure);

/// Runs a case and returns a row per figure. Empty when `context.keep_going` stopped it.
[[nodiscard]] std::vector<Row> run_case(std::string_view suite, const Case& one, Context context);

}  // namespace fase::checks
