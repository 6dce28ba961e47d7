/// Rebuilds fragmented blocks, merges small ones and splits large ones.
#include <algorithm>

#include "fase/broad/row_grid/blocks.hpp"

namespace fase::broad {
namespace {

constexpr std::size_t target_size = RowBlocks::block_max / 4 * 3;  // leaves capacity for growth
constexpr std::size_t sample_per_piece = 64;

/// A conservative region of the boxes whose centres are in a cell, for traversals of rows.
struct CellRegion {
    Aabb space;  // the doubled cell

    [[nodiscard]] bool touches(const Aabb& box) const { return overlaps(space, {box.lo + box.lo, box.hi + box.hi}); }
    [[nodiscard]] Aabb bounds() const { return {space.lo * 0.5f, space.hi * 0.5f}; }
};

/// Samples the doubled centres of boxes all over the set, and their longest sides in ascending order.
void take_sample(const RowView& set, std::size_t count, std::vector<Vec3>& centres, std::vector<float>& sides) {
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = i * set.count / count;
        if (set.proxies[at] == tombstone) continue;
        const Aabb box = set.box(at);
        centres.push_back(BlockPlanes::doubled_centre(box));
        sides.push_back(longest_side(box));
    }
    std::sort(sides.begin(), sides.end());
}

}  // namespace

std::size_t RowBlocks::do_pending_work(const RowGridSettings& settings) {
    if (!splits_.empty()) return continue_split(settings);
    const std::uint32_t b = fragmented_.front();
    fragmented_.erase(fragmented_.begin());
    if (!blocks_[b].is_queued) return 0;  // rebuilt since then
    blocks_[b].is_queued = false;
    return rebuild_fragmented(b, settings);
}

std::size_t RowBlocks::rebuild_fragmented(std::uint32_t b, const RowGridSettings& settings) {
    const std::size_t live = blocks_[b].live();
    if (live == 0) {
        if (!blocks_[b].is_split_target) drop_block(b);
        return 0;
    }
    if (live > block_max && begin_split(b, settings)) return continue_split(settings);
    const std::uint32_t other = planes_[blocks_[b].planes].sibling(b);
    const bool merges = live < block_max / 8 && !blocks_[b].is_split_target && other != no_index &&
                        live + blocks_[other].live() <= target_size;
    if (!merges) {
        rebuild(b, {}, settings);
        return live;
    }
    grouped_.clear();
    append_boxes(b, grouped_);
    drop_block(b);
    rebuild(other, grouped_, settings);
    return blocks_[other].live();
}

/// Assigns the cell of the block to split targets, which get its boxes later. False when no plane separates its boxes.
bool RowBlocks::begin_split(std::uint32_t b, const RowGridSettings& settings) {
    const std::uint8_t kind = blocks_[b].planes;
    const std::size_t pieces = (blocks_[b].live() + target_size - 1) / target_size;
    std::vector<Vec3> centres;
    std::vector<float> sides;
    take_sample(blocks_[b].main.view(), std::min(blocks_[b].main.size(), sample_per_piece * (pieces + 8)), centres,
                sides);
    if (sides.empty()) return false;
    const float old_large_side = large_side_;
    if (large_side_ == Aabb::infinity) large_side_ = 4 * sides[(sides.size() - 1) * 49 / 50];
    Split split{b, {new_block(kind)}};
    planes_[kind].replace(b, split.targets[0]);
    split_cell(split.targets[0], centres, pieces, split.targets);
    if (split.targets.size() == 1) {
        planes_[kind].replace(split.targets[0], b);
        blocks_[split.targets[0]] = {};
        free_.push_back(split.targets[0]);
        large_side_ = old_large_side;
        return false;
    }
    for (const std::uint32_t target : split.targets) blocks_[target].is_split_target = true;
    std::reverse(split.targets.begin(), split.targets.end());
    blocks_[b].is_splitting = true;
    splits_.push_back(std::move(split));

    if (old_large_side != large_side_) {  // large boxes are separated from the others for the first time
        std::vector<Move> large;
        for (const RowSet* set : {&blocks_[b].main, &blocks_[b].overflow}) {
            const RowView view = set->view();
            for (const RowLevel& level : view.levels) {
                if (level.limit <= large_side_) continue;
                for (std::size_t i = level.first; i < level.first + level.count; ++i)
                    if (view.proxies[i] != tombstone && longest_side(view.box(i)) > large_side_)
                        large.push_back({view.proxies[i], view.box(i)});
            }
        }
        for (const Move& m : large) mutable_set(locations_[m.proxy].set).erase_record(locations_[m.proxy].record);
        if (!large.empty()) insert_all(large, settings);
    }
    return true;
}

