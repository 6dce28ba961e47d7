#pragma once
/// The loops of the row grid that are compiled for every SIMD target.
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "fase/broad/row_grid/set.hpp"
#include "fase/broad/search/pair_sink.hpp"

namespace fase::broad::row_grid {

/// A buffer for the pairs of a loop, small enough to stay in the L1 cache. flush() and the destructor append the pairs
/// to the caller's vector.
class PairBlock {
public:
    static constexpr std::size_t capacity = 1024;  ///< in pairs

    explicit PairBlock(std::vector<Pair>& out) : at(begin()), out_(out) { reserve_room(out_, capacity); }
    PairBlock(const PairBlock&) = delete;
    PairBlock& operator=(const PairBlock&) = delete;
    ~PairBlock() { append(at); }

    Pair* at;  ///< where the next pair goes
    [[nodiscard]] Pair* end() { return begin() + capacity; }
    /// Appends all pairs before `written` and returns the position of the next pair.
    [[gnu::noinline]] Pair* flush(const Pair* written) {
        append(written);
        reserve_room(out_, capacity);
        return at;
    }

private:
    /// Allocates nothing: there is room for one block.
    void append(const Pair* written) noexcept {
        out_.insert(out_.end(), static_cast<const Pair*>(begin()), written);
        at = begin();
    }

    std::vector<Pair>& out_;
    alignas(64) unsigned char memory_[capacity * sizeof(Pair)];  // uninitialized, to save time

    [[nodiscard]] Pair* begin() { return reinterpret_cast<Pair*>(memory_); }
};

/// Query boxes. A query box is not paired with its own proxy, nor with a smaller proxy marked in `is_query`.
struct QueryBoxes {
    std::span<const Move> boxes;
    std::span<const std::uint8_t> is_query;
};

/// A set of so many boxes does not fit into the caches of a core: its loops prefetch.
inline constexpr std::size_t out_of_cache_boxes = std::size_t{1} << 17;

/// The result of counting boxes by cell.
struct CountResult {
    std::size_t outside = 0;  ///< estimated number of boxes more than one cell outside the cells of their level
    bool unbounded = false;   ///< some box is not regular

    CountResult& operator+=(const CountResult& more) {
        outside += more.outside;
        unbounded |= more.unbounded;
        return *this;
    }
};
/// Writes the table index of the counter of box i to keys[i], as the bits of a float, and increments that counter.
CountResult count_cells(std::span<const Move> boxes, const RowFit& fit, float* keys, std::uint32_t* table);
CountResult count_cells(std::span<const Aabb> boxes, const RowFit& fit, float* keys, std::uint32_t* table);

/// Only writes the keys, for boxes that several threads process.
CountResult find_keys(std::span<const Move> boxes, const RowFit& fit, float* keys);
CountResult find_keys(std::span<const Aabb> boxes, const RowFit& fit, float* keys);
/// Returns the number of keys below `counter`.
std::size_t keys_below(std::span<const float> keys, std::uint32_t counter);
/// Writes the keys in [first, last) to `selected` and their indices to `places`, in order. There must be exactly
/// `count` of them.
void select_keys(std::span<const float> keys, std::uint32_t first, std::uint32_t last, std::size_t count, float* places,
                 float* selected);

/// Gathers box order[i] into entry i of the columns, for `begin` <= i < `end`, and overwrites order[i] with its proxy.
/// Returns an upper bound of the sides of these boxes by axis. The proxies of a list of boxes are its indices.
std::array<float, 3> gather_boxes(std::span<const Move> boxes, std::size_t begin, std::size_t end,
                                  const std::array<float*, 6>& columns, Proxy* order);
std::array<float, 3> gather_boxes(std::span<const Aabb> boxes, std::size_t begin, std::size_t end,
                                  const std::array<float*, 6>& columns, Proxy* order);

/// Appends the pairs of the records from `begin` to `end` with later ones of their level and with all finer levels.
void find_own_pairs(const RowView& set, std::size_t begin, std::size_t end, PairBlock& out);

/// Appends the pairs of the query boxes with the records of the set.
void find_query_pairs(const RowView& set, const QueryBoxes& query_boxes, PairBlock& out);

}  // namespace fase::broad::row_grid
