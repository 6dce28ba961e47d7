/// Updates of the wide tree: staging, refits and rebuilds.
#include "fase/broad/wide_bvh.hpp"

#include <algorithm>

#include "fase/broad/boxes/box_store.hpp"
#include "fase/core/detail/check.hpp"
#include "fase/core/detail/prefetch.hpp"

namespace fase::broad {

using wide::leaf_bit;
using wide::width;

void WideBvh::insert(Proxy p, const Aabb& box) {
    FASE_ASSERT(p < (no_index & ~leaf_bit));
    if (p >= locations_.size()) locations_.resize(p + std::size_t{1});
    FASE_ASSERT(locations_[p].where == Where::None);
    locations_[p].awake = true;
    add_to_list(p, box);
}

void WideBvh::move(Proxy p, const Aabb& box) {
    FASE_ASSERT(p < locations_.size() && locations_[p].where != Where::None);
    const Location location = locations_[p];
    if (location.where == Where::Tree && is_regular(box)) {
        wide::Node& node = forest_.nodes[location.at / width];
        if (node.box(location.at % width) == box) return;
        node.set_box(location.at % width, box);
        mark_dirty(location.at / width);
    } else if (location.where == Where::Tree) {
        remove_from_tree(p);
        add_to_list(p, box);
    } else if (is_regular(box) == (location.where == Where::Staged)) {
        lists_[static_cast<int>(location.where)][location.at].box = box;
    } else {
        remove_from_list(p);
        add_to_list(p, box);
    }
}

template <class ProxyOf, class BoxOf>
void WideBvh::move_all(std::size_t count, const ProxyOf& proxy_of, const BoxOf& box_of) {
    constexpr std::size_t ahead = 16;
    for (std::size_t k = 0; k < count; ++k) {
        if (k + 2 * ahead < count) {
            detail::prefetch(locations_[proxy_of(k + 2 * ahead)]);
            const Location& soon = locations_[proxy_of(k + ahead)];
            if (soon.where == Where::Tree) detail::prefetch(forest_.nodes[soon.at / width].plane);
        }
        move(proxy_of(k), box_of(k));
    }
}

void WideBvh::move(TaskRunner*, std::span<const Proxy> proxies, std::span<const Aabb> by_proxy) {
    move_all(
        proxies.size(), [=](std::size_t k) { return proxies[k]; },
        [=](std::size_t k) -> const Aabb& { return by_proxy[proxies[k]]; });
}

void WideBvh::move(TaskRunner*, std::span<const Move> moves) {
    move_all(
        moves.size(), [=](std::size_t k) { return moves[k].proxy; },
        [=](std::size_t k) -> const Aabb& { return moves[k].box; });
}

void WideBvh::erase(Proxy p) {
    FASE_ASSERT(p < locations_.size() && locations_[p].where != Where::None);
    resting_ -= locations_[p].awake ? 0 : 1;
    locations_[p].where == Where::Tree ? remove_from_tree(p) : remove_from_list(p);
    locations_[p] = {};
}

void WideBvh::set_awake(Proxy p, bool awake) {
    FASE_ASSERT(p < locations_.size() && locations_[p].where != Where::None);
    if (locations_[p].awake == awake) return;
    locations_[p].awake = awake;
    awake ? --resting_ : ++resting_;
    if (locations_[p].where == Where::Tree) set_awake_bit(locations_[p].at, awake);
}

void WideBvh::clear() {
    forest_.clear();
    locations_.clear();
    for (std::vector<Move>& list : lists_) list.clear();
    dirty_.clear();
    is_dirty_.clear();
    in_trees_ = in_secondary_ = resting_ = moved_ = 0;
    cost_ = min_cost_ = 0;
}

void WideBvh::build(std::span<const Move> boxes) {
    clear();
    for (const Move& m : boxes) insert(m.proxy, m.box);
    rebuild(settings_.build_method);
}

void WideBvh::commit() {
    constexpr std::size_t smallest_limit = 256;
    const std::size_t staged = lists_[0].size(), free_slots = forest_.free_slots.size();
    const std::size_t in_primary = in_trees_ - in_secondary_;
    const auto limit = static_cast<std::size_t>(settings_.staged * static_cast<float>(in_primary));
    const bool too_many_staged =
        staged > max_listed && in_secondary_ + staged > std::min(in_primary, std::max(smallest_limit, limit));
    if (too_many_staged || free_slots > in_trees_ / 4 + smallest_limit) {
        rebuild(settings_.build_method);
        return;
    }
    refit_moved();
    if (staged > max_listed) rebuild_secondary();
    // A few moved boxes do not degrade a tree, at any distance.
    if (moved_ > in_trees_ / 8 && cost_ > static_cast<double>(settings_.max_growth) * min_cost_) {
        rebuild(settings_.rebuild_method);
        return;
    }
    std::sort(forest_.free_slots.begin(), forest_.free_slots.end());
}

void WideBvh::add_to_list(Proxy p, const Aabb& box) {
    const Where where = is_regular(box) ? Where::Staged : Where::Unbounded;
    std::vector<Move>& list = lists_[static_cast<int>(where)];
    locations_[p].where = where;
    locations_[p].at = static_cast<std::uint32_t>(list.size());
    list.push_back({p, box});
}

void WideBvh::remove_from_list(Proxy p) {
    std::vector<Move>& list = lists_[static_cast<int>(locations_[p].where)];
    const std::uint32_t at = locations_[p].at;
    list[at] = list.back();
    locations_[list[at].proxy].at = at;
    list.pop_back();
}

/// Leaves a free slot in the ids until the next rebuild.
void WideBvh::remove_from_tree(Proxy p) {
    const wide::Place place = locations_[p].at;
    set_awake_bit(place, false);
    wide::Node& node = forest_.nodes[place / width];
    node.set_box(place % width, Aabb{});
    node.link[place % width] = no_index;
    forest_.free_slots.push_back(node.first[place % width]);
    mark_dirty(place / width);
    --in_trees_;
    if (place / width >= secondary_begin()) --in_secondary_;
}

void WideBvh::mark_dirty(std::uint32_t node) {
    ++moved_;
    if (is_dirty_[node] != 0) return;
    is_dirty_[node] = 1;
    dirty_.push_back(node);
}

/// Propagates upward while the awake state of a node changes.
void WideBvh::set_awake_bit(wide::Place place, bool awake) {
    for (; place != no_index; place = forest_.parents[place / width]) {
        std::uint8_t& bits = forest_.awake[place / width];
        const bool any_before = bits != 0;
        const auto bit = static_cast<std::uint8_t>(1u << (place % width));
        bits = static_cast<std::uint8_t>(awake ? bits | bit : bits & ~bit);
        if (any_before == (bits != 0)) return;
    }
}

void WideBvh::refit_moved() {
    if (8 * dirty_.size() > forest_.nodes.size()) {
        cost_ = wide::refit(forest_, 0);
    } else {
        for (const std::uint32_t node : dirty_) refit_upwards(node);
    }
    for (const std::uint32_t node : dirty_) is_dirty_[node] = 0;
    dirty_.clear();
    min_cost_ = std::min(min_cost_, cost_);
}

/// Refits the ancestors until one does not change.
void WideBvh::refit_upwards(std::uint32_t node) {
    for (wide::Place parent = forest_.parents[node]; parent != no_index; parent = forest_.parents[parent / width]) {
        wide::Node& above = forest_.nodes[parent / width];
        const Aabb before = above.box(parent % width), after = forest_.nodes[above.link[parent % width]].merged();
        if (after == before) return;
        above.set_box(parent % width, after);
        const double cost_before = wide::cost_of(before);
        cost_ += wide::cost_of(after) - cost_before;
        if (cost_before > 1e6 * cost_) cost_ = cost_from(0);  // cancellation: the difference is mostly rounding error
    }
}

double WideBvh::cost_from(std::uint32_t node) const {
    double cost = 0;
    for (std::size_t at = forest_.nodes.size(); at-- > node;) {
        for (std::uint32_t i = 0; i < width; ++i)
            if (!forest_.nodes[at].is_leaf(i)) cost += wide::cost_of(forest_.nodes[at].box(i));
    }
    return cost;
}

/// Collects the boxes of all nodes from `first_node` on, and the staged boxes, in items_.
void WideBvh::collect(std::uint32_t first_node) {
    items_.clear();
    for (std::size_t at = first_node; at < forest_.nodes.size(); ++at) {
        const wide::Node& node = forest_.nodes[at];
        for (std::uint32_t i = 0; i < width; ++i)
            if (node.is_leaf(i) && node.link[i] != no_index) items_.push_back({node.box(i), node.link[i] & ~leaf_bit});
    }
    for (const Move& m : lists_[0]) items_.push_back({m.box, m.proxy});
    lists_[0].clear();
}

/// Appends a tree of items_ to the forest; its inner boxes must be refitted afterwards.
void WideBvh::append_tree(Build how) {
    const auto begin = static_cast<std::uint32_t>(forest_.nodes.size());
    how == Build::Area ? wide::append_by_area(items_, forest_) : wide::append_by_morton(items_, forest_, scratch_);
    for (auto at = static_cast<std::uint32_t>(forest_.nodes.size()); at-- > begin;) {
        const wide::Node& node = forest_.nodes[at];
        std::uint32_t awake = 0;
        for (std::uint32_t i = 0; i < width; ++i) {
            if (node.link[i] == no_index) continue;
            if (node.is_leaf(i)) {
                Location& location = locations_[node.link[i] & ~leaf_bit];
                location.where = Where::Tree;
                location.at = wide::place_of(at, i);
                awake |= location.awake ? 1u << i : 0;
            } else {
                awake |= forest_.awake[node.link[i]] != 0 ? 1u << i : 0;
            }
        }
        forest_.awake[at] = static_cast<std::uint8_t>(awake);
    }
    reserve_spare_nodes();
}

void WideBvh::rebuild(Build how) {
    collect(0);
    forest_.clear();
    dirty_.clear();
    is_dirty_.clear();
    in_trees_ = items_.size();
    in_secondary_ = moved_ = 0;
    if (!items_.empty()) append_tree(how);
    cost_ = min_cost_ = wide::refit(forest_, 0);
    ++build_count_;
}

/// Requires that no node is dirty.
void WideBvh::rebuild_secondary() {
    const std::uint32_t begin = secondary_begin();
    const double before = cost_from(begin);
    collect(begin);
    in_trees_ += items_.size() - in_secondary_;
    in_secondary_ = items_.size();
    const std::uint32_t primary_end = forest_.ends[0];
    forest_.nodes.resize(begin);
    forest_.parents.resize(begin);
    forest_.ends.resize(begin);
    forest_.awake.resize(begin);
    is_dirty_.resize(begin);
    forest_.ids.resize(primary_end);
    forest_.roots.resize(1);
    std::erase_if(forest_.free_slots, [primary_end](std::uint32_t slot) { return slot >= primary_end; });
    append_tree(settings_.rebuild_method);
    const double change = wide::refit(forest_, begin) - before;
    cost_ = std::max(0.0, cost_ + change);
    min_cost_ = std::max(0.0, min_cost_ + change);
}

/// Reserves capacity, so that a tree with a few more nodes does not allocate.
void WideBvh::reserve_spare_nodes() {
    if (forest_.nodes.capacity() < forest_.nodes.size() + forest_.nodes.size() / 8) {
        const std::size_t capacity = forest_.nodes.size() + forest_.nodes.size() / 4;
        forest_.nodes.reserve(capacity);
        forest_.parents.reserve(capacity);
        forest_.ends.reserve(capacity);
        forest_.awake.reserve(capacity);
        is_dirty_.reserve(capacity);
        dirty_.reserve(capacity);
    }
    is_dirty_.resize(forest_.nodes.size(), 0);
}

}  // namespace fase::broad
