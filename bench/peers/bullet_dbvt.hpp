#pragma once
/// Bullet's dynamic tree of boxes (btDbvt) in `fase bench queries`.
#include <memory>
#include <string_view>

#include "bench/query_contender.hpp"

namespace fase::bench {

/// Built top-down, boxes without margin, Fase's exact test at the leaves. Its ray search does not stop at the nearest
/// hit: it visits all boxes along the ray.
std::unique_ptr<QueryContender> make_bullet_dbvt(std::string_view name);

}  // namespace fase::bench
