#pragma once
/// The parts of the suite `ghosts`.
#include <vector>

#include "bench/checks/case.hpp"

namespace fase::checks {

/// Walls, steps, ramps and rooms: what must hold bodies.
void append_obstacle_cases(std::vector<Case>& all);

}  // namespace fase::checks
