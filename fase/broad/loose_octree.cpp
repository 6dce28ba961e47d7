/// Distributes boxes to loose cells, top-down.
#include "fase/broad/loose_octree.hpp"

#include <algorithm>

#include "fase/broad/builders/cell_pairs.hpp"

namespace fase::broad {

LooseOctree::LooseOctree() : LooseOctree(Settings{}) {}
LooseOctree::LooseOctree(const Settings& settings) : settings_(settings) {
    settings_.capacity = std::max(settings_.capacity, 1u);
    settings_.max_depth = std::clamp(settings_.max_depth, 0, deepest_cell);
}

std::uint32_t LooseOctree::Record::child(const Path& cell) const {
    if (depth <= cell.depth) return own_leaf;
    std::uint32_t child = 0;
    for (std::size_t a = 0; a < 3; ++a) child |= ((centre[a] >> (deepest_cell - cell.depth - 1)) & 1u) << a;
    return child;
}

LooseOctree::Record LooseOctree::record_of(const Aabb& box, std::uint32_t row) const {
    const float size_in_steps = frame_.to_steps(longest_side(box));
    // Exponent of the smallest power of two that is not below the size of the box in steps.
    const auto steps = size_in_steps < static_cast<float>(1 << deepest_cell) ? static_cast<std::uint32_t>(size_in_steps)
                                                                             : 1u << deepest_cell;
    const int exponent = std::min(static_cast<int>(std::bit_width(steps)), deepest_cell);
    return {frame_.steps_of(centre(box)), static_cast<std::uint16_t>(deepest_cell - exponent), row};
}

void LooseOctree::rebuild() {
    const std::span<const Move> rows = store_.regular();
    frame_ = CellFrame<3>({0, 1, 2}, settings_.bounds, rows);
    if (rows.empty()) return tree_.clear();
    tree_.begin();
    if (records_.size() < rows.size()) records_.resize(rows.size());
    for (std::uint32_t row = 0; row < rows.size(); ++row) records_[row] = record_of(rows[row].box, row);
    tasks_.clear();
    tasks_.push_back({.node = CellTree::root, .begin = 0, .end = static_cast<std::uint32_t>(rows.size())});
    while (!tasks_.empty()) {
        const Task task = tasks_.back();
        tasks_.pop_back();
        if (try_split(task)) continue;
        tree_.add_leaf(task.node);
        for (std::uint32_t i = task.begin; i < task.end; ++i) tree_.add_owned(rows[records_[i].row]);
    }
    tree_.finish();
}

bool LooseOctree::try_split(const Task& task) {
    const std::uint32_t count = task.end - task.begin;
    if (task.is_leaf || count <= settings_.capacity || task.path.depth >= settings_.max_depth) return false;
    std::array<std::uint32_t, own_leaf + 1> counts{}, target{};
    for (std::uint32_t i = task.begin; i < task.end; ++i) ++counts[records_[i].child(task.path)];
    if (counts[own_leaf] == count) return false;
    std::uint16_t children = 0;
    for (std::uint32_t child = 0; child <= own_leaf; ++child)
        children = static_cast<std::uint16_t>(children | (counts[child] != 0 ? 1u << child : 0));

    std::uint32_t node = tree_.split(task.node, children) + static_cast<std::uint32_t>(std::popcount(children));
    std::uint32_t top = task.end;
    if (records_.size() < top + count) records_.resize(std::max<std::size_t>(top + count, 2 * records_.size()));
    for (std::uint32_t child = own_leaf + 1;
         child-- > 0;) {  // the first child is on top of the stack, so it comes next
        if (counts[child] == 0) continue;
        target[child] = top;
        const Path path = child == own_leaf ? task.path : task.path.child(child);
        tasks_.push_back({path, --node, top, top + counts[child], child == own_leaf});
        top += counts[child];
    }
    for (std::uint32_t i = task.begin; i < task.end; ++i) {
        const Record record = records_[i];
        records_[target[record.child(task.path)]++] = record;
    }
    return true;
}

void LooseOctree::find_pairs(std::vector<Pair>& out) const {
    PairSink sink(out);
    store_.unbounded_pairs(false, [&](Proxy p, Proxy q) { sink.add(p, q); });
    find_pairs_near_leaves(tree_, {0, tree_.leaves().size()}, false, sink);
}

void LooseOctree::find_pairs(TaskRunner& tasks, std::vector<Pair>& out) const {
    {
        PairSink sink(out);
        store_.unbounded_pairs(false, [&](Proxy p, Proxy q) { sink.add(p, q); });
    }
    const std::size_t leaves = tree_.leaves().size();
    find_in_parts(tasks, parts_of(leaves), buffers_, out, [&](std::size_t i, std::vector<Pair>& found) {
        PairSink sink(found);
        find_pairs_near_leaves(tree_, leaves_of_part(leaves, i), false, sink);
    });
}

void LooseOctree::find_awake_pairs(std::vector<Pair>& out) const {
    if (store_.resting() == 0) return find_pairs(out);
    PairSink sink(out);
    store_.unbounded_pairs(true, [&](Proxy p, Proxy q) { sink.add(p, q); });
    if (!tree_.empty() && tree_.nodes()[CellTree::root].awake)
        find_pairs_near_leaves(tree_, {0, tree_.leaves().size()}, true, sink);
}

std::size_t LooseOctree::bytes() const {
    return sizeof(*this) + store_.bytes() + tree_.bytes() + records_.capacity() * sizeof(Record) +
           tasks_.capacity() * sizeof(Task);
}

/// Checks the leaves against the size and centre of all boxes, computed again.
std::string LooseOctree::broken_cells() const {
    std::string broken;
    tree_.walk(Path{}, [&](std::uint32_t at, const Path& path) {
        const CellTree::Node& node = tree_.nodes()[at];
        if (path.depth > settings_.max_depth) broken = "a node is too deep";
        if (!node.is_leaf()) return;
        const CellTree::Leaf& leaf = tree_.leaves()[node.leaf_begin];
        if (leaf.references != 0) broken = "a box is in two leaves";
        for (const Aabb& box : tree_.boxes().subspan(leaf.first, leaf.owned)) {
            const Record record = record_of(box, 0);
            if (record.depth < path.depth) broken = "a box is larger than its cell";
            for (std::size_t a = 0; a < 3; ++a)
                if (record.centre[a] < path.begin(a) || record.centre[a] >= path.end(a))
                    broken = "the centre of a box is outside its cell";
        }
    });
    return broken;
}

}  // namespace fase::broad
