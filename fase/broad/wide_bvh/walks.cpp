/// Read-only functions of the wide tree: queries, all pairs, checks, drawing.
#include <algorithm>
#include <limits>

#include "fase/broad/boxes/box_store.hpp"
#include "fase/broad/wide_bvh.hpp"

namespace fase::broad {

using wide::leaf_bit;
using wide::width;

namespace {

/// Visits the boxes in the trees that overlap `box`. Clamps it to finite bounds, which unused children do not overlap.
bool traverse_trees(const wide::Forest& forest, const Aabb& box, wide::VisitOverlap visit) {
    for (int axis = 0; axis < 3; ++axis)
        if (std::isnan(box.lo[axis]) || std::isnan(box.hi[axis])) return true;
    constexpr float largest = std::numeric_limits<float>::max();
    return wide::traverse(
        forest, {max(box.lo, {-largest, -largest, -largest}), min(box.hi, {largest, largest, largest})}, visit);
}

}  // namespace

void WideBvh::traverse(const BoxRegion& region, wide::VisitOverlap visit) const {
    if (traverse_lists(region, visit)) traverse_trees(forest_, region.box, visit);
}

void WideBvh::nearest_first(const RayMeasure& measure, float limit, wide::VisitNear visit) const {
    limit = nearest_in_lists(measure, limit, visit);
    if (limit < 0) return;
    wide::fits_float(measure) ? wide::nearest_first(forest_, measure, limit, visit)
                              : nearest_below(measure, limit, visit);
}

void WideBvh::nearest_first(const PointMeasure& measure, float limit, wide::VisitNear visit) const {
    limit = nearest_in_lists(measure, limit, visit);
    if (limit < 0) return;
    wide::fits_float(measure) ? wide::nearest_first(forest_, measure, limit, visit)
                              : nearest_below(measure, limit, visit);
}

void WideBvh::cull(const FrustumRegion& region, wide::TakeRange take) const {
    traverse_lists(region, [&](Proxy p, const Aabb& box) {
        take(std::span<const Proxy>(&p, 1), region.contains(box));
        return true;
    });
    wide::cull(forest_, region, take);
}

/// Finds the pairs with a box in a list.
void WideBvh::find_listed_pairs(bool awake_only, PairSink& sink) const {
    const auto add = [&](Proxy p, Proxy q) {
        if (!awake_only || locations_[p].awake || locations_[q].awake) sink.add(p, q);
    };
    for (int kind = 0; kind < 2; ++kind) {
        for (std::size_t i = 0; i < lists_[kind].size(); ++i) {
            const Move mine = lists_[kind][i];
            for (int other = kind; other < 2; ++other) {
                for (std::size_t k = other == kind ? i + 1 : 0; k < lists_[other].size(); ++k)
                    if (overlaps(mine.box, lists_[other][k].box)) add(mine.proxy, lists_[other][k].proxy);
            }
            traverse_trees(forest_, mine.box, [&](Proxy q, const Aabb&) {
                add(mine.proxy, q);
                return true;
            });
        }
    }
}

namespace {

/// Calls `start(pair)` for each root with itself and with each later root.
template <class Start> void for_each_root_pair(const wide::Forest& forest, Start&& start) {
    for (std::size_t i = 0; i < forest.roots.size(); ++i)
        for (std::size_t k = i; k < forest.roots.size(); ++k) start(wide::NodePair{forest.roots[i], forest.roots[k]});
}

}  // namespace

void WideBvh::find_pairs(std::vector<Pair>& out) const {
    PairSink sink(out);
    find_listed_pairs(false, sink);
    for_each_root_pair(forest_, [&](wide::NodePair start) { wide::find_pairs(forest_, forest_, start, false, sink); });
}

void WideBvh::find_awake_pairs(std::vector<Pair>& out) const {
    if (resting_ == 0) return find_pairs(out);
    PairSink sink(out);
    find_listed_pairs(true, sink);
    for_each_root_pair(forest_, [&](wide::NodePair start) { wide::find_pairs(forest_, forest_, start, true, sink); });
}

void WideBvh::find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const {
    constexpr std::size_t min_parts = 512;
    PairSink sink(out);
    find_listed_pairs(false, sink);
    std::vector<wide::NodePair> parts, next;  // together always the complete descent, in finer and finer parts
    for_each_root_pair(forest_, [&](wide::NodePair start) { parts.push_back(start); });
    while (!parts.empty() && parts.size() < min_parts) {
        next.clear();
        for (const wide::NodePair& part : parts) wide::expand_pair(forest_, forest_, part, sink, next);
        parts.swap(next);
    }
    sink.flush();
    std::vector<std::vector<Pair>> found(parts.size());
    run_chunks(tasks, parts.size(), [&](std::size_t i) {
        PairSink part_sink(found[i]);
        wide::find_pairs(forest_, forest_, parts[i], false, part_sink);
    });
    for (const std::vector<Pair>& part : found) out.insert(out.end(), part.begin(), part.end());
}

void WideBvh::find_pairs_with(const WideBvh& other, std::vector<Pair>& out) const {
    if (&other == this) return find_pairs(out);
    PairSink sink(out);
    for (const std::vector<Move>& list : lists_) {
        for (const Move& mine : list) {
            other.traverse(BoxRegion{mine.box}, [&](Proxy q, const Aabb&) {
                if (mine.proxy != q) sink.add(mine.proxy, q);
                return true;
            });
        }
    }
    for (const std::vector<Move>& list : other.lists_) {
        for (const Move& theirs : list) {
            traverse_trees(forest_, theirs.box, [&](Proxy p, const Aabb&) {
                if (p != theirs.proxy) sink.add(p, theirs.proxy);
                return true;
            });
        }
    }
    for (const std::uint32_t a : forest_.roots)
        for (const std::uint32_t b : other.forest_.roots) wide::find_pairs(forest_, other.forest_, {a, b}, false, sink);
}

std::size_t WideBvh::bytes() const {
    return sizeof(*this) + forest_.bytes() + locations_.capacity() * sizeof(Location) +
           (lists_[0].capacity() + lists_[1].capacity()) * sizeof(Move) + dirty_.capacity() * sizeof(std::uint32_t) +
           is_dirty_.capacity() + items_.capacity() * sizeof(BuildItem) +
           scratch_.sorted.capacity() * sizeof(BuildItem) +
           (scratch_.keys.capacity() + scratch_.scratch_keys.capacity()) * sizeof(MortonKey);
}

void WideBvh::cells(std::vector<DrawnCell>& out) const {
    struct Level {
        std::uint32_t node;
        int depth;
    };
    LocalStack<Level, 256> open;
    for (std::size_t i = forest_.roots.size(); i-- > 0;) open.push({forest_.roots[i], 0});
    while (!open.empty()) {
        const Level at = open.pop();
        const wide::Node& node = forest_.nodes[at.node];
        if (const Aabb box = node.merged(); !is_empty(box)) out.push_back({box, at.depth});
        for (std::uint32_t i = width; i-- > 0;)
            if (!node.is_leaf(i)) open.push({node.link[i], at.depth + 1});
    }
}

std::string WideBvh::broken_invariant() const {
    for (int kind = 0; kind < 2; ++kind) {
        for (std::size_t i = 0; i < lists_[kind].size(); ++i) {
            const Move& m = lists_[kind][i];
            if (m.proxy >= locations_.size() || locations_[m.proxy].where != static_cast<Where>(kind) ||
                locations_[m.proxy].at != i)
                return "a listed box is not where its proxy points";
            if (is_regular(m.box) != (kind == 0)) return "a box is in the wrong list";
        }
    }
    std::size_t stored = 0, resting = 0;
    for (const Location& location : locations_) {
        stored += location.where != Where::None ? 1 : 0;
        resting += location.where != Where::None && !location.awake ? 1 : 0;
    }
    if (stored != size()) return "a proxy points to a missing box";
    if (resting != resting_) return "the number of sleeping boxes is wrong";
    return broken_tree();
}

std::string WideBvh::broken_tree() const {
    const std::size_t count = forest_.nodes.size();
    if (forest_.parents.size() != count || forest_.ends.size() != count || forest_.awake.size() != count ||
        is_dirty_.size() != count)
        return "the arrays of nodes differ in length";
    if (forest_.ids.size() != in_trees_ + forest_.free_slots.size()) return "the number of ids is wrong";
    std::vector<std::uint32_t> free_slots = forest_.free_slots;
    std::sort(free_slots.begin(), free_slots.end());
    if (std::adjacent_find(free_slots.begin(), free_slots.end()) != free_slots.end()) return "a slot is counted twice";
    if (dirty_.empty() && free_slots != forest_.free_slots) return "the free slots are not in order";
    LocalStack<std::uint32_t, 256> open;
    for (std::size_t i = forest_.roots.size(); i-- > 0;) {
        if (forest_.parents[forest_.roots[i]] != no_index) return "a root has a parent";
        open.push(forest_.roots[i]);
    }
    std::uint32_t next = 0, boxes = 0;
    while (!open.empty()) {
        const std::uint32_t index = open.pop();
        if (index != next++) return "the nodes are not in depth-first order";
        if (std::string broken = broken_node(index); !broken.empty()) return broken;
        for (std::uint32_t i = width; i-- > 0;) {
            if (!forest_.nodes[index].is_leaf(i)) open.push(forest_.nodes[index].link[i]);
            boxes += forest_.nodes[index].is_leaf(i) && forest_.nodes[index].link[i] != no_index ? 1 : 0;
        }
    }
    if (next != count) return "a node is lost";
    if (boxes != in_trees_) return "a box is lost";
    const double cost = cost_from(0);
    if (dirty_.empty() && !(std::abs(cost - cost_) <= 1e-6 * cost + 1e-300)) return "the cost is out of date";
    return {};
}

std::string WideBvh::broken_node(std::uint32_t index) const {
    const wide::Node& node = forest_.nodes[index];
    std::uint32_t begin = node.first[0];
    for (std::uint32_t i = 0; i < width; ++i) {
        if (node.first[i] != begin || forest_.end_of(index, i) < begin)
            return "the box ranges of the children have gaps";
        begin = forest_.end_of(index, i);
        const bool awake = (forest_.awake[index] >> i & 1) != 0;
        if (node.link[i] == no_index) {
            if (!(node.box(i) == Aabb{}) || awake) return "an unused child is not empty";
        } else if (node.is_leaf(i)) {
            const Proxy p = node.link[i] & ~leaf_bit;
            if (p >= locations_.size() || locations_[p].where != Where::Tree ||
                locations_[p].at != wide::place_of(index, i))
                return "a box is not where its proxy points";
            if (forest_.ids[node.first[i]] != p) return "the ids are not in the order of the tree";
            if (!is_regular(node.box(i))) return "an unbounded box is in a tree";
            if (awake != locations_[p].awake) return "the awake bit of a box is wrong";
        } else {
            const std::uint32_t child = node.link[i];
            if (child <= index || child >= forest_.nodes.size()) return "a child is at an invalid index";
            if (forest_.parents[child] != wide::place_of(index, i)) return "a child has a wrong parent";
            if (forest_.nodes[child].first[0] != node.first[i] || forest_.ends[child] != begin)
                return "the box ranges of a child and its parent differ";
            if (awake != (forest_.awake[child] != 0)) return "the awake bit of a child is wrong";
            if (dirty_.empty() && !(forest_.nodes[child].merged() == node.box(i)))
                return "an inner node is not the union of its children";
        }
    }
    if (begin != forest_.ends[index]) return "the end of the box range of a node is wrong";
    return {};
}

}  // namespace fase::broad
