/// Compiles the searches for every SIMD target and selects one at run time.
#include "fase/core/detail/simd_targets.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fase/broad/wide_bvh/kernels.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "fase/broad/boxes/local_stack.hpp"
#include "fase/broad/wide_bvh/kernels.hpp"
#include "fase/core/detail/prefetch.hpp"

HWY_BEFORE_NAMESPACE();
namespace fase::broad::wide::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
// No fused operations, so that the order of visits is the same on every processor.
#include "fase/broad/wide_bvh/lanes-inl.hpp"
//
#include "fase/broad/wide_bvh/cull-inl.hpp"
#include "fase/broad/wide_bvh/nearest-inl.hpp"
#include "fase/broad/wide_bvh/overlap-inl.hpp"
}  // namespace fase::broad::wide::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fase::broad::wide {

HWY_EXPORT(nearest_to_ray);
HWY_EXPORT(nearest_to_point);
HWY_EXPORT(visit_overlapping);
HWY_EXPORT(cull_frustum);
HWY_EXPORT(descend);
HWY_EXPORT(expand_node_pair);
HWY_EXPORT(refit_nodes);

namespace {

template <class V> double size_of(const V& v) {
    return std::abs(double(v.x)) + std::abs(double(v.y)) + std::abs(double(v.z));
}

}  // namespace

bool fits_float(const RayMeasure& measure) {
    const Ray& ray = measure.ray();
    const double size =
        size_of(ray.origin) + size_of(measure.before()) + size_of(measure.after()) + size_of(ray.direction);
    return size <= 1e18 && ray.length >= 0;  // false for NaN
}

bool fits_float(const PointMeasure& measure) { return size_of(measure.point()) <= 1e18 && measure.radius() >= 0; }

void nearest_first(const Forest& forest, const RayMeasure& measure, float limit, VisitNear visit) {
    HWY_DYNAMIC_DISPATCH(nearest_to_ray)(forest, measure, limit, visit);
}
void nearest_first(const Forest& forest, const PointMeasure& measure, float limit, VisitNear visit) {
    HWY_DYNAMIC_DISPATCH(nearest_to_point)(forest, measure, limit, visit);
}
bool traverse(const Forest& forest, const Aabb& box, VisitOverlap visit) {
    return HWY_DYNAMIC_DISPATCH(visit_overlapping)(forest, box, visit);
}
void cull(const Forest& forest, const FrustumRegion& region, TakeRange take) {
    HWY_DYNAMIC_DISPATCH(cull_frustum)(forest, region, take);
}
void find_pairs(const Forest& one, const Forest& two, NodePair start, bool awake_only, PairSink& sink) {
    HWY_DYNAMIC_DISPATCH(descend)(one, two, start, awake_only, sink);
}
void expand_pair(const Forest& one, const Forest& two, NodePair start, PairSink& sink, std::vector<NodePair>& left) {
    HWY_DYNAMIC_DISPATCH(expand_node_pair)(one, two, start, sink, left);
}
double refit(Forest& forest, std::uint32_t begin) { return HWY_DYNAMIC_DISPATCH(refit_nodes)(forest, begin); }

}  // namespace fase::broad::wide
#endif
