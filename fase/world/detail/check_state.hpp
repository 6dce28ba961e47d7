#pragma once
/// Whether a state that was read from bytes is one that a world can have.
#include <string_view>

#include "fase/world/detail/state.hpp"

namespace fase {

/// Returns the first part of a state that is wrong, for the message; empty when all is right. The ids must be checked
/// before (IdPool::restore()). Allocates; O(state).
[[nodiscard]] std::string_view wrong_part(const WorldState& state);

}  // namespace fase
