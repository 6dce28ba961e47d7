/// How worn blocks are sorted anew, joined, and dissolved into smaller ones.
#include <algorithm>

#include "fase/broad/row_grid/blocks.hpp"

namespace fase::broad {
namespace {

constexpr std::size_t cut_to = RowBlocks::block_max / 4 * 3;  // leaves room to grow
constexpr std::size_t sample_a_piece = 64;

/// The boxes whose middles lie in a cell, as walks through rows understand it: they may see more.
struct CellRegion {
    Aabb space;  // twice the cell's

    [[nodiscard]] bool touches(const Aabb& box) const { return overlaps(space, {box.lo + box.lo, box.hi + box.hi}); }
    [[nodiscard]] Aabb bounds() const { return {space.lo * 0.5f, space.hi * 0.5f}; }
};

/// Middles of boxes all over the set; and their longest sides, in order.
void take_sample(const RowView& set, std::size_t count, std::vector<Vec3>& middles, std::vector<float>& sides) {
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = i * set.count / count;
        if (set.proxies[at] == killed) continue;
        const Aabb box = set.box(at);
        const Vec3 e = extent(box);
        middles.push_back(BlockPlanes::middle(box));
        sides.push_back(std::max(e.x, std::max(e.y, e.z)));
    }
    std::sort(sides.begin(), sides.end());
}

}  // namespace

std::size_t RowBlocks::mend(const RowGridSettings& settings) {
    if (!dissolving_.empty()) return dissolve(settings);
    const std::uint32_t b = worn_.front();
    worn_.erase(worn_.begin());
    if (!blocks_[b].waits) return 0;  // sorted anew since then
    blocks_[b].waits = false;
    return mend(b, settings);
}

std::size_t RowBlocks::mend(std::uint32_t b, const RowGridSettings& settings) {
    const std::size_t live = blocks_[b].live();
    if (live == 0) {
        if (!blocks_[b].is_heir) drop_block(b);
        return 0;
    }
    if (live > block_max && begin_to_dissolve(b, settings)) return dissolve(settings);
    const std::uint32_t other = planes_[blocks_[b].planes].sibling(b);
    const bool joins =
        live < block_max / 8 && !blocks_[b].is_heir && other != none && live + blocks_[other].live() <= cut_to;
    if (!joins) {
        remake(b, {}, settings);
        return live;
    }
    grouped_.clear();
    append_boxes(b, grouped_);
    drop_block(b);
    remake(other, grouped_, settings);
    return blocks_[other].live();
}

/// Gives the block's space to new ones, which have its boxes coming. False when no plane tells its boxes apart.
bool RowBlocks::begin_to_dissolve(std::uint32_t b, const RowGridSettings& settings) {
    const std::uint8_t kind = blocks_[b].planes;
    const std::size_t pieces = (blocks_[b].live() + cut_to - 1) / cut_to;
    std::vector<Vec3> middles;
    std::vector<float> sides;
    take_sample(blocks_[b].main.view(), std::min(blocks_[b].main.size(), sample_a_piece * (pieces + 8)), middles,
                sides);
    if (sides.empty()) return false;
    const float was_large = large_;
    if (large_ == Aabb::infinity) large_ = 4 * sides[(sides.size() - 1) * 49 / 50];
    Dissolving one{b, {new_block(kind)}};
    planes_[kind].replace(b, one.heirs[0]);
    cut_cell(one.heirs[0], middles, pieces, one.heirs);
    if (one.heirs.size() == 1) {
        planes_[kind].replace(one.heirs[0], b);
        blocks_[one.heirs[0]] = {};
        free_.push_back(one.heirs[0]);
        large_ = was_large;
        return false;
    }
    for (const std::uint32_t heir : one.heirs) blocks_[heir].is_heir = true;
    std::reverse(one.heirs.begin(), one.heirs.end());
    blocks_[b].planes = dissolves;
    dissolving_.push_back(std::move(one));

    if (was_large != large_) {  // large boxes are told from the others for the first time
        std::vector<Move> large;
        for (const RowSet* set : {&blocks_[b].main, &blocks_[b].late}) {
            const RowView view = set->view();
            for (const RowLevel& level : view.levels) {
                if (level.limit <= large_) continue;
                for (std::size_t i = level.first; i < level.first + level.count; ++i)
                    if (view.proxies[i] != killed && longest_side(view.box(i)) > large_)
                        large.push_back({view.proxies[i], view.box(i)});
            }
        }
        for (const Move& m : large) set_at(spots_[m.proxy].set).kill(spots_[m.proxy].record);
        if (!large.empty()) take_in(large, settings);
    }
    return true;
}

