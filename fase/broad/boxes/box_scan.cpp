/// Compiles the loops for every SIMD target and selects one at run time.
#include "fase/core/detail/simd_targets.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fase/broad/boxes/box_scan.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/highway.h>

#include <array>

#include "fase/broad/boxes/box_scan.hpp"

#ifndef FASE_BROAD_BOX_SCAN_ONCE
#define FASE_BROAD_BOX_SCAN_ONCE
namespace fase::broad {
namespace {

void append_pairs(std::vector<Pair>& out, const Pair* pairs, std::size_t count) {
    out.insert(out.end(), pairs, pairs + count);
}

/// Returns the first index from `from` on of a box that begins at or after `lo`; with Ties::Theirs, after `lo`. A
/// galloping search, fast for near indices.
std::size_t first_beginning(const ColumnsView& boxes, std::size_t from, float lo, Ties ties) {
    const float* const begins = boxes.lo[0];
    const auto is_before = [&](std::size_t at) { return ties == Ties::Mine ? begins[at] < lo : begins[at] <= lo; };
    std::size_t step = 1;
    while (from + step <= boxes.count && is_before(from + step - 1)) {
        from += step;
        step *= 2;
    }
    std::size_t end = from + step - 1 < boxes.count ? from + step - 1 : boxes.count;
    while (from < end) {
        const std::size_t middle = from + (end - from) / 2;
        if (is_before(middle)) {
            from = middle + 1;
        } else {
            end = middle;
        }
    }
    return from;
}

}  // namespace
}  // namespace fase::broad
#endif

HWY_BEFORE_NAMESPACE();
namespace fase::broad::HWY_NAMESPACE {
#include "fase/broad/boxes/box_scan-inl.hpp"
}  // namespace fase::broad::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fase::broad {

HWY_EXPORT(scan_behind_wide);
HWY_EXPORT(sweep_behind_wide);
HWY_EXPORT(sweep_across_wide);
HWY_EXPORT(scan_ranges_wide);
HWY_EXPORT(scan_touching_wide);
HWY_EXPORT(bounds_of_wide);

void scan_behind(const ColumnsView& boxes, std::size_t begin, std::size_t end, std::vector<Pair>& out) {
    HWY_DYNAMIC_DISPATCH(scan_behind_wide)(boxes, begin, end, out);
}
void sweep_behind(const ColumnsView& boxes, std::size_t begin, std::size_t end, std::vector<Pair>& out) {
    HWY_DYNAMIC_DISPATCH(sweep_behind_wide)(boxes, begin, end, out);
}
void sweep_across(const ColumnsView& mine, std::size_t begin, std::size_t end, const ColumnsView& theirs, Ties ties,
                  std::vector<Pair>& out) {
    HWY_DYNAMIC_DISPATCH(sweep_across_wide)(mine, begin, end, theirs, ties, out);
}
void scan_ranges(const ColumnsView& boxes, const std::uint32_t* marks, std::span<const ScanRange> ranges,
                 std::vector<Pair>& out) {
    HWY_DYNAMIC_DISPATCH(scan_ranges_wide)(boxes, marks, ranges, out);
}
std::size_t scan_touching(const ColumnsView& boxes, std::size_t begin, std::size_t end, const Aabb& box,
                          std::uint32_t* hits) {
    return HWY_DYNAMIC_DISPATCH(scan_touching_wide)(boxes, begin, end, box, hits);
}
Aabb bounds_of(const ColumnsView& boxes) { return HWY_DYNAMIC_DISPATCH(bounds_of_wide)(boxes); }

}  // namespace fase::broad
#endif
