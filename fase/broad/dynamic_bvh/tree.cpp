/// Operations on the tree: insertion and removal of leaves, refitting, rotations.
#include "fase/broad/dynamic_bvh.hpp"
#include "fase/core/hash.hpp"

namespace fase::broad {

void DynamicBvh::set_content(Slot slot, const Aabb& box, std::uint32_t link) {
    nodes_[slot].box = box;
    nodes_[slot].link = link;
    if (nodes_[slot].is_leaf()) {
        entries_[nodes_[slot].proxy()].where = slot;
    } else {
        nodes_[link].parent = slot;
        nodes_[link + 1].parent = slot;
    }
}

void DynamicBvh::swap_content(Slot a, Slot b) {
    const Node old_a = nodes_[a], old_b = nodes_[b];
    set_content(a, old_b.box, old_b.link);
    set_content(b, old_a.box, old_a.link);
}

DynamicBvh::Slot DynamicBvh::allocate_pair() {
    if (!free_.empty()) {
        const Slot pair = free_.back();
        free_.pop_back();
        return pair;
    }
    const auto pair = static_cast<Slot>(nodes_.size());
    nodes_.resize(nodes_.size() + 2);
    return pair;
}

/// Returns the node whose sibling a new leaf should become: that with the least growth of surface. Branch and bound.
DynamicBvh::Slot DynamicBvh::best_sibling(Proxy p, const Aabb& box) const {
    struct Candidate {
        Slot slot;
        float growth_above;  // sum over all ancestors, if the leaf is inserted below
    };
    const float own = box_cost(box);
    Slot best = root;
    float best_cost = box_cost(merge(nodes_[root].box, box));
    LocalStack<Candidate, 64> open;
    if (!nodes_[root].is_leaf()) open.push({root, best_cost - box_cost(nodes_[root].box)});
    while (!open.empty()) {
        const Candidate at = open.pop();
        if (!(at.growth_above + own < best_cost)) continue;
        const Slot left = nodes_[at.slot].link;
        Candidate below[2];
        for (Slot side = 0; side < 2; ++side) {
            const Aabb& child = nodes_[left + side].box;
            const float cost = at.growth_above + box_cost(merge(child, box));
            below[side] = {left + side, cost - box_cost(child)};
            if (cost < best_cost) {
                best_cost = cost;
                best = left + side;
            }
        }
        const bool left_first = below[0].growth_above <= below[1].growth_above;
        for (const Candidate& next : {below[left_first ? 1 : 0], below[left_first ? 0 : 1]})
            if (!nodes_[next.slot].is_leaf() && next.growth_above + own < best_cost) open.push(next);
    }
    // Where a deeper insertion costs the same (coincident boxes), a random walk sends the leaf down; otherwise the
    // nodes would form a chain.
    for (std::uint64_t coin = mix_bits(p + 1ull); !nodes_[best].is_leaf(); coin = mix_bits(coin)) {
        const Slot child = nodes_[best].link + static_cast<Slot>(coin & 1);
        const Aabb& now = nodes_[best].box;
        if (!contains(now, box) || box_cost(merge(nodes_[child].box, box)) < box_cost(now)) break;
        best = child;
    }
    return best;
}

void DynamicBvh::insert_leaf(Proxy p, const Aabb& fat) {
    entries_[p].place = Place::Tree;
    if (leaf_count_++ == 0) {
        nodes_.resize(2);
        set_content(root, fat, leaf_bit | p);
        return;
    }
    const Slot sibling = best_sibling(p, fat);
    const Slot pair = allocate_pair();
    const Node old = nodes_[sibling];
    set_content(pair, old.box, old.link);
    set_content(pair + 1, fat, leaf_bit | p);
    set_content(sibling, merge(old.box, fat), pair);
    if (sibling != root) refit_upwards(nodes_[sibling].parent);
}

void DynamicBvh::remove_leaf(Slot leaf) {
    ++changes_;
    if (--leaf_count_ == 0) {
        nodes_.clear();
        free_.clear();
        return;
    }
    const Slot parent = nodes_[leaf].parent;
    const Node sibling = nodes_[leaf ^ 1];
    set_content(parent, sibling.box, sibling.link);
    free_.push_back(leaf & ~1u);
    for (Slot at = parent; at != root;) {
        at = nodes_[at].parent;
        const Aabb box = merged_children(nodes_[at]);
        if (box == nodes_[at].box) return;
        nodes_[at].box = box;
    }
}

/// Refits from `slot` to the root. Stops early when a node and its child are both unchanged, as then nothing above can
/// change.
void DynamicBvh::refit_upwards(Slot slot) {
    for (int unchanged = 0; unchanged < 2;) {
        const Aabb box = merged_children(nodes_[slot]);
        const bool changed = !(box == nodes_[slot].box);
        nodes_[slot].box = box;
        const bool rotated = rotate(slot);
        unchanged = changed || rotated ? 0 : unchanged + 1;
        if (slot == root) return;
        slot = nodes_[slot].parent;
    }
}

/// Swaps a child with a grandchild of the other side, or two grandchildren, if that reduces the surface of the
/// children: the best of six swaps. The box of the node itself does not change.
bool DynamicBvh::rotate(Slot slot) {
    const Slot left = nodes_[slot].link, right = left + 1;
    const Node &l = nodes_[left], &r = nodes_[right];
    const float area_l = box_cost(l.box), area_r = box_cost(r.box);
    float best_gain = 0;
    Slot one = root, other = root;
    const auto consider = [&](float gain, Slot a, Slot b) {
        if (gain > best_gain) {
            best_gain = gain;
            one = a;
            other = b;
        }
    };
    if (!l.is_leaf()) {
        consider(area_l - box_cost(merge(r.box, nodes_[l.link + 1].box)), right, l.link);
        consider(area_l - box_cost(merge(r.box, nodes_[l.link].box)), right, l.link + 1);
    }
    if (!r.is_leaf()) {
        consider(area_r - box_cost(merge(l.box, nodes_[r.link + 1].box)), left, r.link);
        consider(area_r - box_cost(merge(l.box, nodes_[r.link].box)), left, r.link + 1);
    }
    if (!l.is_leaf() && !r.is_leaf()) {
        for (Slot side = 0; side < 2; ++side) {
            const Aabb new_l = merge(nodes_[l.link].box, nodes_[r.link + side].box);
            const Aabb new_r = merge(nodes_[l.link + 1].box, nodes_[r.link + (side ^ 1)].box);
            consider(area_l + area_r - box_cost(new_l) - box_cost(new_r), l.link + 1, r.link + side);
        }
    }
    if (one == other) return false;
    swap_content(one, other);
    for (const Slot child : {left, right})
        if (!nodes_[child].is_leaf()) nodes_[child].box = merged_children(nodes_[child]);
    return true;
}

}  // namespace fase::broad
