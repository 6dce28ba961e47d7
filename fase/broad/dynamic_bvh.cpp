/// How the tree follows its boxes: what changes at once, what waits for commit(), and when all is built anew.
#include "fase/broad/dynamic_bvh.hpp"

#include <algorithm>

#include "fase/broad/boxes/box_store.hpp"
#include "fase/core/detail/check.hpp"

namespace fase::broad {
namespace {

float longest_side(const Aabb& box) {
    const Vec3 e = extent(box);
    return std::max(e.x, std::max(e.y, e.z));
}

/// NaN, the motion of a box that was none in between, counts as none.
float limited(float value, float limit) {
    return value < -limit ? -limit : value > limit ? limit : value == value ? value : 0;
}

}  // namespace

void DynamicBvh::insert(Proxy p, const Aabb& box) {
    FASE_ASSERT(p < leaf_bit);
    if (p >= entries_.size()) entries_.resize(p + std::size_t{1});
    FASE_ASSERT(entries_[p].place == Place::Nowhere);
    entries_[p].box = box;
    entries_[p].awake = true;
    if (is_regular(box)) {
        put_in_list(pending_, p, Place::Pending);
    } else {
        put_in_list(apart_, p, Place::Apart);
    }
}

void DynamicBvh::move(Proxy p, const Aabb& box) {
    FASE_ASSERT(p < entries_.size() && entries_[p].place != Place::Nowhere);
    Entry& entry = entries_[p];
    const Aabb before = entry.box;
    entry.box = box;
    if (entry.leaving) return;
    if (entry.place == Place::Pending) {
        if (is_regular(box)) return;
        take_from_list(pending_, p);
        put_in_list(apart_, p, Place::Apart);
        return;
    }
    const bool stays =
        entry.place == Place::Tree ? contains(nodes_[entry.where].box, box) && !is_empty(box) : !is_regular(box);
    if (stays) return;
    entry.leaving = true;
    leaving_.push_back({p, box.lo - before.lo});
}

void DynamicBvh::erase(Proxy p) {
    FASE_ASSERT(p < entries_.size() && entries_[p].place != Place::Nowhere);
    Entry& entry = entries_[p];
    switch (entry.place) {
        case Place::Nowhere: return;
        case Place::Pending: take_from_list(pending_, p); break;
        case Place::Apart: take_from_list(apart_, p); break;
        case Place::Tree: remove_leaf(entry.where); break;
    }
    resting_ -= entry.awake ? 0 : 1;
    entry.place = Place::Nowhere;
    entry.leaving = false;  // what leaving_ still says of it is skipped
    marks_old_ = true;
}

void DynamicBvh::set_awake(Proxy p, bool awake) {
    FASE_ASSERT(p < entries_.size() && entries_[p].place != Place::Nowhere);
    if (entries_[p].awake == awake) return;
    entries_[p].awake = awake;
    awake ? --resting_ : ++resting_;
    marks_old_ = true;
}

void DynamicBvh::clear() {
    nodes_.clear();
    free_.clear();
    entries_.clear();
    pending_.clear();
    apart_.clear();
    leaving_.clear();
    node_awake_.clear();
    leaf_count_ = 0;
    resting_ = 0;
    marks_old_ = false;
    changes_ = 0;
    cost_when_built_ = 0;
}

void DynamicBvh::build(std::span<const Move> boxes) {
    clear();
    for (const Move& m : boxes) insert(m.proxy, m.box);
    commit();
}

void DynamicBvh::commit() {
    if (!leaving_.empty() || !pending_.empty()) {
        follow_boxes();
        marks_old_ = true;
    }
    if (std::exchange(marks_old_, false)) mark_awake_nodes();
}

/// One pass from the bottom; nothing at all while everything is awake.
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

void DynamicBvh::follow_boxes() {
    sort_out_leaving();
    if (pending_.size() > leaf_count_ / 2) {
        leaving_.clear();
        rebuild();
        return;
    }
    changes_ += leaving_.size() + pending_.size();
    if (static_cast<float>(leaving_.size()) > settings_.crowd * static_cast<float>(leaf_count_) + 8) {
        for (const Leaving& one : leaving_) {
            const Entry& entry = entries_[one.proxy];
            nodes_[entry.where].box = grown(entry.box, settings_.crowd_margin * longest_side(entry.box));
        }
        refit_all();
    } else {
        for (const Leaving& one : leaving_) {
            remove_leaf(entries_[one.proxy].where);
            insert_leaf(one.proxy, fattened(one));
        }
    }
    leaving_.clear();
    for (const Proxy p : pending_) insert_leaf(p, entries_[p].box);
    pending_.clear();
    rebuild_if_spoilt();
}

/// Afterwards leaving_ names only boxes that are in the tree and may stay there; each once, its flag lowered.
void DynamicBvh::sort_out_leaving() {
    std::size_t kept = 0;
    for (const Leaving one : leaving_) {
        Entry& entry = entries_[one.proxy];
        if (!entry.leaving) continue;
        entry.leaving = false;
        if (is_regular(entry.box)) {
            if (entry.place == Place::Tree) {
                leaving_[kept++] = one;
            } else {
                take_from_list(apart_, one.proxy);
                put_in_list(pending_, one.proxy, Place::Pending);
            }
        } else if (entry.place == Place::Tree) {
            remove_leaf(entry.where);
            put_in_list(apart_, one.proxy, Place::Apart);
        }
    }
    leaving_.resize(kept);
}

/// The exact box, its margin, and what it will sweep if it goes on as it does; a leap counts as one side length.
Aabb DynamicBvh::fattened(const Leaving& leaving) const {
    const Aabb& box = entries_[leaving.proxy].box;
    const float side = longest_side(box);
    const Vec3 ahead{limited(settings_.motion * leaving.motion.x, side),
                     limited(settings_.motion * leaving.motion.y, side),
                     limited(settings_.motion * leaving.motion.z, side)};
    const Aabb swept = merge(box, {box.lo + ahead, box.hi + ahead});
    return grown(swept, settings_.margin * side);
}

void DynamicBvh::put_in_list(std::vector<Proxy>& list, Proxy p, Place place) {
    entries_[p].where = static_cast<std::uint32_t>(list.size());
    entries_[p].place = place;
    list.push_back(p);
}

void DynamicBvh::take_from_list(std::vector<Proxy>& list, Proxy p) {
    const std::uint32_t at = entries_[p].where;
    list[at] = list.back();
    entries_[list[at]].where = at;
    list.pop_back();
}

/// All inner nodes, children before parents, each rotated when that pays.
void DynamicBvh::refit_all() {
    order_.clear();
    LocalStack<Slot, 64> open;
    if (leaf_count_ > 1) open.push(root);
    while (!open.empty()) {
        const Slot at = open.pop(), left = nodes_[at].link;
        order_.push_back(at);
        if (!nodes_[left + 1].is_leaf()) open.push(left + 1);
        if (!nodes_[left].is_leaf()) open.push(left);
    }
    for (std::size_t i = order_.size(); i-- > 0;) {
        Node& node = nodes_[order_[i]];
        node.box = merged_children(node);
        rotate(order_[i]);
    }
}

/// A tree of all that is in the tree or waits for it, with exact boxes as leaves, in depth-first order.
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

/// Looks at the cost once for every size()/2 changes, so that looking costs O(1) a change.
void DynamicBvh::rebuild_if_spoilt() {
    if (leaf_count_ < 16 || changes_ < leaf_count_ / 2) return;
    changes_ = 0;
    if (cost() / static_cast<double>(leaf_count_) > settings_.worst_growth * cost_when_built_) rebuild();
}

}  // namespace fase::broad
