/// Compiles the loops of the row grid for every SIMD target and selects one at run time.
#include "fase/core/detail/simd_targets.hpp"
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "fase/broad/row_grid/kernels.cpp"
#include <hwy/foreach_target.h>
//
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <type_traits>

#include "fase/broad/boxes/box_store.hpp"
#include "fase/broad/row_grid/compress.hpp"
#include "fase/broad/row_grid/kernels.hpp"
#include "fase/broad/row_grid/walk.hpp"
#include "fase/math/detail/wide-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fase::broad::row_grid::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;
using fase::HWY_NAMESPACE::Wide;
#include "fase/broad/row_grid/test-inl.hpp"
//
#include "fase/broad/row_grid/sort-inl.hpp"
//
#include "fase/broad/row_grid/query-inl.hpp"
//
#include "fase/broad/row_grid/pairs-inl.hpp"
}  // namespace fase::broad::row_grid::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fase::broad::row_grid {

HWY_EXPORT(count_moves_wide);
HWY_EXPORT(count_list_wide);
HWY_EXPORT(moves_keys_wide);
HWY_EXPORT(list_keys_wide);
HWY_EXPORT(keys_below_wide);
HWY_EXPORT(select_keys_wide);
HWY_EXPORT(gather_moves_wide);
HWY_EXPORT(gather_list_wide);
HWY_EXPORT(find_own_pairs_wide);
HWY_EXPORT(find_query_pairs_wide);

CountResult count_cells(std::span<const Move> boxes, const RowFit& fit, float* keys, std::uint32_t* table) {
    return HWY_DYNAMIC_DISPATCH(count_moves_wide)(boxes, fit, keys, table);
}
CountResult count_cells(std::span<const Aabb> boxes, const RowFit& fit, float* keys, std::uint32_t* table) {
    return HWY_DYNAMIC_DISPATCH(count_list_wide)(boxes, fit, keys, table);
}
CountResult find_keys(std::span<const Move> boxes, const RowFit& fit, float* keys) {
    return HWY_DYNAMIC_DISPATCH(moves_keys_wide)(boxes, fit, keys);
}
CountResult find_keys(std::span<const Aabb> boxes, const RowFit& fit, float* keys) {
    return HWY_DYNAMIC_DISPATCH(list_keys_wide)(boxes, fit, keys);
}
std::size_t keys_below(std::span<const float> keys, std::uint32_t counter) {
    return HWY_DYNAMIC_DISPATCH(keys_below_wide)(keys, counter);
}
void select_keys(std::span<const float> keys, std::uint32_t first, std::uint32_t last, std::size_t count, float* places,
                 float* selected) {
    HWY_DYNAMIC_DISPATCH(select_keys_wide)(keys, first, last, count, places, selected);
}
std::array<float, 3> gather_boxes(std::span<const Move> boxes, std::size_t begin, std::size_t end,
                                  const std::array<float*, 6>& columns, Proxy* order) {
    return HWY_DYNAMIC_DISPATCH(gather_moves_wide)(boxes, begin, end, columns, order);
}
std::array<float, 3> gather_boxes(std::span<const Aabb> boxes, std::size_t begin, std::size_t end,
                                  const std::array<float*, 6>& columns, Proxy* order) {
    return HWY_DYNAMIC_DISPATCH(gather_list_wide)(boxes, begin, end, columns, order);
}
void find_own_pairs(const RowView& set, std::size_t begin, std::size_t end, PairBlock& out) {
    HWY_DYNAMIC_DISPATCH(find_own_pairs_wide)(set, begin, end, out);
}
void find_query_pairs(const RowView& set, const QueryBoxes& query_boxes, PairBlock& out) {
    HWY_DYNAMIC_DISPATCH(find_query_pairs_wide)(set, query_boxes, out);
}

}  // namespace fase::broad::row_grid
#endif
