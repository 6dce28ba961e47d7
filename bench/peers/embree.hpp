#pragma once
/// Embree in `fase bench queries`: rays against triangles and boxes.
#include <memory>
#include <string_view>

#include "bench/query_contender.hpp"

namespace fase::bench {

/// One thread. Triangles in robust mode; boxes as user geometry with Fase's exact test; refits moving boxes.
std::unique_ptr<QueryContender> make_embree(std::string_view name);

}  // namespace fase::bench
