#pragma once
/// What the adapters of Boost's R-tree have in common.
#include <boost/geometry.hpp>
#include <boost/geometry/index/rtree.hpp>
#include <cstdint>
#include <utility>

#include "fase/geometry/aabb.hpp"

namespace fase::bench::boost_tree {

namespace bg = boost::geometry;
using Point = bg::model::point<float, 3, bg::cs::cartesian>;
using Box = bg::model::box<Point>;
/// A box and its proxy or number.
using Entry = std::pair<Box, std::uint32_t>;

inline Point to_boost(Vec3 v) { return {v.x, v.y, v.z}; }
inline Box to_boost(const Aabb& box) { return {to_boost(box.lo), to_boost(box.hi)}; }

}  // namespace fase::bench::boost_tree