/// Moves the boxes of the next split target into it.
std::size_t RowBlocks::continue_split(const RowGridSettings& settings) {
    Split& split = splits_.front();
    const std::uint32_t target = split.targets.back();
    split.targets.pop_back();
    blocks_[target].is_split_target = false;
    const BlockPlanes& planes = planes_[blocks_[target].planes];
    const CellRegion region{planes.space_of(target)};
    grouped_.clear();
    for (const std::uint32_t k : {2 * split.block, 2 * split.block + 1}) {
        const std::size_t first = grouped_.size();
        row_grid::walk(set(k).view(), region, [&](Proxy p, const Aabb& box) {
            if (planes.cell_of(box) == target) grouped_.push_back({p, box});
            return true;
        });
        for (std::size_t i = first; i < grouped_.size(); ++i)
            mutable_set(k).erase_record(locations_[grouped_[i].proxy].record);
    }
    const std::size_t count = grouped_.size();
    if (count > 0) {
        rebuild(target, grouped_, settings);
    } else {
        queue_if_fragmented(target);
    }
    if (split.targets.empty()) {
        drop_block(split.block);
        return count;
    }
    for (const std::uint32_t k : {2 * split.block, 2 * split.block + 1}) {  // the remaining boxes are in these cells
        if (set(k).size() == set(k).tombstones()) continue;
        Aabb remaining;
        for (const std::uint32_t other : split.targets) remaining = merge(remaining, planes.space_of(other));
        bounds_.put(k, k, clipped_bounds(bounds_.box(k), remaining, set(k).view()));
    }
    return count;
}

/// Clips the bounds of a set whose boxes have their centres in a space, given as doubled coordinates.
Aabb RowBlocks::clipped_bounds(const Aabb& bounds, const Aabb& space, const RowView& set) {
    Vec3 reach;
    for (const RowLevel& level : set.levels)
        if (level.count > 0) reach = max(reach, Vec3{level.reach[0], level.reach[1], level.reach[2]});
    const Vec3 margin = reach * 2;  // half of the reach, and enough for all rounding errors
    return {max(bounds.lo, space.lo * 0.5f - margin), min(bounds.hi, space.hi * 0.5f + margin)};
}

/// Splits a cell across the longest side of the bounds of the sampled centres, so that each part gets its share of the
/// pieces. Appends the new cells.
void RowBlocks::split_cell(std::uint32_t b, std::span<Vec3> sample, std::size_t pieces,
                           std::vector<std::uint32_t>& cells) {
    if (pieces < 2 || sample.empty()) return;
    Aabb around;
    for (const Vec3& at : sample) around = merge(around, Aabb{at, at});
    const Vec3 sides = extent(around);
    const int axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
    if (!(sides[axis] > 0)) return;  // no plane separates them
    const auto half = sample.begin() + static_cast<std::ptrdiff_t>(sample.size() * (pieces / 2) / pieces);
    std::nth_element(sample.begin(), half, sample.end(), [axis](Vec3 p, Vec3 q) { return p[axis] < q[axis]; });
    const Vec3 lowest = around.lo;
    float at = (*half)[axis];
    if (!(at > lowest[axis])) {  // many coincide at the border: take the next larger one
        at = Aabb::infinity;
        for (const Vec3 p : sample)
            if (p[axis] > lowest[axis]) at = std::min(at, p[axis]);
    }
    const auto upper = std::partition(sample.begin(), sample.end(), [&](const Vec3 p) { return p[axis] < at; });
    const auto below = static_cast<std::size_t>(upper - sample.begin());
    const std::uint32_t other = new_block(blocks_[b].planes);
    cells.push_back(other);
    planes_[blocks_[b].planes].cut(b, axis, at, other);
    split_cell(b, sample.first(below), pieces / 2, cells);
    split_cell(other, sample.subspan(below), pieces - pieces / 2, cells);
}

}  // namespace fase::broad
