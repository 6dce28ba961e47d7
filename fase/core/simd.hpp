#pragma once
/// Which vector instructions are used, of those that the processor has.
#include <string>
#include <string_view>

#include "fase/core/result.hpp"

namespace fase {

/// "avx512", "avx2", "sse4", "scalar", or what another processor's is called: the widest that is used from now on.
/// Results never depend on it; speed does.
[[nodiscard]] std::string_view simd_level();

/// Uses no wider instructions than those of a level, one of simd_levels(), in the whole program: to measure what they
/// are worth, or to find out whether a fault hangs on them. "best": all there are. BadArgument with the known levels;
/// Unsupported for what this processor has not. Not while another thread works.
Result<void> limit_simd(std::string_view level);

/// "best, avx512, avx2, sse4", of which the processor may lack some.
[[nodiscard]] std::string simd_levels();

}  // namespace fase
