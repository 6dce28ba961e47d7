/// Compiles the loop for every SIMD target and selects one at run time.
#include "fase/core/detail/simd_targets.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fase/level/compiler/side_counts.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/highway.h>

#include "fase/level/compiler/side_counts.hpp"

HWY_BEFORE_NAMESPACE();
namespace fase::level::HWY_NAMESPACE {
#include "fase/level/compiler/side_counts-inl.hpp"
}  // namespace fase::level::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fase::level {

HWY_EXPORT(count_sides_wide);

void count_sides(const PieceView& pieces, std::span<const FloatLine> lines, SideCounts* counts) {
    HWY_DYNAMIC_DISPATCH(count_sides_wide)(pieces, lines, counts);
}

}  // namespace fase::level
#endif
