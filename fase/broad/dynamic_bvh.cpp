/// Updates of the tree: immediate changes, changes deferred to commit(), and rebuilds.
#include "fase/broad/dynamic_bvh.hpp"

#include <algorithm>

#include "fase/broad/boxes/box_store.hpp"
#include "fase/core/detail/check.hpp"

namespace fase::broad {
namespace {

/// Clamps to [-limit, limit]; NaN, from the motion of a box that was NaN, gives 0.
float clamped(float value, float limit) {
    return value < -limit ? -limit : value > limit ? limit : value == value ? value : 0;
}

}  // namespace

void DynamicBvh::insert(Proxy p, const Aabb& box) {
    FASE_ASSERT(p < leaf_bit);
    if (p >= entries_.size()) entries_.resize(p + std::size_t{1});
    FASE_ASSERT(entries_[p].place == Place::None);
    entries_[p].box = box;
    entries_[p].awake = true;
    if (is_regular(box)) {
        add_to_list(pending_, p, Place::Pending);
    } else {
        add_to_list(unbounded_, p, Place::Unbounded);
    }
}

void DynamicBvh::move(Proxy p, const Aabb& box) {
    FASE_ASSERT(p < entries_.size() && entries_[p].place != Place::None);
    Entry& entry = entries_[p];
    const Aabb before = entry.box;
    entry.box = box;
    if (entry.escaped) return;
    if (entry.place == Place::Pending) {
        if (is_regular(box)) return;
        remove_from_list(pending_, p);
        add_to_list(unbounded_, p, Place::Unbounded);
        return;
    }
    const bool stays =
        entry.place == Place::Tree ? contains(nodes_[entry.where].box, box) && !is_empty(box) : !is_regular(box);
    if (stays) return;
    entry.escaped = true;
    escaped_.push_back({p, box.lo - before.lo});
}

void DynamicBvh::erase(Proxy p) {
    FASE_ASSERT(p < entries_.size() && entries_[p].place != Place::None);
    Entry& entry = entries_[p];
    switch (entry.place) {
        case Place::None: return;
        case Place::Pending: remove_from_list(pending_, p); break;
        case Place::Unbounded: remove_from_list(unbounded_, p); break;
        case Place::Tree: remove_leaf(entry.where); break;
    }
    resting_ -= entry.awake ? 0 : 1;
    entry.place = Place::None;
    entry.escaped = false;  // its entry in escaped_ is skipped
    marks_stale_ = true;
}

void DynamicBvh::set_awake(Proxy p, bool awake) {
    FASE_ASSERT(p < entries_.size() && entries_[p].place != Place::None);
    if (entries_[p].awake == awake) return;
    entries_[p].awake = awake;
    awake ? --resting_ : ++resting_;
    marks_stale_ = true;
}

void DynamicBvh::clear() {
    nodes_.clear();
    free_.clear();
    entries_.clear();
    pending_.clear();
    unbounded_.clear();
    escaped_.clear();
    node_awake_.clear();
    leaf_count_ = 0;
    resting_ = 0;
    marks_stale_ = false;
    changes_ = 0;
    cost_when_built_ = 0;
}

void DynamicBvh::build(std::span<const Move> boxes) {
    clear();
    for (const Move& m : boxes) insert(m.proxy, m.box);
    commit();
}

void DynamicBvh::commit() {
    if (!escaped_.empty() || !pending_.empty()) {
        apply_moves();
        marks_stale_ = true;
    }
    if (std::exchange(marks_stale_, false)) mark_awake_nodes();
}

/// Marks the ancestors of awake leaves. Clears the marks while all boxes are awake.
void DynamicBvh::mark_awake_nodes() {
    node_awake_.clear();
    if (resting_ == 0 || leaf_count_ == 0) return;
    node_awake_.resize(nodes_.size(), 0);
    for (const Entry& entry : entries_) {
        if (entry.place != Place::Tree || !entry.awake) continue;
        for (Slot at = entry.where; node_awake_[at] == 0; at = nodes_[at].parent) {
            node_awake_[at] = 1;
            if (at == root) break;
        }
    }
}

void DynamicBvh::apply_moves() {
    filter_escaped();
    if (pending_.size() > leaf_count_ / 2) {
        escaped_.clear();
        rebuild();
        return;
    }
    changes_ += escaped_.size() + pending_.size();
    if (static_cast<float>(escaped_.size()) > settings_.refit_share * static_cast<float>(leaf_count_) + 8) {
        for (const Escaped& one : escaped_) {
            const Entry& entry = entries_[one.proxy];
            nodes_[entry.where].box = enlarged(entry.box, settings_.refit_margin * longest_side(entry.box));
        }
        refit_all();
    } else {
        for (const Escaped& one : escaped_) {
            remove_leaf(entries_[one.proxy].where);
            insert_leaf(one.proxy, fattened(one));
        }
    }
    escaped_.clear();
    for (const Proxy p : pending_) insert_leaf(p, entries_[p].box);
    pending_.clear();
    rebuild_if_degraded();
}

/// Reduces escaped_ to boxes that are in the tree and remain there, each once; moves the others to the right list.
/// Clears their flags.
void DynamicBvh::filter_escaped() {
    std::size_t kept = 0;
    for (const Escaped one : escaped_) {
        Entry& entry = entries_[one.proxy];
        if (!entry.escaped) continue;
        entry.escaped = false;
        if (is_regular(entry.box)) {
            if (entry.place == Place::Tree) {
                escaped_[kept++] = one;
            } else {
                remove_from_list(unbounded_, one.proxy);
                add_to_list(pending_, one.proxy, Place::Pending);
            }
        } else if (entry.place == Place::Tree) {
            remove_leaf(entry.where);
            add_to_list(unbounded_, one.proxy, Place::Unbounded);
        }
    }
    escaped_.resize(kept);
}

/// Returns the fat AABB: the exact box with its predicted sweep and a margin. The sweep is clamped to one side length.
Aabb DynamicBvh::fattened(const Escaped& escaped) const {
    const Aabb& box = entries_[escaped.proxy].box;
    const float side = longest_side(box);
    const Vec3 ahead{clamped(settings_.motion * escaped.motion.x, side),
                     clamped(settings_.motion * escaped.motion.y, side),
                     clamped(settings_.motion * escaped.motion.z, side)};
    const Aabb swept = merge(box, {box.lo + ahead, box.hi + ahead});
    return enlarged(swept, settings_.margin * side);
}

void DynamicBvh::add_to_list(std::vector<Proxy>& list, Proxy p, Place place) {
    entries_[p].where = static_cast<std::uint32_t>(list.size());
    entries_[p].place = place;
    list.push_back(p);
}

void DynamicBvh::remove_from_list(std::vector<Proxy>& list, Proxy p) {
    const std::uint32_t at = entries_[p].where;
    list[at] = list.back();
    entries_[list[at]].where = at;
    list.pop_back();
}

/// Refits all inner nodes, children before parents, and rotates each where that reduces the surface.
void DynamicBvh::refit_all() {
    refit_order_.clear();
    LocalStack<Slot, 64> open;
    if (leaf_count_ > 1) open.push(root);
    while (!open.empty()) {
        const Slot at = open.pop(), left = nodes_[at].link;
        refit_order_.push_back(at);
        if (!nodes_[left + 1].is_leaf()) open.push(left + 1);
        if (!nodes_[left].is_leaf()) open.push(left);
    }
    for (std::size_t i = refit_order_.size(); i-- > 0;) {
        Node& node = nodes_[refit_order_[i]];
        node.box = merged_children(node);
        rotate(refit_order_[i]);
    }
}

/// Rebuilds the tree from all stored and pending boxes, with exact boxes as leaves, in depth-first order.
void DynamicBvh::rebuild() {
    items_.clear();
    Aabb bounds;
    for (Proxy p = 0; p < entries_.size(); ++p) {
        const Entry& entry = entries_[p];
        if (entry.place != Place::Tree && entry.place != Place::Pending) continue;
        items_.push_back({entry.box, p});
        bounds = merge(bounds, entry.box);
    }
    pending_.clear();
    free_.clear();
    nodes_.clear();
    changes_ = 0;
    leaf_count_ = items_.size();
    if (items_.empty()) return;
    nodes_.reserve(2 * items_.size());
    nodes_.resize(2);
    struct Range {
        Slot slot;
        std::size_t first, count;
        Aabb bounds;
    };
    LocalStack<Range, 64> open;
    open.push({root, 0, items_.size(), bounds});
    while (!open.empty()) {
        const Range range = open.pop();
        const auto items = std::span(items_).subspan(range.first, range.count);
        if (range.count == 1) {
            set_content(range.slot, items[0].box, leaf_bit | items[0].proxy);
            entries_[items[0].proxy].place = Place::Tree;
            continue;
        }
        const Split split = split_by_binned_area(items);
        const auto pair = static_cast<Slot>(nodes_.size());
        nodes_.resize(nodes_.size() + 2);
        set_content(range.slot, range.bounds, pair);
        open.push({pair + 1, range.first + split.left_count, range.count - split.left_count, split.right});
        open.push({pair, range.first, split.left_count, split.left});
    }
    cost_when_built_ = cost() / static_cast<double>(leaf_count_);
}

/// Checks the cost once per size()/2 changes, so that the check costs O(1) per change.
void DynamicBvh::rebuild_if_degraded() {
    if (leaf_count_ < 16 || changes_ < leaf_count_ / 2) return;
    changes_ = 0;
    if (cost() / static_cast<double>(leaf_count_) > settings_.max_growth * cost_when_built_) rebuild();
}

}  // namespace fase::broad
