/// How blocks take in boxes and let them go.
#include "fase/broad/row_grid/blocks.hpp"

#include <algorithm>
#include <limits>

#include "fase/core/detail/check.hpp"

namespace fase::broad {
namespace {

/// A block has fewer boxes than the choice of cells is made for.
RowGridSettings with_sample(const RowGridSettings& settings, std::uint32_t sample) {
    RowGridSettings mine = settings;
    mine.sample = std::min(mine.sample, sample);
    return mine;
}

void append(const RowSet& set, std::vector<Move>& out) {
    const RowView view = set.view();
    for (std::size_t i = 0; i < view.count; ++i)
        if (view.proxies[i] != killed) out.push_back({view.proxies[i], view.box(i)});
}

/// Frees what a rare large change has left behind.
template <class T> void keep_small(std::vector<T>& scratch) {
    if (scratch.capacity() > 2 * RowBlocks::block_max) scratch = std::vector<T>();  // {} would keep the room
}

constexpr std::size_t a_hole_in = 8;  // boxes of a block that has lived

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr Aabb nothing{{nan, nan, nan}, {nan, nan, nan}};

}  // namespace

void RowBlocks::append_boxes(std::uint32_t b, std::vector<Move>& out) const {
    append(blocks_[b].main, out);
    append(blocks_[b].late, out);
}

void RowBlocks::clear() { *this = {}; }

void RowBlocks::erase(Proxy p) {
    FASE_ASSERT(holds(p));
    const Spot spot = std::exchange(spots_[p], {});
    Block& block = blocks_[spot.set / 2];
    if (block.going == 0) losing_.push_back(spot.set / 2);
    if (++block.going <= block.max_listed()) gone_.push_back(spot);
    --size_;
}

/// Empties the records of all that has been erased. Of a block of which nothing is left, not even that; in one that has
/// lost many, those that are not listed are looked for.
void RowBlocks::empty_records() {
    for (const std::uint32_t b : losing_)
        if (blocks_[b].going == blocks_[b].live() && !blocks_[b].is_heir) drop_block(b);
    for (const Spot spot : gone_)
        if (blocks_[spot.set / 2].used) set_at(spot.set).kill(spot.record);
    for (const std::uint32_t b : losing_) {
        Block& block = blocks_[b];
        if (!block.used) continue;
        if (block.going > block.max_listed()) {
            for (const std::uint32_t k : {2 * b, 2 * b + 1}) {
                const Proxy* const proxies = set(k).view().proxies;
                for (std::uint32_t i = 0; i < set(k).size(); ++i)
                    if (proxies[i] != killed && spots_[proxies[i]] != Spot{k, i}) set_at(k).kill(i);
            }
        }
        block.going = 0;
        look_at(b);
    }
    losing_.clear();
    gone_.clear();
    keep_small(gone_);
}

void RowBlocks::commit(std::span<const Move> born, const RowGridSettings& settings) {
    if (born.empty() && !work_waits()) return;
    std::size_t gone = 0;
    for (const std::uint32_t b : losing_) gone += blocks_[b].going;
    std::size_t paid = block_max + 2 * (born.size() + gone);
    if (gone > 0) empty_records();
    if (!born.empty()) {
        Proxy largest = 0;
        for (const Move& m : born) largest = std::max(largest, m.proxy);
        spots_.grow_to(largest + std::size_t{1});
        size_ += born.size();
        take_in(born, settings);
    }
    while (paid > block_max / 2 && (!worn_.empty() || !dissolving_.empty()))
        paid -= std::min(paid, mend(settings) + 256);
    for (std::vector<Move>* scratch : {&gathered_, &grouped_}) keep_small(*scratch);
    keep_small(homes_);
}

void RowBlocks::adopt(RowSet&& sorted, std::span<const Proxy> gone) {
    clear();
    if (sorted.size() == 0) return;
    const std::uint32_t b = new_block(0);
    planes_[0].begin(b);
    blocks_[b].main = std::move(sorted);
    const RowView view = blocks_[b].main.view();
    size_ = view.count;
    spots_.grow_to(*std::max_element(view.proxies, view.proxies + view.count) + std::size_t{1});
    settle(2 * b);
    for (const Proxy p : gone)
        if (holds(p)) erase(p);
}

void RowBlocks::give_up(std::vector<Move>& out) {
    empty_records();
    for (std::uint32_t k = 0; k < sets(); ++k) append(set(k), out);
    clear();
}

/// Has it wait when it is worn.
void RowBlocks::look_at(std::uint32_t b) {
    Block& block = blocks_[b];
    if (!block.used || block.waits || block.planes == dissolves || !block.worn()) return;
    block.waits = true;
    worn_.push_back(b);
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
    if (blocks_[b].planes == dissolves) {
        const auto it =
            std::find_if(dissolving_.begin(), dissolving_.end(), [b](const Dissolving& one) { return one.block == b; });
        for (const std::uint32_t heir : it->heirs) {
            blocks_[heir].is_heir = false;
            look_at(heir);
        }
        dissolving_.erase(it);
    } else {
        planes_[blocks_[b].planes].remove(b);
    }
    blocks_[b] = {};
    for (std::uint32_t k = 2 * b; k < 2 * b + 2; ++k) bounds_.put(k, k, nothing);
    free_.push_back(b);
    if (planes_[0].empty() && planes_[1].empty()) large_ = Aabb::infinity;
}

/// The boxes in the order of the blocks that their middles lie in; the blocks are `touched_` then, and how many belong
/// to each is what it has coming.
std::span<const Move> RowBlocks::group(std::span<const Move> boxes) {
    homes_.clear();
    touched_.clear();
    for (const Move& m : boxes) {
        const std::uint8_t kind = longest_side(m.box) > large_ ? 1 : 0;
        if (planes_[kind].empty()) planes_[kind].begin(new_block(kind));
        const std::uint32_t b = planes_[kind].cell_of(m.box);
        homes_.push_back(b);
        if (blocks_[b].coming++ == 0) touched_.push_back(b);
    }
    if (touched_.size() == 1) return boxes;
    std::uint32_t sum = 0;
    for (const std::uint32_t b : touched_) sum += std::exchange(blocks_[b].coming, sum);
    grouped_.resize(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) grouped_[blocks_[homes_[i]].coming++] = boxes[i];
    std::uint32_t begin = 0;
    for (const std::uint32_t b : touched_) {  // each has become where the next begins
        const std::uint32_t end = blocks_[b].coming;
        blocks_[b].coming = end - begin;
        begin = end;
    }
    return grouped_;
}

void RowBlocks::take_in(std::span<const Move> boxes, const RowGridSettings& settings) {
    const std::span<const Move> grouped = group(boxes);
    std::size_t begin = 0;
    for (const std::uint32_t b : touched_) {
        const std::size_t count = std::exchange(blocks_[b].coming, 0);
        add(b, grouped.subspan(begin, count), settings);
        begin += count;
    }
}

/// Many boxes pay for sorting the block anew. Few go where others have left, or beside it where there is no room.
void RowBlocks::add(std::uint32_t b, std::span<const Move> boxes, const RowGridSettings& settings) {
    Block& block = blocks_[b];
    if (4 * boxes.size() >= block.live()) return remake(b, boxes, settings);
    gathered_.clear();
    for (const Move& m : boxes)
        if (!put(2 * b, m) && !put(2 * b + 1, m)) gathered_.push_back(m);
    if (!gathered_.empty()) {
        append(block.late, gathered_);
        block.late.build(gathered_, with_sample(settings, 64));
        block.late_work += gathered_.size();
        settle(2 * b + 1);
    }
    look_at(b);
}

bool RowBlocks::put(std::uint32_t k, const Move& m) {
    const std::optional<RecordSpan> moved = set_at(k).put(m);
    if (!moved) return false;
    const Proxy* const proxies = set(k).view().proxies;
    for (std::uint32_t i = moved->begin; i < moved->end; ++i)
        if (proxies[i] != killed) spots_[proxies[i]] = {k, i};
    bounds_.put(k, k, merge(bounds_.box(k), m.box));
    return true;
}

/// Sorts a block anew, with more boxes. One that has lived already gets room for others.
void RowBlocks::remake(std::uint32_t b, std::span<const Move> more, const RowGridSettings& settings) {
    Block& block = blocks_[b];
    gathered_.clear();
    append_boxes(b, gathered_);
    const bool has_lived = !gathered_.empty() || planes_[block.planes].is_cut();
    std::span<const Move> boxes = more;
    if (has_lived) {
        gathered_.insert(gathered_.end(), more.begin(), more.end());
        const std::size_t count = gathered_.size();
        if (count <= block_max)
            for (std::size_t i = 0; i < count; i += a_hole_in) gathered_.push_back({killed, gathered_[i].box});
        boxes = gathered_;
    }
    block.main.build(boxes, boxes.size() > block_max ? settings : with_sample(settings, 256));
    if (has_lived) block.main.make_holes();
    if (block.late.size() > 0) block.late.build(std::span<const Move>(), settings);
    block.late_work = 0;
    block.holes = static_cast<std::uint32_t>(block.main.dead());
    block.waits = false;
    settle(2 * b);
    settle(2 * b + 1);
    look_at(b);
}

/// Notes where the boxes of a set that was made anew stand, and their bounds.
void RowBlocks::settle(std::uint32_t k) {
    const RowView view = set(k).view();
    for (std::uint32_t i = 0; i < view.count; ++i)
        if (view.proxies[i] != killed) spots_[view.proxies[i]] = {k, i};
    bounds_.put(k, k, view.count == 0 ? nothing : bounds_of({view.lo, view.hi, view.proxies, view.count}));
}

std::size_t RowBlocks::bytes() const {
    std::size_t sum =
        spots_.bytes() + gone_.capacity() * sizeof(Spot) + blocks_.capacity() * sizeof(Block) + bounds_.bytes();
    for (const Block& block : blocks_) sum += block.main.bytes() + block.late.bytes();
    for (const BlockPlanes& planes : planes_) sum += planes.bytes();
    return sum + (gathered_.capacity() + grouped_.capacity()) * sizeof(Move) +
           homes_.capacity() * sizeof(std::uint32_t);
}

std::string RowBlocks::broken_invariant() const {
    std::size_t live = 0, spots = 0;
    std::array<std::size_t, 2> cells{};
    std::vector<Move> boxes;
    for (std::uint32_t b = 0; b < blocks_.size(); ++b) {
        const Block& block = blocks_[b];
        live += block.live();
        if (!block.used && block.main.size() + block.late.size() > 0) return "a block that is not in use holds boxes";
        if (block.coming + block.going > 0) return "a block has boxes coming or going";
        if (!block.used) continue;
        if (block.planes != dissolves) {
            ++cells[block.planes];
            if (block.worn() && !block.waits) return "a worn block does not wait";
        }
        if (block.waits && std::find(worn_.begin(), worn_.end(), b) == worn_.end()) return "a block waits for nothing";
        for (std::uint32_t k = 2 * b; k < 2 * b + 2; ++k) {
            boxes.clear();
            append(set(k), boxes);
            if (std::string broken = set(k).broken_invariant(boxes); !broken.empty()) return broken;
            for (const Move& m : boxes) {
                if (!contains(bounds_.box(k), m.box)) return "a box lies outside of its set's bounds";
                if (!holds(m.proxy) || spots_[m.proxy].set != k) return "a box is not where its proxy says";
                if (set(k).view().proxies[spots_[m.proxy].record] != m.proxy) return "a proxy points at another's box";
                const bool is_large = longest_side(m.box) > large_;
                if (planes_[is_large ? 1 : 0].empty()) return "a box lies in no cell";
                const std::uint32_t home = planes_[is_large ? 1 : 0].cell_of(m.box);
                if (block.planes == dissolves ? !blocks_[home].is_heir : home != b)
                    return "a box stands in another's block";
            }
        }
    }
    for (std::size_t p = 0; p < spots_.size(); ++p) spots += spots_[p].set != none ? 1 : 0;
    if (live != size_ || spots != size_) return "the boxes are miscounted";
    for (std::size_t k = 0; k < 2; ++k)
        if (std::string broken = planes_[k].broken_invariant(cells[k]); !broken.empty()) return broken;
    return {};
}

}  // namespace fase::broad