/// Gives the next heir its boxes.
std::size_t RowBlocks::dissolve(const RowGridSettings& settings) {
    Dissolving& one = dissolving_.front();
    const std::uint32_t heir = one.heirs.back();
    one.heirs.pop_back();
    blocks_[heir].is_heir = false;
    const BlockPlanes& planes = planes_[blocks_[heir].planes];
    const CellRegion region{planes.space_of(heir)};
    grouped_.clear();
    for (const std::uint32_t k : {2 * one.block, 2 * one.block + 1}) {
        const std::size_t first = grouped_.size();
        row_grid::walk(set(k).view(), region, [&](Proxy p, const Aabb& box) {
            if (planes.cell_of(box) == heir) grouped_.push_back({p, box});
            return true;
        });
        for (std::size_t i = first; i < grouped_.size(); ++i) set_at(k).kill(spots_[grouped_[i].proxy].record);
    }
    const std::size_t count = grouped_.size();
    if (count > 0) {
        remake(heir, grouped_, settings);
    } else {
        look_at(heir);
    }
    if (one.heirs.empty()) {
        drop_block(one.block);
        return count;
    }
    for (const std::uint32_t k : {2 * one.block, 2 * one.block + 1}) {  // what is left lies in these cells
        if (set(k).size() == set(k).dead()) continue;
        Aabb left;
        for (const std::uint32_t other : one.heirs) left = merge(left, planes.space_of(other));
        bounds_.put(k, k, within(bounds_.box(k), left, set(k).view()));
    }
    return count;
}

/// Bounds of the boxes of a set whose middles lie in a space (given twice as large).
Aabb RowBlocks::within(const Aabb& bounds, const Aabb& space, const RowView& set) {
    Vec3 reach;
    for (const RowLevel& level : set.levels)
        if (level.count > 0) reach = max(reach, Vec3{level.reach[0], level.reach[1], level.reach[2]});
    const Vec3 around = reach * 2;  // half of one, and room for all roundings
    return {max(bounds.lo, space.lo * 0.5f - around), min(bounds.hi, space.hi * 0.5f + around)};
}

/// Across the longest side of where the middles lie, so that each part gets its share of the pieces. Appends the cells
/// that are cut off.
void RowBlocks::cut_cell(std::uint32_t b, std::span<Vec3> sample, std::size_t pieces,
                         std::vector<std::uint32_t>& cells) {
    if (pieces < 2 || sample.empty()) return;
    Aabb around;
    for (const Vec3& at : sample) around = merge(around, Aabb{at, at});
    const Vec3 sides = extent(around);
    const int axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
    if (!(sides[axis] > 0)) return;  // no plane tells them apart
    const auto half = sample.begin() + static_cast<std::ptrdiff_t>(sample.size() * (pieces / 2) / pieces);
    std::nth_element(sample.begin(), half, sample.end(), [axis](Vec3 p, Vec3 q) { return p[axis] < q[axis]; });
    const Vec3 least = around.lo;
    float at = (*half)[axis];
    if (!(at > least[axis])) {  // many in one place, at the border: the next one behind it
        at = Aabb::infinity;
        for (const Vec3 p : sample)
            if (p[axis] > least[axis]) at = std::min(at, p[axis]);
    }
    const auto behind = std::partition(sample.begin(), sample.end(), [&](const Vec3 p) { return p[axis] < at; });
    const auto below = static_cast<std::size_t>(behind - sample.begin());
    const std::uint32_t other = new_block(blocks_[b].planes);
    cells.push_back(other);
    planes_[blocks_[b].planes].cut(b, axis, at, other);
    cut_cell(b, sample.first(below), pieces / 2, cells);
    cut_cell(other, sample.subspan(below), pieces - pieces / 2, cells);
}

}  // namespace fase::broad
