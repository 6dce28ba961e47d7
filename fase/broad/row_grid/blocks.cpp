/// Insertion into blocks, erasure from them, and their rebuild.
#include "fase/broad/row_grid/blocks.hpp"

#include <algorithm>
#include <limits>

#include "fase/core/detail/check.hpp"

namespace fase::broad {
namespace {

/// A block is small, so a smaller sample is enough to choose its cells.
RowGridSettings with_sample(const RowGridSettings& settings, std::uint32_t sample) {
    RowGridSettings mine = settings;
    mine.sample = std::min(mine.sample, sample);
    return mine;
}

void append(const RowSet& set, std::vector<Move>& out) {
    const RowView view = set.view();
    for (std::size_t i = 0; i < view.count; ++i)
        if (view.proxies[i] != tombstone) out.push_back({view.proxies[i], view.box(i)});
}

/// Frees the capacity that a rare large change has left behind.
template <class T> void release_if_large(std::vector<T>& scratch) {
    if (scratch.capacity() > 2 * RowBlocks::block_max) scratch = std::vector<T>();  // {} would keep the capacity
}

constexpr std::size_t free_slot_interval = 8;  // boxes per free slot in a block that changes

constexpr float nan = std::numeric_limits<float>::quiet_NaN();
constexpr Aabb no_bounds{{nan, nan, nan}, {nan, nan, nan}};

}  // namespace

void RowBlocks::append_boxes(std::uint32_t b, std::vector<Move>& out) const {
    append(blocks_[b].main, out);
    append(blocks_[b].overflow, out);
}

void RowBlocks::clear() { *this = {}; }

void RowBlocks::erase(Proxy p) {
    FASE_ASSERT(holds(p));
    const Location location = std::exchange(locations_[p], {});
    Block& block = blocks_[location.set / 2];
    if (block.pending_erasures == 0) blocks_with_erasures_.push_back(location.set / 2);
    if (++block.pending_erasures <= block.max_listed_erasures()) erased_.push_back(location);
    --size_;
}

/// Turns the records of erased boxes into tombstones. Drops blocks without remaining boxes. In a block with many
/// erasures, scans for those that are not listed.
void RowBlocks::apply_erasures() {
    for (const std::uint32_t b : blocks_with_erasures_)
        if (blocks_[b].pending_erasures == blocks_[b].live() && !blocks_[b].is_split_target) drop_block(b);
    for (const Location location : erased_)
        if (blocks_[location.set / 2].used) mutable_set(location.set).erase_record(location.record);
    for (const std::uint32_t b : blocks_with_erasures_) {
        Block& block = blocks_[b];
        if (!block.used) continue;
        if (block.pending_erasures > block.max_listed_erasures()) {
            for (const std::uint32_t k : {2 * b, 2 * b + 1}) {
                const Proxy* const proxies = set(k).view().proxies;
                for (std::uint32_t i = 0; i < set(k).size(); ++i)
                    if (proxies[i] != tombstone && locations_[proxies[i]] != Location{k, i})
                        mutable_set(k).erase_record(i);
            }
        }
        block.pending_erasures = 0;
        queue_if_fragmented(b);
    }
    blocks_with_erasures_.clear();
    erased_.clear();
    release_if_large(erased_);
}

void RowBlocks::commit(std::span<const Move> added, const RowGridSettings& settings) {
    if (added.empty() && !has_pending_work()) return;
    std::size_t removed = 0;
    for (const std::uint32_t b : blocks_with_erasures_) removed += blocks_[b].pending_erasures;
    std::size_t budget = block_max + 2 * (added.size() + removed);  // of boxes to process
    if (removed > 0) apply_erasures();
    if (!added.empty()) {
        Proxy largest = 0;
        for (const Move& m : added) largest = std::max(largest, m.proxy);
        locations_.grow_to(largest + std::size_t{1});
        size_ += added.size();
        insert_all(added, settings);
    }
    while (budget > block_max / 2 && (!fragmented_.empty() || !splits_.empty()))
        budget -= std::min(budget, do_pending_work(settings) + 256);
    for (std::vector<Move>* scratch : {&gathered_, &grouped_}) release_if_large(*scratch);
    release_if_large(home_blocks_);
}

void RowBlocks::adopt(RowSet&& sorted, std::span<const Proxy> removed) {
    clear();
    if (sorted.size() == 0) return;
    const std::uint32_t b = new_block(0);
    planes_[0].begin(b);
    blocks_[b].main = std::move(sorted);
    const RowView view = blocks_[b].main.view();
    size_ = view.count;
    locations_.grow_to(*std::max_element(view.proxies, view.proxies + view.count) + std::size_t{1});
    store_locations(2 * b);
    for (const Proxy p : removed)
        if (holds(p)) erase(p);
}

void RowBlocks::extract_all(std::vector<Move>& out) {
    apply_erasures();
    for (std::uint32_t k = 0; k < sets(); ++k) append(set(k), out);
    clear();
}

/// Queues a fragmented block for rebuild.
void RowBlocks::queue_if_fragmented(std::uint32_t b) {
    Block& block = blocks_[b];
    if (!block.used || block.is_queued || block.is_splitting || !block.is_fragmented()) return;
    block.is_queued = true;
    fragmented_.push_back(b);
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
    if (blocks_[b].is_splitting) {
        const auto it =
            std::find_if(splits_.begin(), splits_.end(), [b](const Split& split) { return split.block == b; });
        for (const std::uint32_t target : it->targets) {
            blocks_[target].is_split_target = false;
            queue_if_fragmented(target);
        }
        splits_.erase(it);
    } else {
        planes_[blocks_[b].planes].remove(b);
    }
    blocks_[b] = {};
    for (std::uint32_t k = 2 * b; k < 2 * b + 2; ++k) bounds_.put(k, k, no_bounds);
    free_.push_back(b);
    if (planes_[0].empty() && planes_[1].empty()) large_side_ = Aabb::infinity;
}

/// Returns the boxes grouped by the block whose cell contains their centre. Sets `touched_` to these blocks, in the
/// order of the groups, and Block::incoming to the size of each group.
std::span<const Move> RowBlocks::group_by_block(std::span<const Move> boxes) {
    home_blocks_.clear();
    touched_.clear();
    for (const Move& m : boxes) {
        const std::uint8_t kind = longest_side(m.box) > large_side_ ? 1 : 0;
        if (planes_[kind].empty()) planes_[kind].begin(new_block(kind));
        const std::uint32_t b = planes_[kind].cell_of(m.box);
        home_blocks_.push_back(b);
        if (blocks_[b].incoming++ == 0) touched_.push_back(b);
    }
    if (touched_.size() == 1) return boxes;
    std::uint32_t sum = 0;
    for (const std::uint32_t b : touched_) {
        blocks_[b].next_incoming = sum;
        sum += blocks_[b].incoming;
    }
    grouped_.resize(boxes.size());
    for (std::size_t i = 0; i < boxes.size(); ++i) grouped_[blocks_[home_blocks_[i]].next_incoming++] = boxes[i];
    return grouped_;
}

void RowBlocks::insert_all(std::span<const Move> boxes, const RowGridSettings& settings) {
    const std::span<const Move> grouped = group_by_block(boxes);
    std::size_t begin = 0;
    for (const std::uint32_t b : touched_) {
        const std::size_t count = std::exchange(blocks_[b].incoming, 0);
        insert_into(b, grouped.subspan(begin, count), settings);
        begin += count;
    }
}

/// Many boxes pay for a rebuild of the block. Few go into free slots, or into the overflow set if there are none.
void RowBlocks::insert_into(std::uint32_t b, std::span<const Move> boxes, const RowGridSettings& settings) {
    Block& block = blocks_[b];
    if (4 * boxes.size() >= block.live()) return rebuild(b, boxes, settings);
    gathered_.clear();
    for (const Move& m : boxes)
        if (!try_insert(2 * b, m) && !try_insert(2 * b + 1, m)) gathered_.push_back(m);
    if (!gathered_.empty()) {
        append(block.overflow, gathered_);
        block.overflow.build(gathered_, with_sample(settings, 64));
        block.overflow_work += gathered_.size();
        store_locations(2 * b + 1);
    }
    queue_if_fragmented(b);
}

bool RowBlocks::try_insert(std::uint32_t k, const Move& m) {
    const std::optional<RecordSpan> moved = mutable_set(k).try_insert(m);
    if (!moved) return false;
    const Proxy* const proxies = set(k).view().proxies;
    for (std::uint32_t i = moved->begin; i < moved->end; ++i)
        if (proxies[i] != tombstone) locations_[proxies[i]] = {k, i};
    bounds_.put(k, k, merge(bounds_.box(k), m.box));
    return true;
}

/// Rebuilds a block with its boxes and added ones. A block that has changed before gets free slots for later boxes.
void RowBlocks::rebuild(std::uint32_t b, std::span<const Move> added, const RowGridSettings& settings) {
    Block& block = blocks_[b];
    gathered_.clear();
    append_boxes(b, gathered_);
    const bool has_changed = !gathered_.empty() || planes_[block.planes].is_cut();
    std::span<const Move> boxes = added;
    if (has_changed) {
        gathered_.insert(gathered_.end(), added.begin(), added.end());
        const std::size_t count = gathered_.size();
        if (count <= block_max)
            for (std::size_t i = 0; i < count; i += free_slot_interval)
                gathered_.push_back({tombstone, gathered_[i].box});
        boxes = gathered_;
    }
    block.main.build(boxes, boxes.size() > block_max ? settings : with_sample(settings, 256));
    if (has_changed) block.main.make_free_slots();
    if (block.overflow.size() > 0) block.overflow.build(std::span<const Move>(), settings);
    block.overflow_work = 0;
    block.built_in_slots = static_cast<std::uint32_t>(block.main.tombstones());
    block.is_queued = false;
    store_locations(2 * b);
    store_locations(2 * b + 1);
    queue_if_fragmented(b);
}

/// Stores the locations of the boxes of a rebuilt set, and its bounds.
void RowBlocks::store_locations(std::uint32_t k) {
    const RowView view = set(k).view();
    for (std::uint32_t i = 0; i < view.count; ++i)
        if (view.proxies[i] != tombstone) locations_[view.proxies[i]] = {k, i};
    bounds_.put(k, k, view.count == 0 ? no_bounds : bounds_of({view.lo, view.hi, view.proxies, view.count}));
}

std::size_t RowBlocks::bytes() const {
    std::size_t sum = locations_.bytes() + erased_.capacity() * sizeof(Location) + blocks_.capacity() * sizeof(Block) +
                      bounds_.bytes();
    for (const Block& block : blocks_) sum += block.main.bytes() + block.overflow.bytes();
    for (const BlockPlanes& planes : planes_) sum += planes.bytes();
    return sum + (gathered_.capacity() + grouped_.capacity()) * sizeof(Move) +
           home_blocks_.capacity() * sizeof(std::uint32_t);
}

std::string RowBlocks::broken_invariant() const {
    std::size_t live = 0, stored = 0;
    std::array<std::size_t, 2> cells{};
    std::vector<Move> boxes;
    for (std::uint32_t b = 0; b < blocks_.size(); ++b) {
        const Block& block = blocks_[b];
        live += block.live();
        if (!block.used && block.main.size() + block.overflow.size() > 0) return "an unused block holds boxes";
        if (block.incoming + block.pending_erasures > 0) return "a block has pending insertions or erasures";
        if (!block.used) continue;
        if (!block.is_splitting) {
            ++cells[block.planes];
            if (block.is_fragmented() && !block.is_queued) return "a fragmented block is not queued";
        }
        if (block.is_queued && std::find(fragmented_.begin(), fragmented_.end(), b) == fragmented_.end())
            return "a block is marked as queued but is not in the queue";
        for (std::uint32_t k = 2 * b; k < 2 * b + 2; ++k) {
            boxes.clear();
            append(set(k), boxes);
            if (std::string broken = set(k).broken_invariant(boxes); !broken.empty()) return broken;
            for (const Move& m : boxes) {
                if (!contains(bounds_.box(k), m.box)) return "a box is outside the bounds of its set";
                if (!holds(m.proxy) || locations_[m.proxy].set != k) return "the location of a proxy is wrong";
                if (set(k).view().proxies[locations_[m.proxy].record] != m.proxy)
                    return "a proxy refers to a wrong record";
                const bool is_large = longest_side(m.box) > large_side_;
                if (planes_[is_large ? 1 : 0].empty()) return "a box is in no cell";
                const std::uint32_t home = planes_[is_large ? 1 : 0].cell_of(m.box);
                if (block.is_splitting ? !blocks_[home].is_split_target : home != b) return "a box is in a wrong block";
            }
        }
    }
    for (std::size_t p = 0; p < locations_.size(); ++p) stored += locations_[p].set != no_index ? 1 : 0;
    if (live != size_ || stored != size_) return "the boxes are miscounted";
    for (std::size_t k = 0; k < 2; ++k)
        if (std::string broken = planes_[k].broken_invariant(cells[k]); !broken.empty()) return broken;
    return {};
}

}  // namespace fase::broad
