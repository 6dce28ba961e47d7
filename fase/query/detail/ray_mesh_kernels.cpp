/// Compiles the ray-mesh search for every SIMD target and selects one at run time.
#include "fase/core/detail/simd_targets.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fase/query/detail/ray_mesh_kernels.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/highway.h>

#include <bit>
#include <limits>

#include "fase/query/detail/ray_mesh_kernels.hpp"

HWY_BEFORE_NAMESPACE();
namespace fase::query::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
#include "fase/query/detail/ray_mesh-inl.hpp"
}  // namespace fase::query::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fase::query {

HWY_EXPORT(cast_at);

Hit cast_at_blocks(const RayMeshView& mesh, const Ray& ray, bool any) {
    return HWY_DYNAMIC_DISPATCH(cast_at)(mesh, ray, any);
}

}  // namespace fase::query
#endif
