#pragma once
/// The instruction sets for which SIMD kernels are not compiled. Include it before <hwy/foreach_target.h>.

// Vectors of unknown size cannot be members; such targets fall back to 128 bits.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV | HWY_SSSE3)
