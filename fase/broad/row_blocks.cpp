/// How blocks take in boxes, wear, are sorted anew, cut and joined.
#include "fase/broad/row_blocks.hpp"

#include <algorithm>
#include <limits>

#include "fase/core/check.hpp"

namespace fase::broad {
namespace {

constexpr std::size_t cut_to = RowBlocks::block_most / 4 * 3;  // leaves room to grow

/// A block has fewer boxes than the choice of cells is made for.
RowGridSettings settings_of(const RowGridSettings& settings, std::uint32_t sample) {
    RowGridSettings mine = settings;
    mine.sample = std::min(mine.sample, sample);
    return mine;
}

void append(const RowSet& set, std::vector<Move>& out) {
    const RowView view = set.view();
    for (std::size_t i = 0; i < view.count; ++i)
        if (view.proxies[i] != killed) out.push_back({view.proxies[i], view.box(i)});
}

float longest_side(const Aabb& box) {
    const Vec3 e = extent(box);
    return std::max(e.x, std::max(e.y, e.z));
}

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr Aabb nothing{{nan, nan, nan}, {nan, nan, nan}};

}  // namespace

void RowBlocks::clear() {
    for (BlockPlanes& planes : planes_) planes.clear();
    large_ = Aabb::infinity;
    blocks_.clear();
    free_.clear();
    worn_.clear();
    spots_.clear();
    bounds_.resize(0);
    size_ = erased_ = 0;
}

void RowBlocks::erase(Proxy p) {
    FASE_ASSERT(holds(p));
    const Spot spot = spots_[p];
    spots_[p] = {};
    Block& block = blocks_[spot.set / 2];
    (spot.set % 2 == 0 ? block.main : block.late).kill(spot.record);
    --size_;
    ++erased_;
    look_at(spot.set / 2);
}

/// Has it wait when it is worn.
void RowBlocks::look_at(std::uint32_t b) {
    Block& block = blocks_[b];
    if (block.waits || !block.worn()) return;
    block.waits = true;
    worn_.push_back(b);
}

void RowBlocks::commit(std::span<const Move> born, const RowGridSettings& settings) {
    const std::size_t changes = born.size() + std::exchange(erased_, 0);
    if (!born.empty()) {
        Proxy largest = 0;
        for (const Move& m : born) largest = std::max(largest, m.proxy);
        if (largest >= spots_.size()) spots_.resize(largest + std::size_t{1});
        size_ += born.size();
        take_in(born, settings);
    }
    std::size_t paid = block_most + 8 * changes, done = 0;
    while (done < worn_.size() && paid > 0) {
        const std::uint32_t b = worn_[done++];
        if (!blocks_[b].waits) continue;  // sorted anew since then
        paid -= std::min(paid, blocks_[b].live() + 1);
        mend(b, settings);
    }
    worn_.erase(worn_.begin(), worn_.begin() + static_cast<std::ptrdiff_t>(done));
}

std::uint32_t RowBlocks::new_block(std::uint8_t planes) {
    std::uint32_t b;
    if (free_.empty()) {
        b = static_cast<std::uint32_t>(blocks_.size());
        blocks_.emplace_back();
        bounds_.resize(sets());
    } else {
        b = free_.back();
        free_.pop_back();
    }
    blocks_[b].planes = planes;
    blocks_[b].used = true;
    return b;
}

void RowBlocks::drop_block(std::uint32_t b) {
    planes_[blocks_[b].planes].remove(b);
    blocks_[b] = {};
    for (std::uint32_t k = 2 * b; k < 2 * b + 2; ++k) bounds_.put(k, k, nothing);
    free_.push_back(b);
    if (planes_[0].empty() && planes_[1].empty()) large_ = Aabb::infinity;
}

void RowBlocks::group(std::span<const Move> boxes, Grouping& grouping) {
    grouping.homes.clear();
    grouping.touched.clear();
    for (const Move& m : boxes) {
        const std::uint8_t kind = longest_side(m.box) > large_ ? 1 : 0;
        if (planes_[kind].empty()) planes_[kind].begin(new_block(kind));
        const std::uint32_t b = planes_[kind].cell_of(m.box);
        grouping.homes.push_back(b);
        if (blocks_[b].coming++ == 0) grouping.touched.push_back(b);
    }
    grouping.boxes = boxes;
    if (grouping.touched.size() == 1) return;
    std::uint32_t sum = 0;
    for (const std::uint32_t b : grouping.touched) sum += std::exchange(blocks_[b].coming, sum);
    grouping.scratch.resize(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) grouping.scratch[blocks_[grouping.homes[i]].coming++] = boxes[i];
    std::uint32_t begin = 0;  // each has become where the next begins
    for (const std::uint32_t b : grouping.touched) blocks_[b].coming -= std::exchange(begin, blocks_[b].coming);
    grouping.boxes = grouping.scratch;
}

void RowBlocks::take_in(std::span<const Move> boxes, const RowGridSettings& settings) {
    group(boxes, born_);
    std::size_t begin = 0;
    for (const std::uint32_t b : born_.touched) {
        const std::size_t count = std::exchange(blocks_[b].coming, 0);
        add(b, born_.boxes.subspan(begin, count), settings);
        begin += count;
    }
}

/// Many boxes pay for sorting the block anew; few go beside it.
void RowBlocks::add(std::uint32_t b, std::span<const Move> boxes, const RowGridSettings& settings) {
    Block& block = blocks_[b];
    if (4 * boxes.size() >= block.live()) return remake(b, boxes, settings);
    gathered_.clear();
    append(block.late, gathered_);
    gathered_.insert(gathered_.end(), boxes.begin(), boxes.end());
    block.late.build(gathered_, settings_of(settings, 64));
    block.late_work += gathered_.size();
    settle(2 * b + 1);
    look_at(b);
}

/// What is to be done with a block that is worn.
void RowBlocks::mend(std::uint32_t b, const RowGridSettings& settings) {
    const std::size_t live = blocks_[b].live();
    if (live == 0) return drop_block(b);
    const std::uint32_t other = planes_[blocks_[b].planes].sibling(b);
    if (live > block_most / 8 || other == none || live + blocks_[other].live() > cut_to) return remake(b, {}, settings);
    std::vector<Move>& mine = pieces_.scratch;
    mine.clear();
    append(blocks_[b].main, mine);
    append(blocks_[b].late, mine);
    drop_block(b);
    remake(other, mine, settings);
}

/// Sorts a block anew, with more boxes; cuts it when there are too many.
void RowBlocks::remake(std::uint32_t b, std::span<const Move> more, const RowGridSettings& settings) {
    gathered_.clear();
    append(blocks_[b].main, gathered_);
    append(blocks_[b].late, gathered_);
    gathered_.insert(gathered_.end(), more.begin(), more.end());
    if (gathered_.size() <= block_most) return build(b, gathered_, settings);

    if (large_ == Aabb::infinity) choose_large(gathered_);
    const std::size_t pieces = (gathered_.size() + cut_to - 1) / cut_to;
    const std::size_t looked_at = std::min(gathered_.size(), 64 * std::max<std::size_t>(pieces, 16));
    sample_.clear();
    for (std::size_t i = 0; i < looked_at; ++i)
        sample_.push_back(BlockPlanes::middle(gathered_[i * gathered_.size() / looked_at].box));
    cut_cell(b, sample_, pieces);
    group(gathered_, pieces_);
    std::size_t begin = 0;
    for (const std::uint32_t piece : pieces_.touched) {
        const std::size_t count = std::exchange(blocks_[piece].coming, 0);
        build(piece, pieces_.boxes.subspan(begin, count), settings);
        begin += count;
    }
}

/// When the first block is cut: four times as long as nearly all others is large.
void RowBlocks::choose_large(std::span<const Move> boxes) {
    constexpr std::size_t looked_at = 1024;
    std::vector<float> sides;
    for (std::size_t i = 0; i < looked_at; ++i) sides.push_back(longest_side(boxes[i * boxes.size() / looked_at].box));
    std::sort(sides.begin(), sides.end());
    large_ = 4 * sides[looked_at / 50 * 49];
}

/// Across the longest side of where the middles lie, so that each part gets its share of the pieces.
void RowBlocks::cut_cell(std::uint32_t b, std::span<Vec3> sample, std::size_t pieces) {
    if (pieces < 2 || sample.empty()) return;
    Aabb around;
    for (const Vec3& at : sample) around = merge(around, Aabb{at, at});
    const Vec3 sides = extent(around);
    const int axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
    Vec3 least = around.lo;
    if (!(sides[axis] > 0)) return;  // no plane tells them apart
    const auto half = sample.begin() + static_cast<std::ptrdiff_t>(sample.size() * (pieces / 2) / pieces);
    std::nth_element(sample.begin(), half, sample.end(), [axis](Vec3 p, Vec3 q) { return p[axis] < q[axis]; });
    Vec3 at = *half;
    if (!(at[axis] > least[axis])) {  // many in one place, at the border: the next one behind it
        float next = Aabb::infinity;
        for (Vec3 p : sample)
            if (p[axis] > least[axis]) next = std::min(next, p[axis]);
        at[axis] = next;
    }
    const auto behind = std::partition(sample.begin(), sample.end(), [&](Vec3 p) { return p[axis] < at[axis]; });
    const auto below = static_cast<std::size_t>(behind - sample.begin());
    const std::uint32_t other = new_block(blocks_[b].planes);
    planes_[blocks_[b].planes].cut(b, axis, at[axis], other);
    cut_cell(b, sample.first(below), pieces / 2);
    cut_cell(other, sample.subspan(below), pieces - pieces / 2);
}

void RowBlocks::build(std::uint32_t b, std::span<const Move> boxes, const RowGridSettings& settings) {
    Block& block = blocks_[b];
    block.main.build(boxes, settings_of(settings, 256));
    if (block.late.size() > 0) block.late.build({}, settings);
    block.late_work = 0;
    block.waits = false;
    settle(2 * b);
    settle(2 * b + 1);
}

/// Notes where the boxes of a set that was made anew stand, and their bounds.
void RowBlocks::settle(std::uint32_t k) {
    const RowView view = set(k).view();
    Aabb around;
    for (std::uint32_t i = 0; i < view.count; ++i) {
        spots_[view.proxies[i]] = {k, i};
        around = merge(around, view.box(i));
    }
    bounds_.put(k, k, view.count == 0 ? nothing : around);
}

std::size_t RowBlocks::bytes() const {
    std::size_t sum = spots_.capacity() * sizeof(Spot) + blocks_.capacity() * sizeof(Block) + bounds_.bytes();
    for (const Block& block : blocks_) sum += block.main.bytes() + block.late.bytes();
    for (const BlockPlanes& planes : planes_) sum += planes.bytes();
    for (const Grouping* grouping : {&born_, &pieces_})
        sum += grouping->homes.capacity() * sizeof(std::uint32_t) + grouping->scratch.capacity() * sizeof(Move);
    return sum + gathered_.capacity() * sizeof(Move) + sample_.capacity() * sizeof(Vec3);
}

std::string RowBlocks::broken_invariant() const {
    std::size_t live = 0, spots = 0;
    std::array<std::size_t, 2> cells{};
    std::vector<Move> boxes;
    for (std::uint32_t b = 0; b < blocks_.size(); ++b) {
        const Block& block = blocks_[b];
        live += block.live();
        if (block.used) {
            ++cells[block.planes];
        } else if (block.main.size() + block.late.size() > 0) {
            return "a block that is not in use holds boxes";
        }
        if (block.worn() && block.used && !block.waits) return "a worn block does not wait";
        if (block.waits && std::find(worn_.begin(), worn_.end(), b) == worn_.end()) return "a block waits for nothing";
        for (std::uint32_t k = 2 * b; k < 2 * b + 2; ++k) {
            boxes.clear();
            append(set(k), boxes);
            if (std::string broken = set(k).broken_invariant(boxes); !broken.empty()) return broken;
            for (const Move& m : boxes) {
                if (!contains(bounds_.box(k), m.box)) return "a box lies outside of its set's bounds";
                const bool is_large = longest_side(m.box) > large_;
                if (is_large != (block.planes == 1)) return "a box stands among those of another size";
                if (planes_[block.planes].cell_of(m.box) != b) return "a box stands in another's block";
                if (!holds(m.proxy) || spots_[m.proxy].set != k) return "a box is not where its proxy says";
                if (set(k).view().proxies[spots_[m.proxy].record] != m.proxy) return "a proxy points at another's box";
            }
        }
    }
    for (const Spot& spot : spots_) spots += spot.set != none ? 1 : 0;
    if (live != size_ || spots != size_) return "the boxes are miscounted";
    for (std::size_t k = 0; k < 2; ++k)
        if (std::string broken = planes_[k].broken_invariant(cells[k]); !broken.empty()) return broken;
    return {};
}

}  // namespace fase::broad
