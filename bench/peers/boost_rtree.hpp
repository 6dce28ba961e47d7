#pragma once
/// Boost.Geometry's R-tree in `fase bench queries`: boxes that overlap a box.
#include <memory>
#include <string_view>

#include "bench/query_contender.hpp"

namespace fase::bench {

/// Quadratic split, 16 entries per node. Packed at build and again when boxes move.
std::unique_ptr<QueryContender> make_boost_rtree(std::string_view name);

}  // namespace fase::bench
