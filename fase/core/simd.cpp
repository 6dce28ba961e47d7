/// Selects Highway's targets by common names.
#include "fase/core/simd.hpp"

#include <hwy/targets.h>

#include <array>

namespace fase {
namespace {

struct Level {
    std::string_view name;
    std::int64_t target;  // Highway's bit: wider targets have lower bits
};
constexpr std::array levels{Level{"avx512", HWY_AVX3}, Level{"avx2", HWY_AVX2}, Level{"sse4", HWY_SSE4}};

std::int64_t disabled = 0;  // as passed to Highway

void disable(std::int64_t targets) {
    disabled = targets;
    hwy::DisableTargets(targets);
}

}  // namespace

std::string_view simd_level() {
    const std::int64_t targets = hwy::SupportedTargets();
    const std::int64_t best = targets & -targets;
    if (best < HWY_AVX2) return "avx512";
    for (const Level& level : levels)
        if (best == level.target) return level.name;
    if (best == HWY_SCALAR || best == HWY_EMU128) return "scalar";
    return hwy::TargetName(best);
}

std::string simd_levels() {
    std::string names = "best";
    for (const Level& level : levels) names += ", " + std::string(level.name);
    return names;
}

Result<void> limit_simd(std::string_view name) {
    if (name == "best") {
        disable(0);
        return {};
    }
    for (const Level& level : levels) {
        if (level.name != name) continue;
        const std::int64_t before = disabled;
        disable(0);
        if ((hwy::SupportedTargets() & level.target) == 0) {
            const std::string best(simd_level());
            disable(before);
            return Error{Status::Unsupported, "SIMD level",
                         "found \"" + std::string(name) + "\", which this processor does not have",
                         "its widest level is " + best};
        }
        disable(level.target - 1);  // all wider targets
        return {};
    }
    return Error{Status::BadArgument, "SIMD level",
                 "found \"" + std::string(name) + "\"; expected one of " + simd_levels(), ""};
}

}  // namespace fase
