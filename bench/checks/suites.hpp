#pragma once
/// THE list of suites. The command, the tests and the docs loop over it.
#include <span>

#include "bench/checks/case.hpp"

namespace fase::checks {

[[nodiscard]] std::span<const Suite* const> suites();

}  // namespace fase::checks
