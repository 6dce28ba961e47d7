#pragma once
/// Bullet's dynamic tree of boxes (btDbvt).
#include <memory>
#include <string_view>

#include "bench/query_contender.hpp"

namespace fase::bench {

/// Built from the top, boxes without margin, our exact test at the leaves. Its ray search does not end at the nearest:
/// it visits all boxes along the ray.
std::unique_ptr<QueryContender> make_bullet_dbvt(std::string_view name);

}  // namespace fase::bench
