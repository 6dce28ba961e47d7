/// Chooses the cell size and distributes the boxes to the cells.
#include "fase/broad/uniform_grid.hpp"

#include <algorithm>

namespace fase::broad {
namespace {

/// Returns the longest side in double; at least 0.
double longest_side_in_double(const Aabb& box) {
    double longest = 0;
    for (int axis = 0; axis < 3; ++axis) longest = std::max(longest, double(box.hi[axis]) - box.lo[axis]);
    return longest;
}

}  // namespace

/// Fits the cell size to a sample of at most 512 boxes, so that a few huge or distant boxes have no effect: cells are
/// somewhat larger than most boxes, and still larger where boxes are so sparse that most cells would hold less than
/// two.
GridFrame UniformGrid::fitting_frame() const {
    constexpr std::size_t max_sample = 512;
    const std::span<const Move> boxes = store_.regular();
    if (boxes.empty()) return {};
    const std::size_t count = std::min(max_sample, boxes.size());
    std::array<double, max_sample> sides;
    std::array<std::array<double, max_sample>, 3> centres;
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t begin = i * boxes.size() / count, end = (i + 1) * boxes.size() / count;
        const Aabb& box = boxes[begin + mix_bits(i) % (end - begin)].box;
        sides[i] = longest_side_in_double(box);
        for (int axis = 0; axis < 3; ++axis)
            centres[static_cast<std::size_t>(axis)][i] = 0.5 * (double(box.lo[axis]) + box.hi[axis]);
    }
    std::sort(sides.begin(), sides.begin() + static_cast<std::ptrdiff_t>(count));
    GridFrame frame;
    std::array<double, 3> spread;  // between the 10th and 90th percentile of the centres
    double widest = 0;
    for (std::size_t k = 0; k < 3; ++k) {
        std::sort(centres[k].begin(), centres[k].begin() + static_cast<std::ptrdiff_t>(count));
        spread[k] = centres[k][count - 1 - count / 10] - centres[k][count / 10];
        widest = std::max(widest, spread[k]);
        frame.origin[static_cast<int>(k)] = centres[k][count / 2];
    }
    double side = std::max(typical_sides * sides[3 * count / 4], widest * 0x1p-20);
    const auto cells = [&] {
        return std::max(1.0, spread[0] / side) * std::max(1.0, spread[1] / side) * std::max(1.0, spread[2] / side);
    };
    if (side > 0)
        while (cells() > std::max(1.0, 0.5 * static_cast<double>(boxes.size()))) side *= 1.125;
    if (settings_.cell > 0) side = settings_.cell;
    frame.side = side > 0 ? std::clamp(side, 1e-30, 1e18) : 1;
    frame.inverse = 1 / frame.side;
    return frame;
}

void UniformGrid::commit() {
    const bool changed = store_.take_changed(), awake_changed = store_.take_awake_changed();
    if (!changed && !awake_changed) return;
    GridFrame frame = fitting_frame();
    for (Level& level : levels_) {
        level = {.frame = frame,
                 .used = {{GridFrame::far, GridFrame::far, GridFrame::far},
                          {-GridFrame::far, -GridFrame::far, -GridFrame::far}}};
        frame.side *= ratio;
        frame.inverse = 1 / frame.side;
    }
    level_count_ = 1;
    table_.clear();
    large_.clear();
    added_.clear();
    cells_.clear();
    level_of_.resize(store_.regular().size());
    add_boxes(true);
    if (store_.resting() != 0) add_boxes(false);
    fill_cells();
}

void UniformGrid::add_boxes(bool awake) {
    const auto count = static_cast<std::uint32_t>(store_.regular().size());
    for (std::uint32_t row = 0; row < count; ++row) {
        if (store_.resting() != 0 && store_.is_awake(store_.regular()[row].proxy) != awake) continue;
        add_box(row);
    }
    if (!awake) return;
    for (ScanRange& cell : cells_) cell.queries_end = cell.end;  // still counts; fill_cells() makes them indices
}

void UniformGrid::add_box(std::uint32_t row) {
    const Move& m = store_.regular()[row];
    const double size = longest_side_in_double(m.box);
    std::size_t l = 0;
    while (l < max_levels && size > levels_[l].frame.side) ++l;
    level_of_[row] = static_cast<std::uint8_t>(l);
    if (l == max_levels) {
        large_.push_back(m);
        return;
    }
    level_count_ = std::max(level_count_, l + 1);
    Level& level = levels_[l];
    ++level.boxes;
    const CellRange range = level.frame.range(m.box);
    for (std::size_t k = 0; k < 3; ++k) {
        level.used.lo[k] = std::min(level.used.lo[k], range.lo[k]);
        level.used.hi[k] = std::max(level.used.hi[k], range.hi[k]);
    }
    for_each_cell(range, [&](const CellCoord& at) {
        const std::uint32_t number = table_.find_or_add({at, static_cast<std::int32_t>(l)});
        if (number == cells_.size()) {
            cells_.push_back({});
            ++level.cells;
        }
        ++cells_[number].end;  // still a count
        added_.push_back({number, row, all_marks & ~later_axes(range, at)});
        return true;
    });
}

void UniformGrid::fill_cells() {
    std::uint32_t sum = 0;
    for (ScanRange& cell : cells_) {
        cell.first = sum;
        cell.queries_end += sum;
        sum += std::exchange(cell.end, sum);
    }
    sorted_.resize(added_.size());
    for (const Entry& entry : added_) sorted_[cells_[entry.cell].end++] = {entry.row, entry.marks};
    entries_.resize(added_.size());
    marks_.resize(added_.size() + BoxColumns::padding);
    home_bounds_.assign(cells_.size(), Aabb{});
    for (std::size_t i = 0; i < cells_.size(); ++i) {
        Aabb home;
        for (std::uint32_t at = cells_[i].first; at < cells_[i].end; ++at) {
            const Move& m = store_.regular()[sorted_[at].row];
            entries_.put(at, m.proxy, m.box);
            marks_[at] = sorted_[at].marks;
            if (marks_[at] == all_marks) home = merge(home, m.box);
        }
        home_bounds_[i] = home;
    }
}

std::size_t UniformGrid::bytes() const {
    return sizeof(*this) + store_.bytes() + table_.bytes() + cells_.capacity() * sizeof(ScanRange) +
           home_bounds_.capacity() * sizeof(Aabb) + entries_.bytes() + marks_.capacity() * sizeof(std::uint32_t) +
           level_of_.capacity() + large_.capacity() * sizeof(Move) + added_.capacity() * sizeof(Entry) +
           sorted_.capacity() * sizeof(CellEntry);
}

void UniformGrid::cells(std::vector<DrawnCell>& out) const {
    for (std::uint32_t i = 0; i < table_.size(); ++i) out.push_back({cell_box(i), depth(i)});
}

}  // namespace fase::broad
