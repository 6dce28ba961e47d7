/// Stores the parts of a set after it; a later split of an earlier set overwrites them.
#include "fase/level/compiler/piece_columns.hpp"

#include <algorithm>

namespace fase::level {

void PieceColumns::ensure_length(std::size_t length) {
    if (ax.size() >= length) return;
    const std::size_t size = length + length / 2;
    for (std::vector<float>* column : {&ax, &ay, &bx, &by, &weight}) column->resize(size);
    plane.resize(size);
    right.resize(size);
    left.resize(size);
}

void PieceColumns::add_padding(PieceSet set) {
    for (std::size_t i = 0; i < PieceView::padding; ++i) weight[set.end() + i] = 0;
}

PieceView PieceColumns::view(PieceSet set) const {
    const std::size_t at = set.first;
    return {ax.data() + at, ay.data() + at, bx.data() + at, by.data() + at, weight.data() + at, set.count};
}

void PieceColumns::add(PieceSet& set, std::size_t source, float from_x, float from_y, float to_x, float to_y) {
    const std::size_t at = set.first + set.count++;
    ax[at] = from_x;
    ay[at] = from_y;
    bx[at] = to_x;
    by[at] = to_y;
    weight[at] = weight[source];
    plane[at] = plane[source];
    right[at] = right[source];
    left[at] = left[source];
}

void PieceColumns::split(PieceSet set, std::uint32_t plane_index, const FloatLine& line, PieceSet& on_right,
                         PieceSet& on_left) {
    const std::size_t stride = set.count + PieceView::padding;
    on_right = {set.first + stride, 0};
    on_left = {set.first + 2 * stride, 0};
    ensure_length(set.first + 3 * stride);
    for (std::size_t i = set.first; i < set.end(); ++i) {
        const float from_x = ax[i], from_y = ay[i], to_x = bx[i], to_y = by[i];
        const auto add_to = [&](PieceSet& side) { add(side, i, from_x, from_y, to_x, to_y); };
        if (plane[i] == plane_index) {
            for (PieceSet* side : {&on_right, &on_left}) {
                const bool is_right = side == &on_right;
                if ((is_right ? right[i] : left[i]) == 0) continue;
                add_to(*side);
                (is_right ? left : right)[side->end() - 1] = 0;
                weight[side->end() - 1] = 1;
            }
            continue;
        }
        const float from = line.nx * from_y - line.ny * from_x - line.offset;
        const float to = line.nx * to_y - line.ny * to_x - line.offset;
        if (std::max(from, to) <= near_line) {
            add_to(on_right);
        } else if (std::min(from, to) >= -near_line) {
            add_to(on_left);
        } else {
            const float t = from / (from - to), x = from_x + t * (to_x - from_x), y = from_y + t * (to_y - from_y);
            add(from < 0 ? on_right : on_left, i, from_x, from_y, x, y);
            add(from < 0 ? on_left : on_right, i, x, y, to_x, to_y);
        }
    }
    add_padding(on_right);
    add_padding(on_left);
}

}  // namespace fase::level
