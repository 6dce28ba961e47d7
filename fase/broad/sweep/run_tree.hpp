#pragma once
/// A tree over a sorted list of boxes: bounds of each run of 64 boxes, of each eight runs, and so on.
#include <array>
#include <concepts>

#include "fase/broad/boxes/box_scan.hpp"
#include "fase/broad/boxes/local_stack.hpp"

namespace fase::broad {

/// An implicit tree: the indices of boxes, runs and branches follow from each other by division. Its quality depends on
/// the order of the boxes, which must be regular (see BoxStore). All const calls are thread-safe.
class RunTree {
public:
    static constexpr std::size_t run = 64;  ///< boxes in a leaf
    static constexpr std::size_t fan = 8;   ///< children of a branch

    /// Resizes to `count` boxes; existing boxes stay. Call put() for the new ones, then close().
    void resize(std::size_t count) { boxes_.resize(count); }
    void put(std::size_t at, Proxy p, const Aabb& box) { boxes_.put(at, p, box); }
    /// Computes all bounds. O(n).
    void close();
    /// close() after only the boxes at the indices `changed` have changed. O(changed).
    void refit(std::span<const std::uint32_t> changed);

    [[nodiscard]] const BoxColumns& boxes() const { return boxes_; }
    [[nodiscard]] std::size_t size() const { return boxes_.size(); }
    /// Bounds of all boxes; the empty box when there is none.
    [[nodiscard]] const Aabb& bounds() const { return bounds_.back(); }
    [[nodiscard]] std::size_t runs() const { return (size() + run - 1) / run; }
    [[nodiscard]] const Aabb& run_box(std::size_t i) const { return bounds_[i]; }
    [[nodiscard]] std::size_t nodes() const { return bounds_.size(); }
    [[nodiscard]] std::size_t bytes() const { return boxes_.bytes() + bounds_.capacity() * sizeof(Aabb); }
    [[nodiscard]] std::string broken_invariant() const;

    /// Structure::traverse(); false when `visit` returned false.
    template <Region R, class Visit> bool traverse(const R& region, Visit&& visit) const;
    /// broad::nearest_first(); lowers `limit` to the results of `visit`. False when it fell below 0.
    template <Measure M, class Visit> bool nearest_first(const M& measure, float& limit, Visit&& visit) const;
    template <SolidRegion R, class Take> void cull(const R& region, Take&& take) const;
    template <class Visit> void for_each_leaf(Visit&& visit) const {
        for (std::size_t i = 0; i < runs(); ++i)
            visit(Leaf{bounds_[i], proxies_below({0, i}), static_cast<int>(levels_) - 1});
    }
    void cells(std::vector<DrawnCell>& out) const;

private:
    static constexpr std::size_t max_levels = 12;
    /// Level 0 contains the runs; the last level contains only the root.
    struct Node {
        std::size_t level = 0, at = 0;
    };

    BoxColumns boxes_;
    std::vector<Aabb> bounds_ = std::vector<Aabb>(1);         // bounds, level by level, the runs first
    std::array<std::size_t, max_levels + 1> first_ = {0, 1};  // by level: its first index in bounds_; then the end
    std::size_t levels_ = 1;

