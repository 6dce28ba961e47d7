/// How the wide tree follows its boxes: what waits for commit(), what is refitted, and when all is built anew.
#include "fase/broad/wide_bvh.hpp"

#include <algorithm>

#include "fase/broad/boxes/box_store.hpp"
#include "fase/core/detail/check.hpp"

namespace fase::broad {

using wide::leaf_bit;
using wide::none;
using wide::width;

void WideBvh::insert(Proxy p, const Aabb& box) {
    FASE_ASSERT(p < (none & ~leaf_bit));
    if (p >= spots_.size()) spots_.resize(p + std::size_t{1});
    FASE_ASSERT(spots_[p].where == Where::Nowhere);
    spots_[p].awake = true;
    put_in_list(p, box);
}

void WideBvh::move(Proxy p, const Aabb& box) {
    FASE_ASSERT(p < spots_.size() && spots_[p].where != Where::Nowhere);
    const Spot spot = spots_[p];
    if (spot.where == Where::Tree && is_regular(box)) {
        wide::Node& node = forest_.nodes[spot.at / width];
        if (node.box(spot.at % width) == box) return;
        node.set_box(spot.at % width, box);
        touch(spot.at / width);
    } else if (spot.where == Where::Tree) {
        take_from_tree(p);
        put_in_list(p, box);
    } else if (is_regular(box) == (spot.where == Where::Fresh)) {
        lists_[static_cast<int>(spot.where)][spot.at].box = box;
    } else {
        take_from_list(p);
        put_in_list(p, box);
    }
}

void WideBvh::erase(Proxy p) {
    FASE_ASSERT(p < spots_.size() && spots_[p].where != Where::Nowhere);
    resting_ -= spots_[p].awake ? 0 : 1;
    spots_[p].where == Where::Tree ? take_from_tree(p) : take_from_list(p);
    spots_[p] = {};
}

void WideBvh::set_awake(Proxy p, bool awake) {
    FASE_ASSERT(p < spots_.size() && spots_[p].where != Where::Nowhere);
    if (spots_[p].awake == awake) return;
    spots_[p].awake = awake;
    awake ? --resting_ : ++resting_;
    if (spots_[p].where == Where::Tree) set_awake_bit(spots_[p].at, awake);
}

void WideBvh::clear() {
    forest_.clear();
    spots_.clear();
    for (std::vector<Move>& list : lists_) list.clear();
    dirty_.clear();
    is_dirty_.clear();
    in_trees_ = in_smaller_ = resting_ = moved_ = 0;
    cost_ = min_cost_ = 0;
}

void WideBvh::build(std::span<const Move> boxes) {
    clear();
    for (const Move& m : boxes) insert(m.proxy, m.box);
    rebuild(settings_.filled);
}

void WideBvh::commit() {
    constexpr std::size_t smallest_limit = 256;
    const std::size_t fresh = lists_[0].size(), holes = forest_.holes.size();
    const std::size_t in_main = in_trees_ - in_smaller_;
    const auto limit = static_cast<std::size_t>(settings_.staged * static_cast<float>(in_main));
    const bool many_fresh =
        fresh > fresh_kept && in_smaller_ + fresh > std::min(in_main, std::max(smallest_limit, limit));
    if (many_fresh || holes > in_trees_ / 4 + smallest_limit) {
        rebuild(settings_.filled);
        return;
    }
    refit_moved();
    if (fresh > fresh_kept) rebuild_smaller();
    // A few boxes cannot spoil a tree, however far they go.
    if (moved_ > in_trees_ / 8 && cost_ > static_cast<double>(settings_.worst_growth) * min_cost_) {
        rebuild(settings_.spoilt);
        return;
    }
    std::sort(forest_.holes.begin(), forest_.holes.end());
}

void WideBvh::put_in_list(Proxy p, const Aabb& box) {
    const Where where = is_regular(box) ? Where::Fresh : Where::Odd;
    std::vector<Move>& list = lists_[static_cast<int>(where)];
    spots_[p].where = where;
    spots_[p].at = static_cast<std::uint32_t>(list.size());
    list.push_back({p, box});
}

void WideBvh::take_from_list(Proxy p) {
    std::vector<Move>& list = lists_[static_cast<int>(spots_[p].where)];
    const std::uint32_t at = spots_[p].at;
    list[at] = list.back();
    spots_[list[at].proxy].at = at;
    list.pop_back();
}

/// Leaves a hole in the ids until all is built anew.
void WideBvh::take_from_tree(Proxy p) {
    const wide::Place place = spots_[p].at;
    set_awake_bit(place, false);
    wide::Node& node = forest_.nodes[place / width];
    node.set_box(place % width, Aabb{});
    node.link[place % width] = none;
    forest_.holes.push_back(node.first[place % width]);
    touch(place / width);
    --in_trees_;
    if (place / width >= first_of_smaller()) --in_smaller_;
}

void WideBvh::touch(std::uint32_t node) {
    ++moved_;
    if (is_dirty_[node] != 0) return;
    is_dirty_[node] = 1;
    dirty_.push_back(node);
}

/// Goes up as long as a node begins or ends to have something awake.
void WideBvh::set_awake_bit(wide::Place place, bool awake) {
    for (; place != none; place = forest_.parents[place / width]) {
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

/// Until nothing changes any more.
void WideBvh::refit_upwards(std::uint32_t node) {
    for (wide::Place parent = forest_.parents[node]; parent != none; parent = forest_.parents[parent / width]) {
        wide::Node& above = forest_.nodes[parent / width];
        const Aabb before = above.box(parent % width), after = forest_.nodes[above.link[parent % width]].united();
        if (after == before) return;
        above.set_box(parent % width, after);
        const double was = wide::cost_of(before);
        cost_ += wide::cost_of(after) - was;
        if (was > 1e6 * cost_) cost_ = cost_from(0);  // what is left would be mostly rounding
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

/// All boxes from a node on, and those that wait, into items_.
void WideBvh::collect(std::uint32_t first_node) {
    items_.clear();
    for (std::size_t at = first_node; at < forest_.nodes.size(); ++at) {
        const wide::Node& node = forest_.nodes[at];
        for (std::uint32_t i = 0; i < width; ++i)
            if (node.is_leaf(i) && node.link[i] != none) items_.push_back({node.box(i), node.link[i] & ~leaf_bit});
    }
    for (const Move& m : lists_[0]) items_.push_back({m.box, m.proxy});
    lists_[0].clear();
}

/// A tree of items_ behind what is there; its boxes below the root have yet to be refitted.
void WideBvh::append_tree(Build how) {
    const auto begin = static_cast<std::uint32_t>(forest_.nodes.size());
    how == Build::Area ? wide::append_by_area(items_, forest_) : wide::append_by_morton(items_, forest_, scratch_);
    for (auto at = static_cast<std::uint32_t>(forest_.nodes.size()); at-- > begin;) {
        const wide::Node& node = forest_.nodes[at];
        std::uint32_t awake = 0;
        for (std::uint32_t i = 0; i < width; ++i) {
            if (node.link[i] == none) continue;
            if (node.is_leaf(i)) {
                Spot& spot = spots_[node.link[i] & ~leaf_bit];
                spot.where = Where::Tree;
                spot.at = wide::place_of(at, i);
                awake |= spot.awake ? 1u << i : 0;
            } else {
                awake |= forest_.awake[node.link[i]] != 0 ? 1u << i : 0;
            }
        }
        forest_.awake[at] = static_cast<std::uint8_t>(awake);
    }
    keep_spare_room();
}

void WideBvh::rebuild(Build how) {
    collect(0);
    forest_.clear();
    dirty_.clear();
    is_dirty_.clear();
    in_trees_ = items_.size();
    in_smaller_ = moved_ = 0;
    if (!items_.empty()) append_tree(how);
    cost_ = min_cost_ = wide::refit(forest_, 0);
    ++times_built_;
}

/// Nothing may be dirty.
void WideBvh::rebuild_smaller() {
    const std::uint32_t begin = first_of_smaller();
    const double before = cost_from(begin);
    collect(begin);
    in_trees_ += items_.size() - in_smaller_;
    in_smaller_ = items_.size();
    const std::uint32_t main_end = forest_.ends[0];
    forest_.nodes.resize(begin);
    forest_.parents.resize(begin);
    forest_.ends.resize(begin);
    forest_.awake.resize(begin);
    is_dirty_.resize(begin);
    forest_.ids.resize(main_end);
    forest_.roots.resize(1);
    std::erase_if(forest_.holes, [main_end](std::uint32_t hole) { return hole >= main_end; });
    append_tree(settings_.spoilt);
    const double change = wide::refit(forest_, begin) - before;
    cost_ = std::max(0.0, cost_ + change);
    min_cost_ = std::max(0.0, min_cost_ + change);
}

/// So that a tree with a few nodes more does not allocate.
void WideBvh::keep_spare_room() {
    if (forest_.nodes.capacity() < forest_.nodes.size() + forest_.nodes.size() / 8) {
        const std::size_t wanted = forest_.nodes.size() + forest_.nodes.size() / 4;
        forest_.nodes.reserve(wanted);
        forest_.parents.reserve(wanted);
        forest_.ends.reserve(wanted);
        forest_.awake.reserve(wanted);
        is_dirty_.reserve(wanted);
        dirty_.reserve(wanted);
    }
    is_dirty_.resize(forest_.nodes.size(), 0);
}

}  // namespace fase::broad
