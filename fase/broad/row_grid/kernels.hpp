#pragma once
/// The loops of a row grid that are compiled for every SIMD target.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/broad/row_grid/set.hpp"

namespace fase::broad::row_grid {

/// Where loops write pairs before they are appended to the caller's vector: small enough to stay in the fastest cache.
/// What is left is appended when it dies.
class PairBlock {
public:
    static constexpr std::size_t most = 1024;  ///< that can be written from one flush() to the next

    explicit PairBlock(std::vector<Pair>& out) : at(begin()), out_(out) {}
    PairBlock(const PairBlock&) = delete;
    PairBlock& operator=(const PairBlock&) = delete;
    ~PairBlock() { flush(at); }

    Pair* at;  ///< where the next pair goes
    [[nodiscard]] Pair* end() { return begin() + most; }
    /// Appends all pairs before `written` and returns where the next goes then.
    [[gnu::noinline]] Pair* flush(const Pair* written) {
        out_.insert(out_.end(), static_cast<const Pair*>(begin()), written);
        return at = begin();
    }

private:
    std::vector<Pair>& out_;
    alignas(64) unsigned char memory_[most * sizeof(Pair)];  // left as it is: setting it would cost

    [[nodiscard]] Pair* begin() { return reinterpret_cast<Pair*>(memory_); }
};

/// Who asks and which proxies are left out: the asker's own, and smaller ones that `is_query` marks.
struct QueryBoxes {
    std::span<const Move> boxes;
    std::span<const std::uint8_t> is_query;
};

/// So many boxes, with all that is known of them, do not fit into the caches near a core: what is wanted soon is asked
/// for ahead.
inline constexpr std::size_t past_caches = std::size_t{1} << 17;

struct Counted {
    std::size_t outside = 0;  ///< about so many boxes lie outside of their level's cells by more than the size of one
    bool unbounded = false;   ///< one of them is not ordinary

    Counted& operator+=(const Counted& more) {
        outside += more.outside;
        unbounded |= more.unbounded;
        return *this;
    }
};
/// Writes to keys[i] (as bits of a float) which counter of `table` box i belongs to, and counts it there.
Counted count_cells(std::span<const Move> boxes, const RowFit& fit, float* keys, std::uint32_t* table);
Counted count_cells(std::span<const Aabb> boxes, const RowFit& fit, float* keys, std::uint32_t* table);

/// The first half of that: for boxes that several threads share out.
Counted find_keys(std::span<const Move> boxes, const RowFit& fit, float* keys);
Counted find_keys(std::span<const Aabb> boxes, const RowFit& fit, float* keys);
/// How many of the keys are smaller than a counter.
std::size_t keys_below(std::span<const float> keys, std::uint32_t counter);
/// Writes the keys from `first` to before `last`, and where they stand, in order: `count` of them, no more and no less.
void select_keys(std::span<const float> keys, std::uint32_t first, std::uint32_t last, std::size_t count, float* places,
                 float* selected);

/// Puts box order[i] into place i of the columns, for `begin` <= i < `end`, and its proxy over order[i]. Returns the
/// longest sides of these boxes. The proxies of a list of boxes are their places in it.
std::array<float, 3> gather_boxes(std::span<const Move> boxes, std::size_t begin, std::size_t end,
                                  const std::array<float*, 6>& columns, Proxy* order);
std::array<float, 3> gather_boxes(std::span<const Aabb> boxes, std::size_t begin, std::size_t end,
                                  const std::array<float*, 6>& columns, Proxy* order);

/// The pairs of the records from `begin` to `end` with later ones of their level and with all of lower levels.
void find_own_pairs(const RowView& set, std::size_t begin, std::size_t end, PairBlock& out);

/// The pairs of askers with records of the set.
void find_query_pairs(const RowView& set, const QueryBoxes& query_boxes, PairBlock& out);

}  // namespace fase::broad::row_grid
