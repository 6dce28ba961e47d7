#pragma once
/// Parts of the suite `rest`.
#include <vector>

#include "bench/checks/case.hpp"

namespace fase::checks {

/// Sensors over sleeping bodies, and the step in which the end of an overlap is told.
void append_sensor_cases(std::vector<Case>& cases);

}  // namespace fase::checks