    [[nodiscard]] Aabb bounds_of_run(std::size_t i) const;
    [[nodiscard]] Aabb bounds_of_children(Node node) const;
    [[nodiscard]] Node root() const { return {levels_ - 1, 0}; }
    [[nodiscard]] const Aabb& box_of(Node node) const { return bounds_[first_[node.level] + node.at]; }
    [[nodiscard]] std::size_t first_child(Node node) const { return node.at * fan; }
    [[nodiscard]] std::size_t end_of_children(Node node) const {
        const std::size_t end = (node.at + 1) * fan, count = first_[node.level] - first_[node.level - 1];
        return end < count ? end : count;
    }
    [[nodiscard]] std::size_t end_of_run(std::size_t i) const {
        return (i + 1) * run < size() ? (i + 1) * run : size();
    }
    /// Returns the boxes below a node, which are contiguous.
    [[nodiscard]] std::span<const Proxy> proxies_below(Node node) const {
        std::size_t width = run;
        for (std::size_t level = 0; level < node.level; ++level) width *= fan;
        const std::size_t begin = node.at * width, end = begin + width < size() ? begin + width : size();
        return boxes_.proxies().subspan(begin, end - begin);
    }
};

template <Region R, class Visit> bool RunTree::traverse(const R& region, Visit&& visit) const {
    if (size() == 0 || !region.touches(bounds())) return true;
    LocalStack<Node, 128> open;
    open.push(root());
    while (!open.empty()) {
        const Node node = open.pop();
        if (node.level > 0) {
            for (std::size_t i = end_of_children(node); i-- > first_child(node);)
                if (region.touches(box_of({node.level - 1, i}))) open.push({node.level - 1, i});
            continue;
        }
        const std::size_t begin = node.at * run, end = end_of_run(node.at);
        if constexpr (std::same_as<R, BoxRegion>) {
            std::array<std::uint32_t, run + BoxColumns::padding> hits;
            const std::size_t count = scan_touching(boxes_.view(), begin, end, region.box, hits.data());
            for (std::size_t i = 0; i < count; ++i)
                if (!visit(boxes_.proxy(hits[i]), boxes_.box(hits[i]))) return false;
        } else {
            for (std::size_t i = begin; i < end; ++i) {
                const Aabb box = boxes_.box(i);
                if (region.touches(box) && !visit(boxes_.proxy(i), box)) return false;
            }
        }
    }
    return true;
}

template <Measure M, class Visit> bool RunTree::nearest_first(const M& measure, float& limit, Visit&& visit) const {
    if (size() == 0) return true;
    struct Branch {
        Node node;
        float distance;
    };
    LocalStack<Branch, 128> open;
    open.push({root(), measure.distance(bounds(), limit)});
    while (!open.empty()) {
        const Branch branch = open.pop();
        if (!(branch.distance <= limit) || branch.distance == infinite_distance) continue;
        const Node node = branch.node;
        if (node.level == 0) {
            for (std::size_t i = node.at * run; i < end_of_run(node.at); ++i) {
                const Aabb box = boxes_.box(i);
                const float distance = measure.distance(box, limit);
                if (!(distance < infinite_distance)) continue;
                const float new_limit = visit(boxes_.proxy(i), box, distance);
                limit = new_limit < limit ? new_limit : limit;
                if (!(limit >= 0)) return false;
            }
            continue;
        }
        std::array<Branch, fan> near;  // farthest first, so that the nearest is on top of the stack
        std::size_t count = 0;
        for (std::size_t i = first_child(node); i < end_of_children(node); ++i) {
            const Node child{node.level - 1, i};
            const float distance = measure.distance(box_of(child), limit);
            if (!(distance < infinite_distance)) continue;
            std::size_t k = count++;
            for (; k > 0 && near[k - 1].distance <= distance; --k) near[k] = near[k - 1];
            near[k] = {child, distance};
        }
        for (std::size_t i = 0; i < count; ++i) open.push(near[i]);
    }
    return true;
}

template <SolidRegion R, class Take> void RunTree::cull(const R& region, Take&& take) const {
    if (size() == 0) return;
    LocalStack<Node, 128> open;
    open.push(root());
    while (!open.empty()) {
        const Node node = open.pop();
        if (!region.touches(box_of(node))) continue;
        if (region.contains(box_of(node))) {
            take(proxies_below(node), true);
        } else if (node.level > 0) {
            for (std::size_t i = end_of_children(node); i-- > first_child(node);) open.push({node.level - 1, i});
        } else {
            for (std::size_t i = node.at * run; i < end_of_run(node.at); ++i) {
                const Aabb box = boxes_.box(i);
                if (region.touches(box)) take(boxes_.proxies().subspan(i, 1), region.contains(box));
            }
        }
    }
}

}  // namespace fase::broad
