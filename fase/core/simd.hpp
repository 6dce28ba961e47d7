#pragma once
/// Selects the vector instruction set at run time.
#include <string>
#include <string_view>

#include "fase/core/result.hpp"

namespace fase {

/// Returns the widest instruction set in use: "avx512", "avx2", "sse4", "scalar", or Highway's name on another
/// processor. Only speed depends on it, results never do.
[[nodiscard]] std::string_view simd_level();

/// Limits the program to the instructions of a level, one of simd_levels(): to measure their gain, or to check whether
/// a fault depends on them. "best" removes the limit. BadArgument names the known levels; Unsupported for a level that
/// the processor lacks. Do not call it while another thread runs library code.
Result<void> limit_simd(std::string_view level);

/// Returns the known levels: "best, avx512, avx2, sse4"; the processor may lack some of them.
[[nodiscard]] std::string simd_levels();

}  // namespace fase
