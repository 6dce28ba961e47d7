/// Query boxes against blocks: tests a batch of query boxes against the bounds of all sets, then tests each set against
/// those that touch it.
#include <algorithm>
#include <limits>

#include "fase/broad/row_grid/blocks.hpp"

namespace fase::broad {
namespace {

constexpr std::size_t max_queries = 128;

/// Query boxes as columns.
struct QueryColumns {
    std::array<std::array<float, max_queries + BoxColumns::padding>, 6> bounds;
    std::array<Proxy, 1> no_proxies{};

    void fill(std::span<const Move> query_boxes) {
        for (std::size_t i = 0; i < query_boxes.size(); ++i) {
            const Aabb& box = query_boxes[i].box;
            bounds[0][i] = box.lo.x;
            bounds[1][i] = box.lo.y;
            bounds[2][i] = box.lo.z;
            bounds[3][i] = box.hi.x;
            bounds[4][i] = box.hi.y;
            bounds[5][i] = box.hi.z;
        }
        for (std::array<float, max_queries + BoxColumns::padding>& bound : bounds)
            for (std::size_t i = query_boxes.size(); i < query_boxes.size() + BoxColumns::padding; ++i) bound[i] = 0;
    }
    [[nodiscard]] ColumnsView view(std::size_t count) const {
        return {{bounds[0].data(), bounds[1].data(), bounds[2].data()},
                {bounds[3].data(), bounds[4].data(), bounds[5].data()},
                no_proxies.data(),
                count};
    }
};

}  // namespace

void RowBlocks::find_query_pairs(const row_grid::QueryBoxes& query_boxes, std::uint32_t after,
                                 row_grid::PairBlock& out) const {
    if (size_ == 0) return;
    QueryColumns columns;
    std::array<std::uint32_t, max_queries + BoxColumns::padding> touching;
    std::array<Move, max_queries> chosen;
    for (std::size_t begin = 0; begin < query_boxes.boxes.size(); begin += max_queries) {
        const std::span<const Move> batch =
            query_boxes.boxes.subspan(begin, std::min(max_queries, query_boxes.boxes.size() - begin));
        Aabb around;
        for (const Move& m : batch) around = merge(m.box, around);  // ignores a NaN in m.box
        bool filled = false;
        for_each_set_touching(around, [&](std::uint32_t k) {
            const RowSet& boxes = set(k);
            if (after != no_index) {
                const std::size_t size = set(after).size();
                if (boxes.size() < size || (boxes.size() == size && k <= after)) return true;
            }
            const Aabb bounds = bounds_.box(k);
            if (batch.size() == 1 || contains(bounds, around)) {
                row_grid::find_query_pairs(boxes.view(), {batch, query_boxes.is_query}, out);
                return true;
            }
            if (!filled) columns.fill(batch);
            filled = true;
            const std::size_t count =
                scan_touching(columns.view(batch.size()), 0, batch.size(), bounds, touching.data());
            for (std::size_t i = 0; i < count; ++i) chosen[i] = batch[touching[i]];
            if (count > 0)
                row_grid::find_query_pairs(boxes.view(), {{chosen.data(), count}, query_boxes.is_query}, out);
            return true;
        });
    }
}

}  // namespace fase::broad
