/// Compiles the passes for every SIMD target and selects one at run time.
#include "fase/core/detail/simd_targets.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fase/dynamics/solver/contact_passes.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/highway.h>

#include <type_traits>

#include "fase/dynamics/solver/contact_passes.hpp"
#include "fase/math/detail/lane.hpp"
#include "fase/math/detail/wide-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fase::dynamics::HWY_NAMESPACE {
using fase::HWY_NAMESPACE::Wide;
#ifdef FASE_HAS_WIDE_PAIR
/// The blocks of a colour are independent, so two of them can be solved together.
template <class V> using PairOf = fase::HWY_NAMESPACE::WidePair<sizeof(ContactBlock) / sizeof(float)>;
#else
template <class V> using PairOf = void;
#endif
#include "fase/dynamics/solver/contact_passes-inl.hpp"

void run_wide(Pass pass, ContactBlock* blocks, std::size_t count, Sides sides, const PassInput& input) {
    run_blocks<Wide>(pass, blocks, count, sides, input);
}
}  // namespace fase::dynamics::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fase::dynamics {
namespace reference {
template <class V> using PairOf = void;
#include "fase/dynamics/solver/contact_passes-inl.hpp"
}  // namespace reference

HWY_EXPORT(run_wide);
void run_pass(Pass pass, ContactBlock* blocks, std::size_t count, Sides sides, const PassInput& input) {
    HWY_DYNAMIC_DISPATCH(run_wide)(pass, blocks, count, sides, input);
}
void run_pass_reference(Pass pass, ContactBlock* blocks, std::size_t count, Sides sides, const PassInput& input) {
    reference::run_blocks<Lane>(pass, blocks, count, sides, input);
}
}  // namespace fase::dynamics
#endif
