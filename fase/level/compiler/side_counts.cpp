/// Compiles the loop for every SIMD target and selects one at run time.
// Vectors of unknown size cannot be members; such targets use 128 bits.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
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
