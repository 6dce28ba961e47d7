/// THE list of suites. A new suite is one source that defines a Suite, and its name here.
#include "bench/checks/suites.hpp"

namespace fase::checks {

extern const Suite stacks, bounce, rest, ghosts, tunnels, determinism;

std::span<const Suite* const> suites() {
    static constexpr const Suite* all[]{&stacks, &bounce, &rest, &ghosts, &tunnels, &determinism};
    return all;
}

}  // namespace fase::checks
