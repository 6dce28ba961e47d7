#pragma once
/// Embree: rays at triangles and at boxes.
#include <memory>
#include <string_view>

#include "bench/query_contender.hpp"

namespace fase::bench {

/// One thread. Triangles in its own robust mode; boxes as primitives of ours, with our exact test; boxes that move are
/// refitted.
std::unique_ptr<QueryContender> make_embree(std::string_view name);

}  // namespace fase::bench
